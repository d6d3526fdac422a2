"""How MPI starts: settings of a process alone, which its children do not inherit; a temporary folder it cannot use."""

from __future__ import annotations

import pytest

from evolvent.fem.parallel.mpi_start import LAUNCHERS, launched
from tests.support.running.fresh_process import NOWHERE, python
from tests.support.running.processes import RunScript

PORTS = """
import os
before = dict(os.environ)
import evolvent
from mpi4py import MPI
assert dict(os.environ) == before and evolvent
from tests.support.running.listening import listening
print(len(listening(os.getpid())))
"""


@pytest.mark.parametrize(("btl", "ports"), [("", False), ("tcp,self", True)])
def test_settings_of_a_process_alone(btl: str, ports: bool) -> None:
    """MPI that `evolvent` has started opens no port and leaves the environment as it was, so that a mpirun which the
    program starts has none of these settings; where the user asks for TCP, MPI has its ports."""
    done = python(PORTS, OMPI_MCA_btl=btl)
    assert done.returncode == 0, done.stderr
    assert (int(done.stdout) > 0) == ports


@pytest.mark.mpi
def test_ranks_have_the_settings_of_mpirun(run_script: RunScript, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two ranks reach each other: those of a process alone, which reaches nobody, are not theirs."""
    monkeypatch.delenv("OMPI_MCA_btl", raising=False)
    program = "import evolvent; from mpi4py import MPI; print(MPI.COMM_WORLD.gather(evolvent.__name__) or '', end='')"
    done = run_script("-c", program, ranks=2)
    assert done.stdout == "['evolvent', 'evolvent']", done.stderr


@pytest.mark.mpi
def test_start_of_mpi_leaves_signals_to_the_program(run_script: RunScript) -> None:
    """A handler of SIGHUP from before MPI started is called after it, on ranks as in a process alone: UCX, where Open
    MPI loads it (Debian 13), would put its own in its place."""
    program = (
        "import os, signal, evolvent\n"
        "called = []\n"
        "signal.signal(signal.SIGHUP, lambda *_: called.append(evolvent.__name__))\n"
        "from mpi4py import MPI\n"
        "os.kill(os.getpid(), signal.SIGHUP)\n"
        "print('called' if called else 'lost', end='', flush=True)\n"
    )
    for ranks in (1, 2):
        done = run_script("-c", program, ranks=ranks)
        assert done.stdout == "called" * ranks, done.stderr


def test_launchers_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process without a launcher's variable is alone; with any of them it is a rank."""
    mpirun, srun = ("OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"), ("PMIX_NAMESPACE", "PMI_SIZE", "PMI_FD")
    assert {*mpirun, *srun} == set(LAUNCHERS)
    for name in LAUNCHERS:
        monkeypatch.delenv(name, raising=False)
    assert not launched()
    for name in (*mpirun, *srun):
        with monkeypatch.context() as patch:
            patch.setenv(name, "0")
            assert launched()


@pytest.mark.parametrize("name", ["TMPDIR", "TEMP"])
def test_temporary_folder_that_cannot_be_written(name: str) -> None:
    """MPI's own answer are forty lines and the end of the process. Here: an error with the variable and the remedy."""
    others = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), "")
    done = python("import evolvent; from mpi4py import MPI", **{**others, name: NOWHERE})
    assert done.returncode == 1
    last = done.stderr.splitlines()[-1]
    assert f"InputError: {name}: found {NOWHERE}, where MPI cannot keep its files" in last
    assert f"remedy: export {name}=/tmp" in last
    assert "ompi" not in done.stderr.lower()

