"""Solution of a step whose surfaces are searched again where they come to lie.

Pairs of points are searched as the bodies are placed, and jumps are taken along the normals there. That is accurate as
long as the step moves the bodies little along their contact. A body that is dragged off an edge, or turned, keeps
partners that it has left; a part that comes into contact from beyond `reach` has none; and bodies that are placed in
overlap are paired where they never meet. Therefore every solution is checked (pairing_check.py):

- where its deformed surfaces overlap without pairs, the reach of the contact is increased;
- where partners, gaps or normals have changed, the step is solved again with pairs of the displaced surfaces.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.problem.definition import Contact, Problem
from evolvent.contact.search.pairing import SearchError
from evolvent.contact.step.paired_surfaces import extent, reach_of
from evolvent.contact.step.pairing_check import PairingCheck, check_pairing
from evolvent.contact.step.small_strain import refuse_large_strain
from evolvent.contact.step.step_solution import DeformedSurfaces, Solution
from evolvent.contact.step.step_system import SearchPositions, StepSystem
from evolvent_meshes.errors import ResultError

SEARCHES = 12
"""Searches after which a step is given up."""

Solved = tuple[StepSystem, Solution, DeformedSurfaces]
SystemOf = Callable[[Problem, SearchPositions], StepSystem]
Solve = Callable[[StepSystem, DeformedSurfaces | None], tuple[Solution, DeformedSurfaces]]


class PairingNotSettled(ResultError):
    """The surfaces meet elsewhere after each search, or overlap where there are no pairs."""


def solve_with_displaced_search(
    system_of: SystemOf, problem: Problem, previous: DeformedSurfaces | None, solve: Solve = StepSystem.solve
) -> Solved:
    """The equilibrium of a step with the pairs of its displaced surfaces, and the deformed surfaces for the next step.

    system_of: makes the step's system from the problem, whose reaches may have grown, and the positions for the search.
    previous: deformed surfaces of the step before, from which the slip is measured.
    solve: solves a system, with the slip since `previous`.

    The iterations of the solution are those of all searches. Raises NotConverged, SearchError, PairingNotSettled,
    SmallStrainExceeded.
    """
    last: Solved | None = None
    try:
        for solved in _searches(system_of, problem, previous, solve):
            last = solved
    except (NotConverged, SearchError, PairingNotSettled):
        if last is not None:
            refuse_large_strain(*last)  # surfaces displaced that far need not have pairs any more
        raise
    assert last is not None
    refuse_large_strain(*last)
    return last


def _searches(
    system_of: SystemOf, problem: Problem, previous: DeformedSurfaces | None, solve: Solve
) -> Iterator[Solved]:
    """Solutions from search to search; the last one has pairs that hold."""
    search_at: SearchPositions = None
    iterations = 0
    for searches in range(1, SEARCHES + 1):
        system = system_of(problem, search_at)
        solution, deformed = solve(system, previous)
        iterations += solution.iterations
        yield system, replace(solution, iterations=iterations, searches=searches), deformed
        checks = [
            check_pairing(system, i, result, positions)
            for i, (result, positions) in enumerate(zip(solution.contacts, deformed.positions))
        ]
        if any(check.needed_reach for check in checks):
            problem = _with_larger_reach(system, checks)
        elif all(check.pairs_hold and not check.unpaired_overlap for check in checks):
            return
        else:
            search_at = tuple(check.positions for check in checks)
    raise PairingNotSettled(_not_settled(system, checks))


def _with_larger_reach(system: StepSystem, checks: list[PairingCheck]) -> Problem:
    """The problem with the reaches needed. Raises PairingNotSettled for one that is larger than the surface."""
    contacts = list(system.problem.contacts)
    for i, check in enumerate(checks):
        surface = system.paired[i].placed[0]
        if check.needed_reach > extent(surface) + reach_of(contacts[i], surface):
            raise PairingNotSettled(_not_settled(system, checks))
        if check.needed_reach:
            contacts[i] = replace(contacts[i], reach=check.needed_reach)
    return replace(system.problem, contacts=tuple(contacts))


def _not_settled(system: StepSystem, checks: list[PairingCheck]) -> str:
    """The message for the contact that is furthest from settled."""
    worst = max(range(len(checks)), key=lambda i: (checks[i].unpaired_overlap, checks[i].gap_change))
    name, check = _name(system.problem.contacts[worst]), checks[worst]
    if check.unpaired_overlap:
        return (
            f"{name}: wanted pairs wherever the deformed surfaces overlap, found an overlap of "
            f"{check.unpaired_overlap:.3g} mm without; give the contact a larger reach, or load in smaller steps"
        )
    return (
        f"{name}: wanted surfaces that meet where they were searched, found them elsewhere after {SEARCHES} "
        f"searches (gaps off by {check.gap_change:.2g} of the contact's depth, normals by {check.tilt:.2g} rad, "
        f"partners by {check.drift:.2g} of its width); load in smaller steps"
    )


def _name(contact: Contact) -> str:
    (first, surface1), (second, surface2) = contact.first, contact.second
    return f"contact between {surface1!r} of body {first} and {surface2!r} of body {second}"
