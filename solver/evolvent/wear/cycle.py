"""One cycle of a problem on worn bodies: the contact states in which surfaces rub, and what each loses there.

A cycle is a few steps, solved one after the other. Surfaces rub by the slip of the steps, or by *travel*: a rigid
motion of a body that goes on through the last state while this stays as it is, such as a disc that turns under its pin.
Cycles of slip follow one another without end: the steps are gone through twice, and the second time counts. What a step
wears is put where it ends, so that a step may not be longer than the contact is wide.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.contact.nitsche.contact_operator import ContactOperator
from evolvent.contact.problem.condensed_body import PreparedBody
from evolvent.contact.problem.definition import Problem, Side, Step
from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.step.step_system import History, Position
from evolvent.fem.surface import Surface
from evolvent.wear.archard import Archard, Places, StepsTooLong
from evolvent.wear.sliding_track import Track, Travel
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError

__all__ = ["Cycle", "Depths", "Rubbing", "Travel", "Worn", "added", "rubbings"]

Depths = dict[Side, Floats]


@dataclass(frozen=True)
class Cycle:
    """Steps, and what goes on through the last of them. Without travel the slip of all steps wears, and the cycle has
    to end where it begins."""

    steps: tuple[Step, ...] = (Step(),)
    travel: tuple[Travel, ...] = ()


@dataclass(frozen=True)
class Rubbing:
    """A contact in one state, per cycle.

    result: the solved contact. sliding: (q,) [mm per cycle] at its points. places: of the points on both surfaces.
    """

    result: ContactResult
    sliding: Floats
    places: tuple[Places, Places]

    @property
    def work(self) -> Floats:
        """w λ s (q,) [N·mm per cycle; per mm in 2D]."""
        return self.result.weights * self.result.pressure * self.sliding

    def depths(self, law: Archard) -> tuple[Floats, Floats]:
        """Depth per cycle [mm] at the nodes of both surfaces, or over their tracks."""
        first, second = (place.depth(K * self.work) for K, place in zip(law.both, self.places))
        return first, second


@dataclass(frozen=True)
class Worn:
    """What the contact law sees of wear: depths already lost per side, and the cycles to come while it acts. Sides that
    wear on a track have it in `tracks`, and their depths are over it; the others' are at the nodes."""

    problem: Problem
    laws: tuple[Archard, ...]
    cycle: Cycle
    depths: Depths
    tracks: Mapping[Side, Track]
    ahead: float = 0.0


def rubbings(worn: Worn, prepared: tuple[PreparedBody, ...]) -> list[list[Rubbing]]:
    """Solves a cycle: per contact, the states in which it rubs. With `ahead` cycles to come the pressure is that at
    their end (implicit Euler), which only a cycle with travel can do; a track keeps its depth meanwhile, as each of its
    places is under the contact for a part of the time only.

    Raises NotConverged, SearchError, StepsTooLong, ValueError.
    """
    if worn.ahead and not worn.cycle.travel:
        raise InputError("wear: wanted travel for an implicit block, found a cycle that wears by its steps' slip")
    before: History | None = None
    found: list[list[Rubbing]] = [[] for _ in worn.laws]
    count, steps = len(worn.cycle.steps), worn.cycle.steps if worn.cycle.travel else 2 * worn.cycle.steps
    for number, step in enumerate(steps):
        position = _Wearing(worn, prepared, step)
        solution, before = position.solve(before)
        if number == len(steps) - 1 if worn.cycle.travel else number >= count:
            for i, result in enumerate(solution.contacts):
                found[i].append(Rubbing(result, position.sliding(i, result), position.places[i]))
    if not any(state.sliding.any() for own in found for state in own):
        raise InputError("wear: wanted a cycle in which something slides, found none; give it travel or moving steps")
    return found


class _Wearing(Position):
    """A position between worn surfaces. Its pairs are those of the bodies as placed: where these overlap, as worn ones
    do, material is gone, and they must not be brought apart (displaced_search.py)."""

    def __init__(self, worn: Worn, prepared: tuple[PreparedBody, ...], step: Step) -> None:
        self.wear = worn
        super().__init__(worn.problem, prepared, step)
        self.places = [self._places(i) for i in range(len(self.operators))]

    def _prescribed(self, sides: tuple[Side, Side], placed: tuple[Surface, Surface]) -> None:
        """Pairs stay those of the bodies as placed."""

    def _places(self, index: int) -> tuple[Places, Places]:
        """Of the points on the contact's first surface and on its second."""
        found, (carrier, other) = self.meetings[index].pairing, self.sides[index]
        places = {
            carrier: self._on(carrier, found.facet1, found.xi1),
            other: self._on(other, found.facet2, found.xi2),
        }
        first, second = self._sides(index)
        return places[first], places[second]

    def _on(self, side: Side, facets: Ints, xi: Floats) -> Places:
        surface, track = self.prepared[side[0]].surfaces[side[1]], self.wear.tracks.get(side)
        if track is None:
            return Places.of(surface, facets, xi)
        return Places(track.hats(surface.positions(facets, xi[:, None])[:, 0]), track.areas)

    def as_seen(self, contact: int) -> ContactOperator:
        """With the depth that is gone between the surfaces, and what goes within the block."""
        operator, law, ahead = self.operators[contact], self.wear.laws[contact], self.wear.ahead
        lost, rate = np.zeros(len(operator.weights)), 0.0
        for places, side, K in zip(self.places[contact], self._sides(contact), law.both):
            if side in self.wear.depths:
                lost += places.at_points(self.wear.depths[side])
            if side not in self.wear.tracks:
                rate += K
        normals = operator.shape @ operator.frames[:, 0]
        going = rate * ahead * self._travelled(contact, operator.points, normals) if ahead else 0.0 * lost
        return operator.worn(lost, going)

    def _sides(self, contact: int) -> tuple[Side, Side]:
        own = self.problem.contacts[contact]
        return own.first, own.second

    def sliding(self, index: int, result: ContactResult) -> Floats:
        """(q,) [mm per cycle]. Raises StepsTooLong."""
        if self.wear.cycle.travel:
            return self._travelled(index, result.points, result.normals)
        slid = np.linalg.norm(result.slip, axis=1)
        pressed = result.pressure > 0.0
        width = float(result.weights[pressed].sum()) ** (1.0 / (self.d - 1))
        longest = float(slid[pressed].max(initial=0.0))
        if longest > width:
            raise StepsTooLong(
                f"wear: wanted steps that slide less than the contact is wide, found {longest:.3g} mm on {width:.3g} "
                "mm; what lies between would be left out: take more steps"
            )
        return np.asarray(slid)

    def _travelled(self, contact: int, points: Floats, normals: Floats) -> Floats:
        """(q,) tangential part of the first body's path over the second one per cycle."""
        path: Floats = np.zeros_like(points)
        for (body, _), sign in zip(self._sides(contact), (1.0, -1.0)):
            for travel in self.wear.cycle.travel:
                path = path + sign * (travel.body == body) * travel.at(points)
        along = path - np.einsum("qa,qa->q", path, normals)[:, None] * normals
        return np.asarray(np.linalg.norm(along, axis=1))


def added(laws: Sequence[Archard], problem: Problem, states: list[list[Rubbing]]) -> Depths:
    """Depth per cycle [mm] on every side that wears, at its nodes or over its track."""
    total: Depths = {}
    for contact, law, own in zip(problem.contacts, laws, states):
        for side, K, number in ((contact.first, law.first, 0), (contact.second, law.second, 1)):
            if K > 0.0:
                depth = np.sum([state.depths(law)[number] for state in own], axis=0)
                total[side] = total.get(side, 0.0) + depth
    return total
