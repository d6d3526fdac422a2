"""Shared by all tests: quiet libraries, and scripts on a number of MPI ranks."""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.support.checkout import PYTHONPATH, ROOT

Run = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="session", autouse=True)
def _quiet() -> None:
    from evolvent.fem.backend import (
        dolfinx_compat,  # starts MPI: pytest itself must not, or its workers take themselves for ranks
    )

    dolfinx_compat.silence_logs()


@pytest.fixture(scope="session")
def run_script() -> Run:
    """run_script(script, *arguments, ranks=1, timeout=300): the finished process with its output, status unchecked.

    script: a path from the checkout's root, or "-c" with the program as the first argument.
    """

    def run(script: str, *arguments: str, ranks: int = 1, timeout: float = 300.0) -> subprocess.CompletedProcess[str]:
        launcher = [] if ranks == 1 else ["mpirun", "-n", str(ranks)]
        command = [*launcher, sys.executable, script, *arguments]
        with one_at_a_time(ranks):
            return subprocess.run(
                command, cwd=ROOT, env=_environment(), capture_output=True, text=True, timeout=timeout, check=False
            )

    return run


@contextmanager
def one_at_a_time(ranks: int) -> Iterator[None]:
    """Of the workers that run tests side by side one starts mpirun: its ranks want all cores."""
    if ranks == 1:
        yield
        return
    with open(Path(tempfile.gettempdir()) / f"evolvent-tests-{os.getuid()}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _environment() -> dict[str, str]:
    """One thread a rank; Open MPI 4 and 5 as root with more ranks than cores."""
    path = os.pathsep.join(filter(None, [PYTHONPATH, os.environ.get("PYTHONPATH")]))
    return {
        **os.environ,
        "PYTHONPATH": path,
        "OMP_NUM_THREADS": "1",
        "MPLBACKEND": "Agg",
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    }
