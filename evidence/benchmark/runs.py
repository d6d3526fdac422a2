"""Runs of whole processes, one thread each: what they took, side by side in one run."""

from __future__ import annotations

import json
import os
import signal
import statistics
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ONE_THREAD = {
    name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER")
}
LEFT_OUT = {"OPENBLAS_CORETYPE"}  # a shell's choice of older kernels: every program finds the processor's own
TIME_LIMIT = 600.0  # s, after which a run is ended and reported as such


@dataclass(frozen=True)
class Command:
    """A command line; folder: where it runs; environment: what it needs beside ours; log: where its words go."""

    words: tuple[str, ...]
    folder: Path
    log: Path
    environment: Mapping[str, str] | None = None
    ranks: int = 1
    time_limit: float = TIME_LIMIT


@dataclass(frozen=True)
class Cost:
    """What a process and its children took. wall [s]; cpu [s]: of all of them together; memory_MB: the largest resident
    memory of one process."""

    wall: float
    cpu: float
    memory_MB: float

    @staticmethod
    def median(costs: Sequence[Cost]) -> Cost:
        """Of each figure on its own."""
        return Cost(*(statistics.median(getattr(c, name) for c in costs) for name in ("wall", "cpu", "memory_MB")))


class RunFailed(RuntimeError):
    """The command ended with an error or did not end in time; says so with the end of its log."""


def run(command: Command) -> Cost:
    """Runs a command to its end. Raises RunFailed."""
    words = list(command.words)
    if command.ranks > 1:
        words = ["mpirun", "-n", str(command.ranks), *words]
    inherited = {name: value for name, value in os.environ.items() if name not in LEFT_OUT}
    environment = {**inherited, **ONE_THREAD, **MPI_AS_ROOT, **(command.environment or {})}
    out = command.log.with_suffix(".cost.json")
    launcher = [sys.executable, "-S", str(Path(__file__).with_name("launch.py")), str(out)]
    with open(command.log, "wb") as log:
        process = subprocess.Popen(
            [*launcher, *words], cwd=command.folder, env=environment, stdout=log, stderr=log, start_new_session=True
        )
        try:
            code = process.wait(command.time_limit)
        except subprocess.TimeoutExpired:
            code = -signal.SIGKILL
        finally:
            _end(process)
    if code:
        raise RunFailed(f"{' '.join(words)}: {_reason(command, code)}")
    return Cost(**json.loads(out.read_text()))


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ends whatever still runs of a process and its children."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


MPI_AS_ROOT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
}


def _reason(command: Command, code: int) -> str:
    if code in (-signal.SIGKILL, 128 + signal.SIGKILL):
        return f"ended after {command.time_limit:g} s, or killed for its memory"
    tail = command.log.read_text(errors="replace").strip().splitlines()[-3:]
    return f"exit code {code}: {' | '.join(tail)}"
