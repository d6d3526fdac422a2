"""One cycle of a problem with worn surfaces: its contact states, their sliding distances and the depths worn off.

A cycle is a few steps, solved one after the other. Surfaces slide by the slip of the steps, or by *travel*: a rigid
motion of a body that continues through the last contact state while this state stays the same, such as a disc that
turns under its pin. Cycles of slip repeat without end: the steps are solved twice, and only the second pass counts. The
wear of a step is deposited where the contact is at its end, so a step may not slide further than the contact is wide.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.nitsche.contact_operator import ContactOperator
from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent.contact.problem.definition import Problem, Side, Step
from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.step.step_solution import DeformedSurfaces, Solution
from evolvent.contact.step.step_system import StepSystem
from evolvent.fem.surface import Surface
from evolvent.wear.archard import Archard, DepthProjection, StepsTooLong
from evolvent.wear.sliding_track import Track, Travel
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError

__all__ = ["Cycle", "SideDepths", "SlidingContact", "Travel", "WornCycle", "depth_per_cycle", "solve_cycle"]

SideDepths = dict[Side, Floats]
"""Depths [mm] on each worn side: (n,) at its nodes, or (g,) over the grid of its track."""


@dataclass(frozen=True)
class Cycle:
    """Steps and rigid motions that repeat in a wear study.

    steps: the steps of the cycle, solved one after the other.
    travel: rigid motions that continue through the last step. Without travel the slip of all steps wears, and the
        cycle has to end where it begins.

    >>> cycle = Cycle(travel=(Travel(body=1, translation=(1000.0, 0.0, 0.0)),))  # 1 m of sliding under full load
    """

    steps: tuple[Step, ...] = (Step(),)
    travel: tuple[Travel, ...] = ()


@dataclass(frozen=True)
class SlidingContact:
    """A solved contact state with its sliding distance per cycle.

    result: the solved contact with q points.
    sliding: (q,) sliding distance per cycle at the points [mm].
    projections: onto the nodes, or the track, of the first and of the second surface.
    """

    result: ContactResult
    sliding: Floats
    projections: tuple[DepthProjection, DepthProjection]

    @property
    def work(self) -> Floats:
        """Pressure times sliding distance at the points, w λ s (q,) [N·mm per cycle; per mm of thickness in 2D]."""
        return self.result.weights * self.result.pressure * self.sliding

    def depths(self, law: Archard) -> tuple[Floats, Floats]:
        """Depth per cycle [mm] at the nodes, or over the track, of the first and of the second surface."""
        first, second = (p.depth(K * self.work) for K, p in zip(law.coefficients, self.projections))
        return first, second


@dataclass(frozen=True)
class WornCycle:
    """A cycle of a problem whose surfaces have lost depth.

    problem: bodies and contacts.
    laws: one a contact.
    cycle: its steps and travel.
    depths: worn depths that the meshes do not include, per side; these open the gaps.
    tracks: tracks of the sides that travel; their depths are over the track.
    block: number of cycles of an implicit block; 0: only the given depths act.
    """

    problem: Problem
    laws: tuple[Archard, ...]
    cycle: Cycle
    depths: SideDepths
    tracks: Mapping[Side, Track]
    block: float = 0.0


def step_systems(problem: Problem, prepared: tuple[CondensedBody, ...], cycle: Cycle) -> tuple[StepSystem, ...]:
    """The contact systems of a cycle's steps, which do not depend on worn depths. Raises InputError, SearchError.

    Pairs are those of the bodies as placed. Worn bodies overlap there, as the meshes do not include all of the wear;
    searching on bodies moved apart (displaced_search.py) would be wrong.
    """
    return tuple(StepSystem(problem, prepared, step, as_placed=True) for step in cycle.steps)


def solve_cycle(worn: WornCycle, systems: Sequence[StepSystem]) -> list[list[SlidingContact]]:
    """Solves a cycle on its step systems: per contact, the states in which it slides.

    In an implicit block (`worn.block` > 0, only with travel) the pressure is that of the block's end (backward Euler).
    A track keeps its depth meanwhile: each of its points is under the contact for a fraction of the time only.

    Raises InputError, NotConverged, SearchError, StepsTooLong.
    """
    if worn.block and not worn.cycle.travel:
        raise InputError("wear: wanted travel for an implicit block, found a cycle that wears by its steps' slip")
    before: DeformedSurfaces | None = None
    states: list[list[SlidingContact]] = [[] for _ in worn.laws]
    travels, count = bool(worn.cycle.travel), len(systems)
    for number, system in enumerate(systems if travels else [*systems, *systems]):
        step = _WornStep(worn, system)
        solution, before = step.solve(before)
        if number == count - 1 if travels else number >= count:
            for contact, result in enumerate(solution.contacts):
                sliding = step.sliding(contact, result)
                states[contact].append(SlidingContact(result, sliding, step.projections[contact]))
    if not any(state.sliding.any() for per_contact in states for state in per_contact):
        raise InputError("wear: wanted a cycle in which something slides, found none; give it travel or moving steps")
    return states


@dataclass(frozen=True)
class _WornStep:
    """A step of a cycle: the step system of the unworn bodies, with gaps and stabilisers that include the wear."""

    worn: WornCycle
    system: StepSystem

    def solve(self, before: DeformedSurfaces | None) -> tuple[Solution, DeformedSurfaces]:
        """Equilibrium between the worn surfaces, with the slip since `before`. Raises NotConverged."""
        return self.system.solve(before, [self._operator(i) for i in range(len(self.system.operators))])

    @cached_property
    def projections(self) -> list[tuple[DepthProjection, DepthProjection]]:
        """Per contact, between its points and the nodes, or tracks, of its first and second surface."""
        return [self._projections(i) for i in range(len(self.system.operators))]

    def _projections(self, contact: int) -> tuple[DepthProjection, DepthProjection]:
        pairing, (carrier, other) = self.system.paired[contact].pairing, self.system.sides[contact]
        by_side = {
            carrier: self._projection(carrier, pairing.facet1, pairing.xi1),
            other: self._projection(other, pairing.facet2, pairing.xi2),
        }
        first, second = self._sides(contact)
        return by_side[first], by_side[second]

    def _projection(self, side: Side, facets: Ints, xi: Floats) -> DepthProjection:
        track, surface = self.worn.tracks.get(side), self._surface(side)
        if track is None:
            return DepthProjection.of(surface, facets, xi)
        return DepthProjection(track.hats(surface.positions(facets, xi[:, None])[:, 0]), track.areas)

    def _surface(self, side: Side) -> Surface:
        return self.system.condensed[side[0]].surfaces[side[1]]

    def _sides(self, contact: int) -> tuple[Side, Side]:
        stated = self.worn.problem.contacts[contact]
        return stated.first, stated.second

    def _operator(self, contact: int) -> ContactOperator:
        """The contact operator with the worn depth in its gap and, in an implicit block, the wear of the block as a
        compliance in series with the stabiliser."""
        operator, law, block = self.system.operators[contact], self.worn.laws[contact], self.worn.block
        depth, K_in_place = np.zeros(len(operator.weights)), 0.0
        for projection, side, K in zip(self.projections[contact], self._sides(contact), law.coefficients):
            if side in self.worn.depths:
                depth += projection.at_points(self.worn.depths[side])
            if side not in self.worn.tracks:
                K_in_place += K
        compliance = 0.0 * depth
        if block:
            normals = operator.shape @ operator.frames[:, 0]
            compliance = K_in_place * block * self._travel_distance(contact, operator.points, normals)
        return operator.worn(depth, compliance)

    def sliding(self, contact: int, result: ContactResult) -> Floats:
        """Sliding distance per cycle (q,) [mm] at the points of a contact. Raises StepsTooLong."""
        if self.worn.cycle.travel:
            return self._travel_distance(contact, result.points, result.normals)
        slip = np.linalg.norm(result.slip, axis=1)
        pressed = result.pressure > 0.0
        width = float(result.weights[pressed].sum()) ** (1.0 / (self.system.d - 1))
        longest = float(slip[pressed].max(initial=0.0))
        if longest > width:
            raise StepsTooLong(
                f"wear: wanted steps that slide less than the contact is wide, found {longest:.3g} mm on {width:.3g} "
                "mm; what lies between would be left out: take more steps"
            )
        return np.asarray(slip)

    def _travel_distance(self, contact: int, points: Floats, normals: Floats) -> Floats:
        """Tangential distance per cycle (q,) [mm] that the first body travels over the second at points (q, d)."""
        path: Floats = np.zeros_like(points)
        for (body, _), sign in zip(self._sides(contact), (1.0, -1.0)):
            for travel in self.worn.cycle.travel:
                path = path + sign * (travel.body == body) * travel.at(points)
        tangential = path - np.einsum("qa,qa->q", path, normals)[:, None] * normals
        return np.asarray(np.linalg.norm(tangential, axis=1))


def depth_per_cycle(
    laws: Sequence[Archard], problem: Problem, states: Sequence[Sequence[SlidingContact]]
) -> SideDepths:
    """Depth per cycle [mm] on every worn side, summed over its contacts and their sliding states."""
    total: SideDepths = {}
    for contact, law, sliding in zip(problem.contacts, laws, states):
        for side, K, number in ((contact.first, law.first, 0), (contact.second, law.second, 1)):
            if K > 0.0:
                depth = np.sum([state.depths(law)[number] for state in sliding], axis=0)
                total[side] = total.get(side, 0.0) + depth
    return total
