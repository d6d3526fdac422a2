"""Programs run as processes of their own with one thread each, and what they took."""

from __future__ import annotations

import json
import os
import shutil
import signal
import statistics
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from evidence.checkout import python_path

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER"), "1"
)
MPI_AS_ROOT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
}
LEFT_OUT = {"OPENBLAS_CORETYPE"}  # a shell's choice of older kernels: every program takes those of the processor
TIME_LIMIT = 600.0  # s
OUT_OF_TIME = (-signal.SIGKILL, 128 + signal.SIGKILL)


@dataclass(frozen=True)
class Command:
    """A command line to be run."""

    words: tuple[str, ...]
    folder: Path
    """The working directory."""
    log: Path
    """Where its output goes."""
    variables: Mapping[str, str] = field(default_factory=dict)
    """Environment variables beside those of `environment`."""
    ranks: int = 1
    """Of mpirun."""
    time_limit: float = TIME_LIMIT
    """Wall time after which the process is killed [s]."""


@dataclass(frozen=True)
class Cost:
    """What a process and its children took."""

    wall: float
    """[s]."""
    cpu: float
    """Of all of them together [s]."""
    memory_MB: float
    """Largest resident memory: of one process, or of all ranks at once with what they share counted once."""

    @staticmethod
    def median(costs: Sequence[Cost]) -> Cost:
        """Median of each figure."""
        return Cost(
            wall=statistics.median(cost.wall for cost in costs),
            cpu=statistics.median(cost.cpu for cost in costs),
            memory_MB=statistics.median(cost.memory_MB for cost in costs),
        )


class RunFailed(RuntimeError):
    """A command that ended with an error or was killed; the message has the end of its log."""

    @property
    def reason(self) -> str:
        """Why, in at most 160 characters: a cell of a table."""
        return str(self).rsplit(": ", 1)[-1][:160]


def environment() -> dict[str, str]:
    """This process' variables, for one thread a process and this checkout's packages."""
    inherited = {name: value for name, value in os.environ.items() if name not in LEFT_OUT}
    fixed = {"PYTHONPATH": python_path(), "MPLBACKEND": "Agg"}
    return {**inherited, **ONE_THREAD, **MPI_AS_ROOT, **fixed}


def empty_cache(folder: Path) -> dict[str, str]:
    """The variable that makes a program compile its forms again: an empty cache below a folder."""
    cache = folder / "cold"
    shutil.rmtree(cache, ignore_errors=True)
    cache.mkdir()
    return {"XDG_CACHE_HOME": str(cache)}


def run_arguments(scene: str, out: Path, settings: Sequence[str], *options: str) -> list[str]:
    """The words after `evolvent run` for a scene of demos/, without progress; to be run in ROOT."""
    return [scene, "--out", str(out), "--quiet", *(f"--set={setting}" for setting in settings), *options]


def module_run(module: str, *arguments: object) -> tuple[str, ...]:
    """The words of a module of this checkout."""
    return (sys.executable, "-m", module, *map(str, arguments))


def run(command: Command) -> Cost:
    """Runs a command to its end. Raises RunFailed."""
    words = [*(["mpirun", "-n", str(command.ranks)] if command.ranks > 1 else []), *command.words]
    out = command.log.with_suffix(".cost.json")
    launcher = [sys.executable, "-S", str(Path(__file__).with_name("launch.py")), str(out), str(command.ranks)]
    with open(command.log, "wb") as log:
        process = subprocess.Popen(
            [*launcher, *words], cwd=command.folder, env={**environment(), **command.variables}, stdout=log, stderr=log,
            start_new_session=True,
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
    """Kills a process and its children where they still run."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _reason(command: Command, code: int) -> str:
    if code in OUT_OF_TIME:
        return f"ended after {command.time_limit:g} s, or killed for its memory"
    tail = command.log.read_text(errors="replace").strip().splitlines()[-3:]
    return f"exit code {code}: {' | '.join(tail)}"
