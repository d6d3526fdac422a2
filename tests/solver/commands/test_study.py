"""`evolvent study` as a user types it: worker processes that die, a study that is killed, a Dask cluster, bad input."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from evidence.processes import environment
from evidence.robustness.study_programs import (
    PATIENCE,
    records,
    runs,
    scheduler,
    started,
    times_written,
    until,
    words,
    worker,
    workers_of,
)
from evolvent.commands.app import main
from evolvent.run.study import scheduled_workers
from tests.support.checkout import ROOT
from tests.support.running.processes import RunScript
from tests.support.running.study_cases import TORQUES, table, written

SLOW = (
    TORQUES.replace('"check"', '"strength"')
    + '[set]\npinion.face_width_mm = 25.0\nmesh.level = "quick"\nsweep.positions = 4\noutput.error_bars = false\n'
)
"""Three scenes in plane strain, a second or two each, on the same gears."""
BRIEF = (
    "import sys; from evolvent.commands.app import main; from evolvent.run.study import scheduled_workers; "
    "scheduled_workers.PATIENCE = 2.0; sys.exit(main(sys.argv[1:]))"
)
"""`evolvent` that waits for two seconds instead of ten for a scheduler that does not answer or has no workers."""


@pytest.mark.slow
def test_a_study_that_is_killed_goes_on(tmp_path: Path) -> None:
    """Killed after its first scene: its workers end, too. The same command computes what is missing, each scene once,
    and its table has what one that nobody kills has."""
    study, out = written(tmp_path, SLOW), tmp_path / "out"
    with started(words(study, out, "--quiet")) as program:
        until(lambda: records(out), say="the first scene")
        below = workers_of(program.pid)
        os.kill(program.pid, signal.SIGKILL)
        assert below
        until(lambda: not any(map(runs, below)), say="the end of its workers")
    kept = {path: path.stat().st_mtime_ns for path in records(out)}
    assert 1 <= len(kept) < 3
    for folder in (out, tmp_path / "undisturbed"):
        done = subprocess.run(words(study, folder, "--quiet"), cwd=ROOT, env=environment(), check=False)
        assert done.returncode == 0
    assert {path: path.stat().st_mtime_ns for path in kept} == kept
    assert times_written(out) == [1, 1, 1]
    one, two = ([{**row, "seconds": ""} for row in table(each)] for each in (out, tmp_path / "undisturbed"))
    assert one == two and {row["status"] for row in one} == {"done"}


@pytest.mark.slow
def test_a_worker_that_dies_is_replaced(tmp_path: Path) -> None:
    """Killed while it computes: the study ends with all scenes done."""
    study, out = written(tmp_path, SLOW), tmp_path / "out"
    with started(words(study, out, "--quiet", "--workers", "2")) as program:
        until(lambda: records(out), say="the first scene")
        os.kill(workers_of(program.pid)[0], signal.SIGKILL)
        _, errors = program.communicate(timeout=PATIENCE)
        assert program.returncode == 0, errors
    assert {row["status"] for row in table(out)} == {"done"}
    assert times_written(out) == [1, 1, 1]


@pytest.mark.evidence
@pytest.mark.slow
def test_a_cluster_loses_a_worker(tmp_path: Path) -> None:
    """A running scheduler with two workers, one of which is killed after the first scene: all scenes are done."""
    study, out = written(tmp_path, SLOW), tmp_path / "out"
    with scheduler(tmp_path) as address, worker(address, tmp_path) as one, worker(address, tmp_path) as other:
        with started(words(study, out, "--quiet", "--scheduler", address)) as program:
            until(lambda: records(out), say="the first scene")
            one.kill()
            _, errors = program.communicate(timeout=PATIENCE)
            assert program.returncode == 0, errors
        assert other.poll() is None
    assert {row["status"] for row in table(out)} == {"done"}


@pytest.mark.evidence
@pytest.mark.slow
def test_schedulers_that_cannot_compute(tmp_path: Path, run_script: RunScript) -> None:
    """Without workers, with a worker of two threads: status 2 and what to start."""
    study = written(tmp_path, TORQUES)
    arguments = ["study", str(study), "--out", str(tmp_path / "out"), "--scheduler"]
    with scheduler(tmp_path) as address:
        done = run_script("-c", BRIEF, *arguments, address)
        assert done.returncode == 2
        assert "without workers; allowed: one with workers; remedy: start some with `python -m dask" in done.stderr
        with worker(address, tmp_path, threads=2):
            done = run_script("-m", "evolvent", *arguments, address)
    assert done.returncode == 2 and "with 2 threads; allowed: one thread a worker" in done.stderr
    assert not (tmp_path / "out/study.csv").exists()


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("openssl") is None, reason="wants openssl, which makes the certificates")
def test_a_scheduler_with_certificates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run_script: RunScript) -> None:
    """Scheduler, worker and study with certificates of one authority by Dask's own configuration: all scenes are done.
    A study without is refused."""
    study, certificate, key = written(tmp_path, TORQUES), tmp_path / "certificate.pem", tmp_path / "key.pem"
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=study", "-days", "2",
         "-out", str(certificate), "-keyout", str(key)], check=True, capture_output=True,
    )
    out, arguments = tmp_path / "out", ["study", str(study), "--quiet", "--out", str(tmp_path / "out"), "--scheduler"]
    with monkeypatch.context() as configured:
        configured.setenv("DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION", "True")
        configured.setenv("DASK_DISTRIBUTED__COMM__TLS__CA_FILE", str(certificate))
        for role in ("SCHEDULER", "WORKER", "CLIENT"):
            configured.setenv(f"DASK_DISTRIBUTED__COMM__TLS__{role}__CERT", str(certificate))
            configured.setenv(f"DASK_DISTRIBUTED__COMM__TLS__{role}__KEY", str(key))
        with scheduler(tmp_path, "--protocol", "tls") as address, worker(address, tmp_path):
            assert address.startswith("tls://")
            done = run_script("-m", "evolvent", *arguments, address)
            assert done.returncode == 0, done.stderr
            with monkeypatch.context() as stranger:
                for name in [name for name in os.environ if name.startswith("DASK_")]:
                    stranger.delenv(name)
                refused = run_script("-m", "evolvent", *arguments[:-2], str(tmp_path / "other"), "--scheduler", address)
    assert {row["status"] for row in table(out)} == {"done"}
    assert refused.returncode == 2 and "which cannot be reached (TLS expects" in refused.stderr
    assert not (tmp_path / "other").exists()


@pytest.mark.slow
def test_commands_of_the_page(tmp_path: Path) -> None:
    """Scheduler, worker and study as docs/studies.md has them, in the environment's folder of programs, with another
    address and a smaller study: all scenes are done."""
    page = (ROOT / "docs/studies.md").read_text(encoding="utf-8")
    text = page.partition("<!-- begin scheduler -->")[2].partition("```text\n")[2].partition("```")[0]
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    small = {"10.0.0.1": "127.0.0.1", "8786": str(port), "demos/studies/zhang2023_torque.toml":
             str(written(tmp_path, TORQUES)), "out/torque": str(tmp_path / "out")}
    for old, new in small.items():
        assert old in text
        text = text.replace(old, new)
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    scheduling, working, studying = (["env", f"PATH={path}", "bash", "-c", f"exec env {line}"]
                                     for line in text.splitlines())

    def answers() -> bool:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port)):
            return True
        return False

    with started(scheduling):
        until(answers, say="the scheduler")
        with started(working), started(studying) as program:
            said, errors = program.communicate(timeout=PATIENCE)
            assert program.returncode == 0, said + errors
    assert {row["status"] for row in table(tmp_path / "out")} == {"done"}


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--workers", "0"), "--workers: found 0; allowed: a whole number from 1 on; remedy: write --workers"),
        (("--workers", "2", "--scheduler", "tcp://127.0.0.1:9"), "--workers: found --scheduler, too; allowed: one of"),
        (("--workers", "two"), "--workers: found two; allowed: a whole number from 1 on; remedy: write --workers"),
        (("--workers", "100000"), "--workers: found 100000; allowed: up to "),
        (("--scheduler", "nowhere"), "--scheduler: found 'nowhere', which cannot be reached (missing port number"),
        (("--scheduler", "tcp://127.0.0.1:9"), "--scheduler: found 'tcp://127.0.0.1:9', which cannot be reached (no"),
        (("--scheduler", "tls://127.0.0.1:9"), "which cannot be reached (TLS expects a"),
        (("--scheduler", "ucx://127.0.0.1:9"), "--scheduler: found 'ucx://127.0.0.1:9', which cannot be reached ("),
        (("--set", "load.torque_Nm"), "--set: found"),
    ],
    ids=lambda each: " ".join(each) if isinstance(each, tuple) else "",
)
def test_wrong_options(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...],
    said: str,
) -> None:
    """Status 2, one line, nothing computed, and no folder left."""
    monkeypatch.setattr(scheduled_workers, "PATIENCE", 2.0)
    study, out = written(tmp_path, TORQUES), tmp_path / "out"
    assert main(["study", str(study), "--out", str(out), "--quiet", *options]) == 2
    errors = capfd.readouterr().err
    assert errors.startswith("evolvent: ") and said in errors and "Traceback" not in errors
    assert not out.exists()


def test_a_folder_that_is_a_link_to_nowhere(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Refused; nothing is made where it leads."""
    (tmp_path / "out").symlink_to(tmp_path / "nowhere")
    study = written(tmp_path, TORQUES)
    assert main(["study", str(study), "--out", str(tmp_path / "out"), "--quiet"]) == 2
    assert "a link that leads nowhere" in capfd.readouterr().err
    assert not (tmp_path / "nowhere").exists()


def test_level_is_that_of_all_scenes(tmp_path: Path, run_script: RunScript) -> None:
    """--level as of the other commands."""
    study, out = written(tmp_path, TORQUES.replace("[100.0, 200.0, 300.0]", "[100.0]")), tmp_path / "out"
    done = run_script("-m", "evolvent", "study", str(study), "--out", str(out), "--quiet", "--level", "quick")
    assert done.returncode == 0, done.stderr
    assert "quick" in next(out.glob("scenes/*/check.txt")).read_text(encoding="utf-8")


@pytest.mark.mpi
def test_mpirun_is_refused(tmp_path: Path, run_script: RunScript) -> None:
    """Two ranks: status 2, and what to do instead."""
    study = written(tmp_path, TORQUES)
    done = run_script("-m", "evolvent", "study", str(study), "--out", str(tmp_path / "out"), ranks=2)
    assert done.returncode == 2 and "leave out mpirun, give --workers" in done.stderr
