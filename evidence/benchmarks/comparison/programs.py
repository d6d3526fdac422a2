"""The programs that are compared, and a task solved by one of them in a process of its own."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from types import MappingProxyType

from evidence.benchmarks.comparison.task import Answer, Task
from evidence.checkout import ROOT
from evidence.processes import TIME_LIMIT, Command, Cost, module_run, run

ORDER_1_3D = (("hexahedron", 1), ("tetrahedron", 1))


@dataclass(frozen=True)
class Program:
    """A program as one command line."""

    name: str
    words: tuple[str, ...]
    test: tuple[str, ...]
    """A command that succeeds where the program is installed."""
    only: tuple[tuple[str, int], ...] = ()
    """The (shape, order) of cells that it has; all where empty."""

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
    return (python, "-m", f"evidence.benchmarks.peers.{name}", *arguments)


DEBIAN, VENV = "/usr/bin/python3", str(ROOT / "build" / "peers" / "bin" / "python")
CCX = ("sh", "-c", "command -v ccx")
KRATOS = "import KratosMultiphysics.ContactStructuralMechanicsApplication, KratosMultiphysics.LinearSolversApplication"
EVOLVENT = Program(
    "Evolvent", module_run("evidence.benchmarks.comparison.evolvent_program"), (sys.executable, "--version")
)
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
    """A task's answer and what it cost, without writing and reading meshes."""

    answer: Answer
    cost: Cost


def solve(
    program: Program, task: Path, folder: Path, time_limit: float = TIME_LIMIT,
    variables: Mapping[str, str] = MappingProxyType({}),
) -> Solved:
    """Runs a program on a task's file, with further environment variables. Raises RunFailed."""
    answer = folder / f"answer-{program.name.replace(' ', '-')}.npz"
    interpreter, flag, module, *rest = program.words
    words = (interpreter, flag, module, str(task), str(answer), *rest)
    variables = {"PYTHONDONTWRITEBYTECODE": "1", **variables}
    cost = run(Command(words, folder, answer.with_suffix(".log"), variables, time_limit=time_limit))
    solution = Answer.read(answer)
    meshing = solution.seconds.get("mesh", 0.0)
    return Solved(solution, replace(cost, cpu=cost.cpu - meshing, wall=cost.wall - meshing))
