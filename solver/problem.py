"""The public API: bodies, contacts, solve, sweep. The verification problems use nothing else.

block = Body(read_msh("block.msh"), supports=(Fixed("bottom"),))
punch = Body(read_msh("punch.msh"), rigid=Rigid("top", (Freedom("y", load=-1000.0),)))
solution = solve(Problem((punch, block), (Contact((0, "face"), (1, "top"), friction=0.2),)))
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from solver.position import ContactResult, History, Position, Solution
from solver.prepared import PreparedBody, prepare
from solver.statement import Contact, Nitsche, Placement, Problem, Side, Step

__all__ = [
    "Contact",
    "ContactResult",
    "Nitsche",
    "Placement",
    "Position",
    "PreparedBody",
    "Problem",
    "Side",
    "Solution",
    "Step",
    "prepare",
    "solve",
    "sweep",
]


def solve(problem: Problem, step: Step | None = None) -> Solution:
    """One step from rest, by default the full load. Raises NotConverged, SearchError."""
    return next(sweep(problem, [step or Step()]))


def sweep(problem: Problem, steps: Iterable[Step]) -> Iterator[Solution]:
    """Solves step after step; friction remembers the step before. Raises NotConverged, SearchError."""
    prepared = prepare(problem)
    before: History | None = None
    for step in steps:
        solution, before = Position(problem, prepared, step).solve(before)
        yield solution
