"""A step whose surfaces meet where they come to lie.

Pairs of points are found as the bodies are placed, and jumps are taken along the normals there. That is right as long
as the step moves them little: pressed by a fifth of the radius, half-spheres are off by several per cent of the peak
pressure, and by opposite signs for a prescribed motion and for a placement in overlap; a body dragged off an edge keeps
partners that it has left; what comes into contact from beyond `reach` has none. So every solution is looked at on its
displaced surfaces:

- where these overlap without pairs, the contact is searched wider, or there;
- where gaps, normals or partners are others than the solution took them for, the step is solved again with the pairs of
  the displaced surfaces, until the forces no longer change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from scipy.spatial import cKDTree

from meshes.data import Floats
from meshes.errors import ResultError
from solver.contact_result import ContactResult
from solver.material import joint_modulus
from solver.meeting import Meeting, Pair, Places, between, displaced, extent, overlapping, reach_of
from solver.newton import NotConverged
from solver.position import History, Position, Solution, Where
from solver.projection import locate
from solver.search import SearchError
from solver.small_strain import refuse_large
from solver.statement import Problem

GAP = 2e-3  # of the depth p0 a/E* of the contact: a change of gaps that is let pass
TILT = 0.02  # rad between the normals before and after, mean square over the force
DRIFT = 0.01  # of the contact's width: how far from each other partners may come to lie
CHANGE = 2e-3  # of the nodal forces, from search to search
NEAR = 0.5  # of a facet: a place without a pair so near has not been searched
ROUNDS = 12

Of = TypeVar("Of", bound=Position)
State = tuple[Of, Solution, History]


class Unsettled(ResultError):
    """The surfaces meet elsewhere after each search, or overlap where no pair was found."""


@dataclass(frozen=True)
class Seen:
    """A contact on its displaced surfaces.

    gap: change of the gaps over the contact's depth.
    tilt: [rad] of the normals.
    drift: of the partners, over the contact's width.
    missed: [mm] deepest overlap without pairs.
    wanted: [mm] the reach that would have found them, 0 where a wider one would not.
    """

    gap: float
    tilt: float
    drift: float
    missed: float
    wanted: float

    @property
    def near(self) -> bool:
        """Whether the pairs may stay as they are."""
        return self.gap <= GAP and self.tilt <= TILT and self.drift <= DRIFT


def settled(make: Callable[[Problem, Where], Of], problem: Problem, before: History | None) -> State[Of]:
    """The equilibrium of a step on the pairs of its displaced surfaces, with the slip since `before`, and what the next
    step remembers of it.

    make: the step's position, from the problem with reaches that may have grown, and where to search. The solution's
    iterations are those of all searches. Raises NotConverged, SearchError, Unsettled, TooLarge.
    """
    found: State[Of] | None = None
    try:
        for state in _rounds(make, problem, before):
            found = state
    except (NotConverged, SearchError, Unsettled):
        if found is not None:
            refuse_large(*found)  # surfaces displaced so far need not have pairs any more
        raise
    assert found is not None
    refuse_large(*found)
    return found


def _rounds(make: Callable[[Problem, Where], Of], problem: Problem, before: History | None) -> Iterator[State[Of]]:
    """Solutions from search to search; the last one is settled."""
    where: Where = None
    last: Solution | None = None
    spent = 0
    for searches in range(1, ROUNDS + 1):
        position = make(problem, where)
        solution, after = position.solve(before)
        spent += solution.iterations
        yield position, replace(solution, iterations=spent, searches=searches), after
        seen = [look(position, i, *own) for i, own in enumerate(zip(solution.contacts, after.points))]
        if any(own.wanted for own in seen):
            problem, last = _widened(position, seen), None
            continue
        same = all(own.near for own in seen) if last is None else change(last, solution) <= CHANGE
        if same and not any(own.missed for own in seen):
            return
        where, last = after.points, solution
    raise Unsettled(_unsettled(position, seen))


def change(last: Solution, now: Solution) -> float:
    """Of the nodal forces on all bodies, as a share of them."""
    both = [np.concatenate(solution.nodal_forces) for solution in (last, now)]
    size = float(np.abs(both[1]).sum())
    return float(np.abs(both[1] - both[0]).sum()) / size if size else 0.0


def look(position: Position, index: int, result: ContactResult, places: Places) -> Seen:
    """A contact of a solution, on surfaces whose nodes lie there. Raises SearchError where these have folded."""
    meeting = result.meeting
    moved = displaced(meeting.placed, places)
    first, second = (position.problem.bodies[body].material for body, _ in position.sides[index])
    width = result.width.width if np.isfinite(result.width.width) else 0.0
    depth = float(result.pressure.max(initial=0.0)) * 0.5 * width / joint_modulus(first, second)
    missed, wanted = _missed(position, index, meeting, moved, GAP * depth)
    pressed = np.flatnonzero(result.pressure > 0.0)
    if not len(pressed):
        return Seen(0.0, 0.0, 0.0, missed, wanted)
    gap, tilt, drift = _partners(meeting, moved, pressed)
    share = (result.weights * result.pressure)[pressed]
    tilted = float(np.sqrt(share @ tilt**2 / share.sum()))
    return Seen(float(gap.max()) / depth, tilted, float(drift.max()) / width, missed, wanted)


def _partners(meeting: Meeting, moved: Pair, pressed: np.ndarray) -> tuple[Floats, Floats, Floats]:
    """Of the points that press, on the surfaces as they have moved: change of the gap [mm] when the partner is looked
    for along the normal there, angle [rad] between the normals before and after, distance [mm] of the partners along
    the surface; (p,) each, infinite gaps where there is no partner any more."""
    found, op = meeting.pairing, meeting.operator
    facet1, xi1, facet2, xi2 = (x[pressed] for x in (found.facet1, found.xi1, found.facet2, found.xi2))
    normal = _unit(op.shape[pressed] @ op.frames[:, 0])
    now = _unit(moved[0].evaluate(moved[0].normals, facet1, xi1[:, None])[0][:, 0])
    start = moved[0].positions(facet1, xi1[:, None])
    apart = moved[1].positions(facet2, xi2[:, None])[:, 0] - start[:, 0]
    taken = np.einsum("qa,qa->q", normal, apart)
    _, gap, there = locate(moved[1], facet2, start, now[:, None], xi2[:, None])
    change = np.where(there[:, 0], np.abs(gap[:, 0] - taken), np.inf)
    return change, np.linalg.norm(now - normal, axis=1), np.linalg.norm(apart - taken[:, None] * normal, axis=1)


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _missed(position: Position, index: int, meeting: Meeting, moved: Pair, tolerance: float) -> tuple[float, float]:
    """How deep [mm] the surfaces overlap where there are no pairs, and the reach [mm] that would have found them."""
    reach = position.reaches[index]
    found = overlapping(moved, reach)
    deep = found.gap < -max(tolerance, 1e-9 * extent(meeting.placed[0]))
    if not deep.any():
        return 0.0, 0.0
    facets, xi = found.facet1[deep], found.xi1[deep]
    normal = _unit(moved[0].evaluate(moved[0].normals, facets, xi[:, None])[0][:, 0])
    before = np.einsum("qa,qa->q", normal, between(meeting.searched, found)[deep])
    at = meeting.placed[0].positions(facets, xi[:, None])[:, 0]
    away = cKDTree(meeting.operator.points).query(at)[0] / meeting.placed[0].size
    missed = (before > reach) | (away > NEAR)
    if not missed.any():
        return 0.0, 0.0
    furthest = float(before[missed].max())
    return float(-found.gap[deep][missed].min()), max(2.0 * reach, 1.1 * furthest) if furthest > reach else 0.0


def _widened(position: Position, seen: list[Seen]) -> Problem:
    """The problem with the reaches that were wanted. Raises Unsettled for one larger than the surface."""
    contacts = list(position.problem.contacts)
    for i, own in enumerate(seen):
        if own.wanted > extent(position.meetings[i].placed[0]) + reach_of(contacts[i], position.meetings[i].placed[0]):
            raise Unsettled(_unsettled(position, seen))
        if own.wanted:
            contacts[i] = replace(contacts[i], reach=own.wanted)
    return replace(position.problem, contacts=tuple(contacts))


def _unsettled(position: Position, seen: list[Seen]) -> str:
    worst = max(range(len(seen)), key=lambda i: (seen[i].missed, seen[i].gap))
    contact, own = position.problem.contacts[worst], seen[worst]
    if own.missed:
        return (
            f"contact between {contact.first[1]!r} of body {contact.first[0]} and {contact.second[1]!r} of body "
            f"{contact.second[0]}: wanted pairs wherever the deformed surfaces overlap, found an overlap of "
            f"{own.missed:.3g} mm without; give the contact a larger reach, or load in smaller steps"
        )
    return (
        f"contact between {contact.first[1]!r} of body {contact.first[0]} and {contact.second[1]!r} of body "
        f"{contact.second[0]}: wanted forces that change by less than {CHANGE:g} from one search on the displaced "
        f"surfaces to the next, found more after {ROUNDS} searches; load in smaller steps"
    )
