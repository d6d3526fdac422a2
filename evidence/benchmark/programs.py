"""The programs that are compared, and a task solved by one of them in a process of its own."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from evidence.benchmark.runs import TIME_LIMIT, Command, Cost, run
from evidence.benchmark.task import Answer, Task
from evidence.checkout import PYTHONPATH, ROOT

ORDER_1_3D = (("hexahedron", 1), ("tetrahedron", 1))


@dataclass(frozen=True)
class Program:
    """A program as one command line. only: the (shape, order) that it can do, all where empty. test: a command that
    succeeds where the program is installed."""

    name: str
    words: tuple[str, ...]
    test: tuple[str, ...]
    only: tuple[tuple[str, int], ...] = ()

    def available(self) -> bool:
        return _succeeds(self.test)

    def takes(self, task: Task) -> bool:
        return not self.only or (task.bodies[0].shape, task.bodies[0].order) in self.only


@cache
def _succeeds(words: tuple[str, ...]) -> bool:
    if shutil.which(words[0]) is None:
        return False
    return subprocess.run(words, capture_output=True, stdin=subprocess.DEVNULL).returncode == 0


def _adapter(name: str, python: str, *arguments: str) -> tuple[str, ...]:
    return (python, "-m", f"evidence.benchmark.peers.{name}", *arguments)


DEBIAN, VENV = "/usr/bin/python3", str(ROOT / "build" / "peers" / "bin" / "python")
CCX = ("sh", "-c", "command -v ccx")
KRATOS = "import KratosMultiphysics.ContactStructuralMechanicsApplication, KratosMultiphysics.LinearSolversApplication"
EVOLVENT = Program("Evolvent", (sys.executable, "-m", "evidence.benchmark.ours"), (sys.executable, "--version"))
PEERS = (
    Program("GetFEM", _adapter("getfem", DEBIAN), (DEBIAN, "-c", "import getfem")),
    Program("CalculiX", _adapter("calculix", sys.executable, "surface"), CCX),
    Program("CalculiX mortar", _adapter("calculix", sys.executable, "mortar"), CCX, ORDER_1_3D),
    Program(
        "Kratos",
        _adapter("kratos", VENV),
        (VENV, "-c", KRATOS),
        (("triangle", 1), ("quadrilateral", 1), *ORDER_1_3D),
    ),
)


@dataclass(frozen=True)
class Solved:
    """A task's answer and what it cost, without the writing or reading of meshes."""

    answer: Answer
    cost: Cost


def solve(
    program: Program, task: Path, folder: Path, time_limit: float = TIME_LIMIT, cache_folder: Path | None = None
) -> Solved:
    """Runs a program on a task's file. cache_folder: for compiled forms, where it's not the usual one. Raises
    RunFailed."""
    answer = folder / f"answer-{program.name.replace(' ', '-')}.npz"
    interpreter, flag, module, *rest = program.words
    words = (interpreter, flag, module, str(task), str(answer), *rest)
    environment = {"PYTHONPATH": PYTHONPATH, "PYTHONDONTWRITEBYTECODE": "1"}
    if cache_folder is not None:
        environment["XDG_CACHE_HOME"] = str(cache_folder)
    cost = run(Command(words, folder, answer.with_suffix(".log"), environment, time_limit=time_limit))
    found = Answer.read(answer)
    meshing = found.seconds.get("mesh", 0.0)
    return Solved(found, replace(cost, cpu=cost.cpu - meshing, wall=cost.wall - meshing))


def side_by_side(programs: Sequence[Program], task: Path, folder: Path, repeats: int) -> dict[str, list[Solved]]:
    """All programs in turn, `repeats` times: a slow minute of the machine hits them all. Raises RunFailed."""
    found: dict[str, list[Solved]] = {program.name: [] for program in programs}
    for _ in range(repeats):
        for program in programs:
            found[program.name].append(solve(program, task, folder))
    return found
