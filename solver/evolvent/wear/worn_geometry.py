"""The meshed and condensed bodies of a problem that wears, and the part of the worn depth that their meshes include."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from evolvent.contact.problem.condensed_body import CondensedBody, condense_bodies
from evolvent.contact.problem.definition import Placement, Problem, Side
from evolvent.contact.search.pairing import SearchError
from evolvent.contact.step.paired_surfaces import reach_of
from evolvent.contact.step.step_system import StepSystem
from evolvent.fem.body import Body, Traction
from evolvent.fem.surface import Surface
from evolvent.wear.archard import Archard
from evolvent.wear.cycle import Cycle, SideDepths, step_systems
from evolvent.wear.mesh_motion import InteriorMotion, WornSurface, certify_mesh_volume, smallest_edge, worn_mesh
from evolvent.wear.sliding_track import Track, track_of
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.errors import InputError


@dataclass(frozen=True)
class MeshMotion:
    """When and how the meshes follow the worn surfaces.

    depth: depth that the meshes may lack [mm]; they follow earlier where it exceeds a quarter of the shortest cell edge
        at the surface, or half of a contact's reach.
    interior: equation for the displacement of the interior, "elastic" or "harmonic".
    least_quality: smallest scaled Jacobian allowed in a moved mesh.
    """

    depth: float = np.inf
    interior: InteriorMotion = "elastic"
    least_quality: float = 0.05


@dataclass(frozen=True)
class WornGeometry:
    """Bodies as meshed and condensed. Depths (n,) are those of all sides that wear, one side after the other.

    problem: the problem on the present meshes.
    cycle: its cycle.
    prepared: its bodies, condensed.
    sides: the sides that wear.
    tracks: tracks of the sides that travel.
    mesh_depth: (n,) depth that the meshes include [mm].
    """

    problem: Problem
    cycle: Cycle
    prepared: tuple[CondensedBody, ...]
    sides: tuple[Side, ...]
    tracks: dict[Side, Track]
    mesh_depth: Floats

    @staticmethod
    def unworn(problem: Problem, laws: Sequence[Archard], cycle: Cycle) -> WornGeometry:
        """The bodies of a problem, condensed. Raises InputError where nothing wears, or a track cannot be found."""
        sides = _wearing_sides(problem, laws)
        if not sides:
            raise InputError("wear: wanted a K/H above zero on some surface, found none; nothing would wear")
        _refuse_unknown_bodies(cycle, len(problem.bodies))
        prepared = condense_bodies(problem)
        bare = WornGeometry(problem, cycle, prepared, sides, _tracks(sides, cycle, prepared), np.zeros(0))
        return replace(bare, mesh_depth=np.zeros(len(bare.areas)))

    @cached_property
    def systems(self) -> tuple[StepSystem, ...]:
        """The contact systems of the cycle's steps, the same for all depths in the gaps. Raises SearchError."""
        return step_systems(self.problem, self.prepared, self.cycle)

    @cached_property
    def _areas(self) -> list[Floats]:
        return [
            self.tracks[side].areas if side in self.tracks else self.surface(side).weights() for side in self.sides
        ]

    @property
    def areas(self) -> Floats:
        """(n,) areas of all worn nodes, and of the nodes of tracks [mm²; mm in 2D]."""
        return np.concatenate(self._areas)

    @property
    def on_track(self) -> Bools:
        """(n,) which depths are those of a track."""
        return np.repeat([side in self.tracks for side in self.sides], [len(areas) for areas in self._areas])

    def by_side(self, depth: Floats) -> SideDepths:
        """Depths (n,) per side: at its nodes, or over the grid of its track."""
        ends = np.cumsum([len(areas) for areas in self._areas])[:-1]
        return dict(zip(self.sides, np.split(depth, ends)))

    def surface(self, side: Side) -> Surface:
        """The contact surface of a side."""
        return self.prepared[side[0]].surfaces[side[1]]

    def in_gap(self, depth: Floats) -> SideDepths:
        """The part of depths (n,) [mm] that the meshes do not include, per side."""
        return self.by_side(depth - self.mesh_depth)

    def gap_limit(self, motion: MeshMotion, edge_share: float) -> float:
        """Largest depth [mm] that the gap alone may take. edge_share: of the shortest cell edge at a worn surface."""
        bodies = self.problem.bodies
        edges = [smallest_edge(bodies[body].mesh, self.surface((body, group)).nodes) for body, group in self.sides]
        return min(motion.depth, edge_share * min(edges), 0.5 * min(self._reaches()))

    def refuse_beyond_reach(self, depth: Floats) -> None:
        """Raises SearchError where depths (n,) open a gap so far that surfaces may touch beyond the contact's reach."""
        for contact, reach, opening in zip(self.problem.contacts, self._reaches(), self._openings(depth)):
            if not opening <= reach:
                (one, first), (other, second) = contact.first, contact.second
                raise SearchError(
                    f"wear between {first!r} of body {one} and {second!r} of body {other}: wanted a block that opens "
                    f"the gap by less than the contact's reach, {reach:.3g} mm, found {opening:.3g} mm; give the "
                    "contact a larger reach, or take shorter blocks"
                )

    def moved(self, depth: Floats, motion: MeshMotion) -> WornGeometry:
        """The bodies with meshes that include depths (n,), condensed anew.

        Raises MeshInverted; MeshVolumeLost where a mesh has not lost the worn volume.
        """
        problem = self.moved_problem(depth, motion)
        for index, (before, after) in enumerate(zip(self.problem.bodies, problem.bodies)):
            if before is not after:
                certify_mesh_volume(before.mesh, after.mesh, self._volume(index, self.in_gap(depth)))
        return replace(self, problem=problem, prepared=condense_bodies(problem), mesh_depth=depth.copy())

    def moved_problem(self, depth: Floats, motion: MeshMotion) -> Problem:
        """The problem with meshes that include depths (n,); the contacts' reach grows by the gaps' opening, as the
        bodies approach each other by as much. Raises MeshInverted."""
        bodies = tuple(self._moved_body(i, body, depth, motion) for i, body in enumerate(self.problem.bodies))
        reaches = zip(self.problem.contacts, self._reaches(), self._openings(depth))
        contacts = tuple(replace(contact, reach=reach + opening) for contact, reach, opening in reaches)
        return replace(self.problem, bodies=bodies, contacts=contacts)

    def _moved_body(self, index: int, body: Body, depth: Floats, motion: MeshMotion) -> Body:
        worn = list(self._worn_surfaces(index, self.in_gap(depth)))
        if not worn:
            return body
        mesh = worn_mesh(body.mesh, worn, _groups_at_rest(body), motion.interior, motion.least_quality)
        return replace(body, mesh=mesh)

    def _worn_surfaces(self, body: int, depths: SideDepths) -> Iterable[WornSurface]:
        """The worn surfaces of a body with depths at their nodes, on a track interpolated from it."""
        for side in (side for side in self.sides if side[0] == body):
            surface, track = self.surface(side), self.tracks.get(side)
            nodal = depths[side] if track is None else track.hats(surface.points) @ depths[side]
            yield WornSurface(surface, nodal)

    def _volume(self, body: int, depths: SideDepths) -> float:
        """Worn volume Σ m h [mm³; mm² in 2D] of one body's mesh."""
        return sum(float(w.surface.weights() @ w.depth) for w in self._worn_surfaces(body, depths))

    def _reaches(self) -> list[float]:
        """Reach of each contact [mm]."""
        return [reach_of(contact, self.surface(contact.first)) for contact in self.problem.contacts]

    def _openings(self, depth: Floats) -> list[float]:
        """Largest opening [mm] of each contact's gap by the part of depths (n,) that the meshes do not include."""
        largest = {side: float(gap.max(initial=0.0)) for side, gap in self.in_gap(depth).items()}
        return [sum(largest.get(side, 0.0) for side in (c.first, c.second)) for c in self.problem.contacts]


def _wearing_sides(problem: Problem, laws: Sequence[Archard]) -> tuple[Side, ...]:
    sides = []
    for contact, law in zip(problem.contacts, laws):
        sides += [side for side, K in zip((contact.first, contact.second), law.coefficients) if K > 0.0]
    return tuple(dict.fromkeys(sides))


def _refuse_unknown_bodies(cycle: Cycle, bodies: int) -> None:
    """Raises InputError where a travel names a body that does not exist."""
    for travel in cycle.travel:
        if not 0 <= travel.body < bodies:
            raise InputError(f"wear: wanted travel of a body below {bodies}, found body {travel.body}")


def _tracks(sides: Sequence[Side], cycle: Cycle, prepared: tuple[CondensedBody, ...]) -> dict[Side, Track]:
    """Tracks of the sides whose bodies travel, as placed in the last step. Raises InputError."""
    tracks, placements = {}, cycle.steps[-1].placements
    for body, group in sides:
        travels = [travel for travel in cycle.travel if travel.body == body]
        if len(travels) > 1:
            raise InputError(f"wear of body {body}: wanted one travel of a body that wears, found {len(travels)}")
        if travels:
            placement = placements[body] if placements else Placement.at_rest(prepared[body].assembled.d)
            tracks[body, group] = track_of(prepared[body].surfaces[group], travels[0].in_frame(placement))
    return tracks


def _groups_at_rest(body: Body) -> list[str]:
    """Facet groups that do not move with the mesh: rigid, fixed and loaded ones, but no planes of symmetry."""
    rigid = [body.rigid.group] if body.rigid else []
    fixed = [s.group for s in body.supports if set(s.directions) >= set("xyz"[: body.mesh.dimension])]
    return [*{*fixed, *(t.group for t in body.loads if isinstance(t, Traction)), *rigid}]
