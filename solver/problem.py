"""The public API: bodies, contacts, solve, sweep. The verification problems use nothing else.

block = Body(read_msh("block.msh"), supports=(Fixed("bottom"),))
punch = Body(read_msh("punch.msh"), rigid=Rigid("top", (Freedom("y", load=-1000.0),)))
solution = solve(Problem((punch, block), (Contact((0, "face"), (1, "top"), friction=0.2),)))
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial

from solver.contact_result import ContactResult
from solver.contact_width import CoarseContactWarning, warn_if_coarse
from solver.position import History, Position, Solution, Where
from solver.prepared import PreparedBody, prepare
from solver.settled import Unsettled, settled
from solver.small_strain import TooLarge
from solver.statement import Contact, Nitsche, Placement, Problem, Side, Step

__all__ = [
    "CoarseContactWarning",
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
    "TooLarge",
    "Unsettled",
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
        _, solution, before = settled(partial(_position, prepared, step), problem, before)
        for contact, result in zip(problem.contacts, solution.contacts):
            warn_if_coarse(f"contact of {contact.first} with {contact.second}", result.width)
        yield solution


def _position(prepared: tuple[PreparedBody, ...], step: Step, problem: Problem, where: Where) -> Position:
    return Position(problem, prepared, step, where)
