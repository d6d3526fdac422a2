"""A step whose surfaces meet where they come to lie.

Pairs of points are found as the bodies are placed, and jumps are taken along the normals there. That is right as long
as the step moves the bodies little along their contact: one that is dragged off an edge, or turned, keeps partners that
it has left; what comes into contact from beyond `reach` has none; and bodies that are placed in overlap are paired as
they never meet. So every solution is looked at again:

- where its deformed surfaces overlap without pairs, the contact is searched wider;
- where the bodies, each moved along with its surface at the contact as a rigid body, and then pulled apart until they
  touch, have other partners, gaps or normals than those the solution is made with, the step is solved again on these.

The rigid motion of a surface at its contact has all motions in it: prescribed ones, free ones and those of a part of
the body that bends. Left out is what strains it, and turns of the size of strains: small strain neglects them, here as
elsewhere, so that a contact that is pressed where it lies is solved on the undeformed shape, like Hertz'.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.problem.definition import Problem
from evolvent.contact.problem.step_pairing import (
    Meeting,
    Pair,
    Places,
    Supports,
    between,
    displaced,
    extent,
    overlapping,
    reach_of,
)
from evolvent.contact.search.pairing import SearchError
from evolvent.contact.search.projection import locate
from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.step.small_strain import refuse_large
from evolvent.contact.step.step_system import History, Position, Solution, Where
from evolvent.fem.material import contact_modulus
from evolvent.fem.rigid_modes import rigid_modes
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.errors import ResultError

GAP = 2e-3  # of the depth p0 a/E* of the contact: a change of gaps that is let pass
TILT = 0.01  # rad between the normals before and after, mean square over the force; turns below it are not gone along
DRIFT = 0.01  # of the contact's width: how far from each other partners may come to lie
NEAR = 0.5  # of a facet: a place without a pair so near has not been searched
ROUNDS = 12

Of = TypeVar("Of", bound=Position)
State = tuple[Of, Solution, History]


class Unsettled(ResultError):
    """The surfaces meet elsewhere after each search, or overlap where there are no pairs."""


@dataclass(frozen=True)
class Seen:
    """A contact on the surfaces of its solution.

    where: the surfaces, brought together; None where nothing presses.
    gap: change of the gaps over the contact's depth, but for a slope along the contact.
    tilt: [rad] of the normals.
    drift: of the partners, over the contact's width.
    missed: [mm] deepest overlap without pairs.
    wanted: [mm] the reach that would have found them, 0 where a wider one would not.
    """

    where: Places | None
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
    spent = 0
    for searches in range(1, ROUNDS + 1):
        position = make(problem, where)
        solution, after = position.solve(before)
        spent += solution.iterations
        yield position, replace(solution, iterations=spent, searches=searches), after
        seen = [look(position, i, *own) for i, own in enumerate(zip(solution.contacts, after.points))]
        if any(own.wanted for own in seen):
            problem = _widened(position, seen)
        elif all(own.near and not own.missed for own in seen):
            return
        else:
            where = tuple(own.where for own in seen)
    raise Unsettled(_unsettled(position, seen))


def look(position: Position, index: int, result: ContactResult, places: Places) -> Seen:
    """A contact of a solution whose surfaces' nodes have come to lie there. Raises SearchError where these have
    folded."""
    meeting = result.meeting
    first, second = (position.problem.bodies[body].material for body, _ in position.sides[index])
    pressed = np.flatnonzero(result.pressure > 0.0)
    width = result.width.width if len(pressed) else 0.0
    depth = float(result.pressure.max(initial=0.0)) * 0.5 * width / contact_modulus(first, second)
    missed, wanted = _missed(position, index, meeting, displaced(meeting.placed, places), GAP * depth)
    if not len(pressed):
        return Seen(None, 0.0, 0.0, 0.0, missed, wanted)
    share = np.maximum((result.weights * result.pressure)[pressed], 0.0)  # a few weights may be slightly negative
    share /= share.sum()
    where = _together(meeting, places, pressed, share)
    gap, tilt, drift = _partners(meeting, displaced(meeting.placed, where), pressed)
    tilted = float(np.sqrt(share @ tilt**2))
    bent = _bent(gap, result.points[pressed], share)
    return Seen(where, bent / depth, tilted, float(drift.max()) / width, missed, wanted)


def _bent(change: Floats, points: Floats, share: Floats) -> float:
    """Largest of the changes (p,) of gaps at points (p, d), but for their slope: a curved contact that moves along the
    surface has one, which alters its place and nothing else."""
    if not np.isfinite(change).all():
        return float("inf")
    weight = np.sqrt(share)
    arms = points - share @ points
    slope = np.linalg.lstsq(weight[:, None] * arms, weight * (change - share @ change), rcond=None)[0]
    return float(np.abs(change - arms @ slope).max())


def _together(meeting: Meeting, places: Places, pressed: Ints, share: Floats) -> Places:
    """Both surfaces, moved along with their contact as rigid bodies, and apart until no pressed point overlaps. share:
    (p,) of the force at the pressed points."""
    found = meeting.pairing
    moved = [
        _carried(surface, supports, x, facets[pressed], xi[pressed], share)
        for surface, supports, x, facets, xi in zip(
            meeting.placed, meeting.supports, places, (found.facet1, found.facet2), (found.xi1, found.xi2)
        )
    ]
    pair = displaced(meeting.placed, (moved[0], moved[1]))
    normal = _normals(pair[0], found.facet1[pressed], found.xi1[pressed])
    gap = _gaps(meeting, pair, pressed, normal)
    overlap = float(-gap[np.isfinite(gap)].min(initial=0.0))
    return moved[0], moved[1] + overlap * _free(meeting, pressed, share @ normal)


def _free(meeting: Meeting, pressed: Ints, direction: Floats) -> Floats:
    """A direction (d,) of the contact without what leads out of its planes of symmetry: the mean normal of half a
    contact points to one side of its plane."""
    free = direction
    for surface, supports, facets in zip(meeting.placed, meeting.supports, _facets(meeting)):
        held = supports.held[surface.facets[facets[pressed]]].any(axis=(0, 1))
        free = free - supports.rotation @ np.where(held, supports.rotation.T @ free, 0.0)
    return free if np.linalg.norm(free) > 0.5 * np.linalg.norm(direction) else direction


def _facets(meeting: Meeting) -> tuple[Ints, Ints]:
    return meeting.pairing.facet1, meeting.pairing.facet2


def _carried(surface: Surface, supports: Supports, places: Floats, facets: Ints, xi: Floats, share: Floats) -> Floats:
    """The nodes (n, d) of a surface after the rigid motion that fits the displacements at the points (p,) best, among
    those that the supports there allow: a plane of symmetry allows what keeps to it."""
    points = surface.positions(facets, xi[:, None])[:, 0]
    u = surface.evaluate(places - surface.points, facets, xi[:, None])[0][:, 0]
    centre, weight, d = share @ points, np.sqrt(share)[:, None], points.shape[1]
    R = supports.rotation
    allowed = _allowed(supports.held[surface.facets[facets]])
    modes = (weight[..., None] * rigid_modes((points - centre) @ R)[:, :, allowed]).reshape(len(points) * d, -1)
    motion = np.zeros(d * (d + 1) // 2)
    motion[allowed] = np.linalg.lstsq(modes, (weight * (u @ R)).ravel(), rcond=None)[0]
    turn = np.pad(motion[d:], (3 - len(motion[d:]), 0))
    if np.linalg.norm(turn) <= TILT:
        turn = np.zeros(3)
    turned = R @ Rotation.from_rotvec(turn).as_matrix()[:d, :d] @ R.T
    return np.asarray(centre + R @ motion[:d] + (surface.points - centre) @ turned.T)


def _allowed(held: Bools) -> Ints:
    """Rigid motions (r,) of a surface of which some nodes (p, k, d) are held: none along a direction that is held
    anywhere, and turns about it only."""
    d = held.shape[-1]
    along = held.any(axis=(0, 1))
    if d == 2:
        return np.flatnonzero(np.append(~along, not along.any()))
    about = [not np.delete(along, axis).any() for axis in range(3)]
    return np.flatnonzero(np.concatenate([~along, about]))


def _partners(meeting: Meeting, moved: Pair, pressed: Ints) -> tuple[Floats, Floats, Floats]:
    """Of the points that press, on the surfaces as they have moved: change of the gap [mm] when the partner is looked
    for along the normal there, angle [rad] between the normals before and after, distance [mm] of the partners along
    the surface; (p,) each, infinite gaps where there is no partner any more."""
    found, op = meeting.pairing, meeting.operator
    normal = _unit(op.shape[pressed] @ op.frames[:, 0])
    now = _normals(moved[0], found.facet1[pressed], found.xi1[pressed])
    apart = between(moved, found)[pressed]
    change = _gaps(meeting, moved, pressed, now) - np.einsum("qa,qa->q", normal, apart)
    along = apart - np.einsum("qa,qa->q", now, apart)[:, None] * now
    return change, np.linalg.norm(now - normal, axis=1), np.linalg.norm(along, axis=1)


def _gaps(meeting: Meeting, moved: Pair, pressed: Ints, normal: Floats) -> Floats:
    """(p,) [mm] gaps of the points that press, along normals (p, d) on moved surfaces; infinite without a partner."""
    found = meeting.pairing
    start = moved[0].positions(found.facet1[pressed], found.xi1[pressed][:, None])
    guess = found.xi2[pressed][:, None]
    _, gap, there = locate(moved[1], found.facet2[pressed], start, normal[:, None], guess)
    return np.where(there[:, 0], gap[:, 0], np.inf)


def _normals(surface: Surface, facets: Ints, xi: Floats) -> Floats:
    return _unit(surface.evaluate(surface.normals, facets, xi[:, None])[0][:, 0])


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
    normal = _normals(moved[0], facets, xi)
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
        f"{contact.second[0]}: wanted surfaces that meet where they were searched, found them elsewhere after {ROUNDS} "
        f"searches (gaps off by {own.gap:.2g} of the contact's depth, normals by {own.tilt:.2g} rad, partners by "
        f"{own.drift:.2g} of its width); load in smaller steps"
    )
