"""Runs of whole processes, one thread each: what they took, side by side in one run."""

from __future__ import annotations

import os
import signal
import statistics
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ONE_THREAD = {
    name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER")
}
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
    """What a process and its children took. wall, cpu [s]: of all ranks together; memory_MB: the largest resident
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
    environment = {**os.environ, **ONE_THREAD, **MPI_AS_ROOT, **(command.environment or {})}
    begin = time.perf_counter()
    with open(command.log, "wb") as log:
        process = subprocess.Popen(
            words, cwd=command.folder, env=environment, stdout=log, stderr=log, start_new_session=True
        )
        end = threading.Timer(command.time_limit, os.killpg, (process.pid, signal.SIGKILL))
        end.start()
        try:
            _, status, used = os.wait4(process.pid, 0)
        finally:
            end.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    wall = time.perf_counter() - begin
    if process.returncode:
        raise RunFailed(f"{' '.join(words)}: {_reason(command, process.returncode)}")
    return Cost(wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0)


MPI_AS_ROOT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
}


def _reason(command: Command, code: int) -> str:
    if code == -signal.SIGKILL:
        return f"ended after {command.time_limit:g} s, or killed for its memory"
    tail = command.log.read_text(errors="replace").strip().splitlines()[-3:]
    return f"exit code {code}: {' | '.join(tail)}"


def interleaved(commands: Sequence[Command], repeats: int) -> list[list[Cost]]:
    """Costs by command: all commands once, then all again, so that a slow minute of the machine hits them all."""
    rounds = [[run(command) for command in commands] for _ in range(repeats)]
    return [list(costs) for costs in zip(*rounds)]
