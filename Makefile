# make demo   sets up what is missing, computes the helical pair of demos/yang2022.toml into out/yang2022
# make test   sets up what is missing, runs the tests;  make test-evidence  those that repeat evidence
# make verification  solves the verification problems again, writes docs/verification.md and its figures
# make bench  run time against error (three hours, on a quiet machine); make bench-peers  with other programs beside
# make pages  writes the tables of README.md, docs/outputs.md and others again, from what was measured
# make stress  settings, random scenes and faults at the edge of what can be asked, into docs/stress.md; an hour
# make setup  only that;  make lint, make docker, make clean as they say
.PHONY: demo test test-evidence verification bench bench-peers pages stress setup lint docker clean
.DELETE_ON_ERROR:

# A machine upgraded to the next Debian release needs another environment.
release := $(shell . /etc/os-release; echo $${VERSION_ID:-unstable})
ready := .venv/.ready-debian-$(release)

# Whole files go to a worker each, for their tests share what is costly to compute; the longest first (tests/conftest.py).
ON_ALL_CORES := -n auto --dist loadfile

# One BLAS thread per process: two ranks with two threads each on two cores are slower than two with one.
test test-evidence verification: export OMP_NUM_THREADS ?= 1
# Tests start mpirun: as root in a container, with more ranks than a small machine has cores, on this machine only.
export OMPI_ALLOW_RUN_AS_ROOT ?= 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM ?= 1
export OMPI_MCA_rmaps_base_oversubscribe ?= 1
export PRTE_MCA_rmaps_default_mapping_policy ?= :oversubscribe
export OMPI_MCA_btl ?= self,vader
export OMPI_MCA_btl_vader_single_copy_mechanism ?= none

demo: $(ready)
	.venv/bin/evolvent run demos/yang2022.toml --level quick --out out/yang2022 --overwrite

test: $(ready)
	.venv/bin/python -m pytest $(ON_ALL_CORES) -m "not evidence" $(PYTEST_ARGS)

test-evidence: $(ready)
	.venv/bin/python -m pytest $(ON_ALL_CORES) -m evidence $(PYTEST_ARGS)

verification: $(ready)
	.venv/bin/python -m evidence.verification --out docs

pages: $(ready)
	.venv/bin/python -m evidence.pages

stress: export OMP_NUM_THREADS ?= 1
stress: $(ready)
	.venv/bin/python -m evidence.robustness all

bench: $(ready)
	.venv/bin/python -m evidence.benchmarks all

bench-peers: $(ready)
	packages/peers build/peers
	.venv/bin/python -m evidence.benchmarks all --peers

setup: $(ready)

$(ready): packages/debian.txt packages/select packages/install packages/venv pyproject.toml
	packages/install
	packages/venv .venv
	touch $@

lint: $(ready)
	.venv/bin/python -m pip install -q "ruff>=0.4" "mypy>=1.10"
	.venv/bin/ruff check .
	.venv/bin/mypy

docker:
	docker build -t evolvent .

clean:
	rm -rf .venv out build *.egg-info
