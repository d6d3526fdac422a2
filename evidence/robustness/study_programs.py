"""Studies, schedulers and workers started as programs of their own, and what studies leave, for tests and evidence."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from evidence.checkout import ROOT
from evidence.processes import environment

WORKER = "evolvent.run.study.worker_process"
PATIENCE = 300.0
"""Longest time that something is waited for [s]."""


def words(study: Path, out: Path, *more: str) -> list[str]:
    """The command line of a study."""
    return [sys.executable, "-m", "evolvent", "study", str(study), "--out", str(out), *more]


@contextmanager
def started(command: list[str]) -> Iterator[subprocess.Popen[str]]:
    """A program in the background, which is killed at the end."""
    program = subprocess.Popen(
        command, cwd=ROOT, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        yield program
    finally:
        program.kill()
        program.communicate()


def workers_of(parent: int) -> list[int]:
    """Process numbers of the worker processes below a study."""
    return [each for each, above in _parents().items() if above == parent and WORKER in _words(each)]


def has_started(worker: int) -> bool:
    """Whether a worker process has imported what it computes with."""
    try:
        return "libdolfinx" in Path(f"/proc/{worker}/maps").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False


def descendants(parent: int) -> list[int]:
    """Process numbers of all processes below one, such as workers and what Open MPI has started for them."""
    parents, found = _parents(), [parent]
    for each in found:
        found += [below for below, above in parents.items() if above == each]
    return found[1:]


def workers_for(study: int) -> list[int]:
    """Process numbers of the workers that a study has started, whoever has taken them over."""
    return [each for each in _parents() if WORKER in (given := _words(each)) and given[-1] == str(study)]


def _parents() -> dict[int, int]:
    """Process number -> that of its parent, of all processes."""
    found = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            found[int(path.parent.name)] = int(path.read_text().rpartition(")")[2].split()[1])
    return found


def _words(process: int) -> list[str]:
    """Command line of a process; empty where the process has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/cmdline").read_text(errors="replace").split("\0")[:-1]
    return []


def runs(process: int) -> bool:
    """Whether a process has not ended. In a container nobody may have taken note of its end: it is a zombie then."""
    try:
        state = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state != "Z"


def until(holds: Callable[[], object], *, say: str, patience: float = PATIENCE) -> None:
    """Waits until a call returns something true. Raises TimeoutError."""
    end = time.monotonic() + patience
    while not holds():
        if time.monotonic() > end:
            raise TimeoutError(f"waited {patience:g} s for {say}")
        time.sleep(0.05)


def records(out: Path) -> list[Path]:
    """Those of scenes that were computed."""
    return sorted(out.glob("scenes/*/study_scene.json"))


def times_written(out: Path) -> list[int]:
    """How often each scene's record was written."""
    manifests = (path.parent / "results/evolvent-files.jsonl" for path in records(out))
    return [path.read_text().count("study_scene.json") for path in manifests]


@contextmanager
def scheduler(tmp_path: Path, *more: str) -> Iterator[str]:
    """A Dask scheduler of its own, and its address. more: options."""
    file = tmp_path / "scheduler.json"
    options = ["--port", "0", "--host", "127.0.0.1", "--no-dashboard", "--scheduler-file", str(file), *more]
    with started([sys.executable, "-m", "dask", "scheduler", *options]):
        until(lambda: file.exists() and file.read_text().endswith("}"), say="the scheduler")
        yield file.read_text().partition('"address": "')[2].partition('"')[0]


@contextmanager
def worker(address: str, tmp_path: Path, threads: int = 1) -> Iterator[subprocess.Popen[str]]:
    """A worker of a scheduler."""
    options = ["--nthreads", str(threads), "--no-dashboard", "--no-nanny", "--local-directory", str(tmp_path)]
    with started([sys.executable, "-m", "dask", "worker", address, *options]) as program:
        yield program
