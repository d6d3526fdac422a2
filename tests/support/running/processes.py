"""Programs that tests start: in this checkout, on a number of MPI ranks, one mpirun at a time."""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

import pytest

from evidence.processes import MPI_AS_ROOT
from tests.support.checkout import PYTHONPATH, ROOT

Done = subprocess.CompletedProcess[str]
BROKEN_RUN = "tests/support/running/broken_run.py"
"""Script that runs a scene with something going wrong, for `run_script`."""
MARKED = "EVOLVENT_TEST_STARTS_MPIRUN"
"""Environment variable that is set while a test marked `mpi` runs; see conftest.py."""


class RunScript(Protocol):
    """The fixture `run_script`, see `run_script` below."""

    def __call__(self, script: str, *arguments: str, ranks: int = 1, timeout: float = 300.0) -> Done: ...


def run_script(script: str, *arguments: str, ranks: int = 1, timeout: float = 300.0) -> Done:
    """run_script(script, *arguments, ranks=1, timeout=300): the finished process with its output, status unchecked.

    script: a path from the checkout's root, or "-c" with the program as the first argument.
    """
    launcher = [] if ranks == 1 else ["mpirun", "-n", str(ranks)]
    command = [*launcher, sys.executable, script, *arguments]
    with one_at_a_time(ranks):
        return subprocess.run(
            command, cwd=ROOT, env=_environment(), capture_output=True, text=True, timeout=timeout, check=False
        )


@contextmanager
def one_at_a_time(ranks: int) -> Iterator[None]:
    """Of the workers that run tests side by side one starts mpirun: its ranks want all cores. Raises RuntimeError in a
    test that is not marked `mpi`."""
    if ranks == 1:
        yield
        return
    if MARKED not in os.environ:
        raise RuntimeError("wanted @pytest.mark.mpi on a test that starts mpirun, found none")
    with open(Path(tempfile.gettempdir()) / f"evolvent-tests-{os.getuid()}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def on_ranks(*counts: int) -> list[Any]:
    """Values for pytest.mark.parametrize: numbers of ranks, of which those above one start mpirun."""
    return [count if count == 1 else pytest.param(count, marks=pytest.mark.mpi) for count in counts]


def _environment() -> dict[str, str]:
    """One thread a rank; Open MPI 4 and 5 as root with more ranks than cores. A rank that waits for another leaves its
    core to the tests of other workers."""
    path = os.pathsep.join(filter(None, [PYTHONPATH, os.environ.get("PYTHONPATH")]))
    shared = {"PYTHONPATH": path, "OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg", "OMPI_MCA_mpi_yield_when_idle": "1"}
    return {**os.environ, **MPI_AS_ROOT, **shared}
