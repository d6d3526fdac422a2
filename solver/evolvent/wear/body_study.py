"""A wear study of a problem of the public API: blocks of cycles, the mesh following, every block's volume certified.

    study = WearStudy(problem, (Archard(first=1.4e-10),), Cycle((Step(),), (Travel(1, translation=(1e3, 0, 0)),)))
    for block in study.blocks(1000.0, BlockSettings(first=10.0)): ...

In the example a cycle is 1 m of sliding. A body that travels wears on its whole track (sliding_track.py): its unknowns
are depths over the track, those of all others are depths at nodes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.problem.condensed_body import PreparedBody, prepare
from evolvent.contact.problem.definition import Placement, Problem, Side
from evolvent.contact.problem.step_pairing import reach_of
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.body import Body, Traction
from evolvent.fem.surface import Surface
from evolvent.wear.archard import Archard, certify_volume
from evolvent.wear.block_stepping import TOO_LONG, Block, BlockSettings, Evaluated, WearState, next_block, unworn
from evolvent.wear.contact_scales import deformation, ripple_decay
from evolvent.wear.cycle import Cycle, Depths, Rubbing, Worn, added, rubbings
from evolvent.wear.mesh_motion import Follow, MeshVolumeLost, WornSurface, certify_loss, smallest_edge, worn_mesh
from evolvent.wear.sliding_track import Track, track_of
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.structured_grid import Mask

SHALLOW = 0.25
"""Of the shortest edge of the cells at a surface: a gap so deep changes no more of the body than the mesh resolves."""


@dataclass(frozen=True)
class Refresh:
    """When the mesh follows: where depth [mm] is more than this that the mesh does not know of, and in any case where
    it is more than SHALLOW cells or half of a contact's reach; how its interior does, and the least scaled Jacobian it
    may have."""

    depth: float = np.inf
    follow: Follow = "elastic"
    least_quality: float = 0.05


@dataclass(frozen=True)
class CycleState(Evaluated):
    """A cycle solved on worn bodies: the contacts as they rub, volumes per cycle of every side that wears [mm³; mm² in
    2D]: at the nodes, and K/H·∫∫p|v_s| dA dt at the contact points."""

    rubbing: tuple[tuple[Rubbing, ...], ...]
    volumes: dict[Side, float]
    integrals: dict[Side, float]


@dataclass(frozen=True)
class Geometry:
    """Bodies as meshed and condensed, and the depth (n,) [mm] that these meshes know of."""

    problem: Problem
    prepared: tuple[PreparedBody, ...]
    known: Floats


class WearStudy:
    """A problem that wears, cycle after cycle. laws: one a contact. tracks: of the sides that travel. Raises
    ValueError."""

    def __init__(
        self, problem: Problem, laws: Sequence[Archard], cycle: Cycle, refresh: Refresh | None = None
    ) -> None:
        if len(laws) != len(problem.contacts):
            raise InputError(f"wear: wanted a law for each of {len(problem.contacts)} contacts, found {len(laws)}")
        self.laws, self.cycle, self.refresh = tuple(laws), cycle, refresh or Refresh()
        self.sides = _wearing_sides(problem, self.laws)
        if not self.sides:
            raise InputError("wear: wanted a K/H above zero on some surface, found none; nothing would wear")
        _known_bodies(cycle, len(problem.bodies))
        prepared = prepare(problem)
        self.tracks = _tracks(self.sides, cycle, prepared)
        self._ends = np.cumsum([0, *map(len, self._areas(prepared))])
        self.geometry = Geometry(problem, prepared, np.zeros(self._ends[-1]))
        self.refreshed, self._share = 0, SHALLOW

    def evaluate(self, depth: Floats, before: CycleState | None = None) -> CycleState:
        """One cycle at depths (n,), its volume certified, see `Wearable`. Raises VolumeLost as well, which shorter
        blocks do not help."""
        return self._solved(depth, 0.0)

    def implicit(self, depth: Floats, now: CycleState, length: float) -> tuple[Floats, CycleState]:
        """A block with the contact law itself wearing, see `Wearable`. Only for cycles with travel. Tracks wear at the
        rate of the block's start."""
        gained = np.where(self._on_track, length * now.rate, 0.0)
        end = self._solved(depth + gained, length)
        return np.where(self._on_track, gained, length * end.rate), end

    def _solved(self, depth: Floats, ahead: float) -> CycleState:
        own = self.geometry
        worn = Worn(own.problem, self.laws, self.cycle, self.by_side(depth - own.known), self.tracks, ahead)
        states = rubbings(worn, own.prepared)
        rates = added(self.laws, own.problem, states)
        rate = np.concatenate([rates[side] for side in self.sides])
        state = CycleState(
            rate, self.areas, deformation(own.problem, states), self._decay(states),
            tuple(map(tuple, states)), self._volumes(rates), self._integrals(states),
        )  # fmt: skip
        _certify(state)
        return state

    def blocks(
        self, cycles: float, settings: BlockSettings, begin: Floats | None = None
    ) -> Iterator[Block[CycleState]]:
        """Blocks until so many cycles are done; begin: depths to start from. Raises WearStopped, VolumeLost."""
        state: WearState[CycleState] = unworn(self, np.zeros(self._ends[-1]) if begin is None else begin, settings)
        while state.cycles < cycles * (1.0 - 1e-12):
            block = next_block(self, state, cycles, settings)
            state = block.state
            yield block

    def accepted(self, depth: Floats, now: CycleState) -> CycleState:
        """Lets the meshes follow where they have to, see `Wearable`."""
        self._refuse_beyond_reach(depth)
        if (depth - self.geometry.known).max() <= self._shallow():
            return now
        before = self.geometry, self.refreshed
        try:
            self.follow(depth)
            return self.evaluate(depth)
        except TOO_LONG as error:
            self.geometry, self.refreshed = before
            if isinstance(error, MeshVolumeLost):  # of curved surfaces: the more the deeper
                self._share *= 0.5
            raise

    def follow(self, depth: Floats) -> None:
        """Moves the meshes to these depths, and condenses the bodies anew. Raises MeshInverted, MeshVolumeLost."""
        old, new = self.geometry, self._moved_problem(depth)
        for index, (before, after) in enumerate(zip(old.problem.bodies, new.bodies)):
            if before is not after:
                certify_loss(before.mesh, after.mesh, self._lost(index, depth - old.known))
        self.geometry, self.refreshed = Geometry(new, prepare(new), depth.copy()), self.refreshed + 1

    def _lost(self, body: int, depth: Floats) -> float:
        """Σ m h of one body's mesh."""
        return sum(float(w.surface.weights() @ w.depth) for w in self._worn(body, self.by_side(depth)))

    @property
    def areas(self) -> Floats:
        """(n,) of all nodes that wear, and of the tracks [mm²; mm in 2D]."""
        return np.concatenate(self._areas(self.geometry.prepared))

    def _areas(self, prepared: tuple[PreparedBody, ...]) -> list[Floats]:
        own = {side: prepared[side[0]].surfaces[side[1]] for side in self.sides}
        return [self.tracks[s].areas if s in self.tracks else surface.weights() for s, surface in own.items()]

    @property
    def _on_track(self) -> Mask:
        """(n,) which depths are those of a track."""
        return np.repeat([side in self.tracks for side in self.sides], np.diff(self._ends))

    def by_side(self, depth: Floats) -> Depths:
        """Depths (n,) as one array a side: at its nodes, or over the grid of its track."""
        return {side: depth[a:b] for side, a, b in zip(self.sides, self._ends, self._ends[1:])}

    def meshes(self, depth: Floats) -> tuple[MeshData, ...]:
        """The bodies' meshes moved to these depths. Raises MeshInverted."""
        return tuple(body.mesh for body in self._moved_problem(depth).bodies)

    def _moved_problem(self, depth: Floats) -> Problem:
        """What a body has lost the other one comes after: the contacts' reach grows by it."""
        new, own = self.by_side(depth - self.geometry.known), self.geometry
        bodies = tuple(self._moved_body(i, body, new) for i, body in enumerate(own.problem.bodies))
        reaches = zip(own.problem.contacts, self._reaches(), self._opened(depth))
        contacts = tuple(replace(contact, reach=reach + opened) for contact, reach, opened in reaches)
        return replace(own.problem, bodies=bodies, contacts=contacts)

    def _refuse_beyond_reach(self, depth: Floats) -> None:
        """Raises SearchError where surfaces have lost so much that they may touch where no contact is looked for."""
        for contact, reach, opened in zip(self.geometry.problem.contacts, self._reaches(), self._opened(depth)):
            if not opened <= reach:
                (one, first), (other, second) = contact.first, contact.second
                raise SearchError(
                    f"wear between {first!r} of body {one} and {second!r} of body {other}: wanted a block that opens "
                    f"the gap by less than the contact's reach, {reach:.3g} mm, found {opened:.3g} mm; give the "
                    "contact a larger reach, or take shorter blocks"
                )

    def _reaches(self) -> list[float]:
        """Of the contacts [mm]."""
        return [reach_of(contact, self._surface(contact.first)) for contact in self.geometry.problem.contacts]

    def _opened(self, depth: Floats) -> list[float]:
        """By how much [mm] depths (n,) that the meshes do not know of may open the contacts' gaps."""
        most = {side: float(new.max(initial=0.0)) for side, new in self.by_side(depth - self.geometry.known).items()}
        contacts = self.geometry.problem.contacts
        return [sum(most.get(side, 0.0) for side in (contact.first, contact.second)) for contact in contacts]

    def _shallow(self) -> float:
        """The largest depth [mm] that the gap alone may take."""
        bodies = self.geometry.problem.bodies
        edges = [smallest_edge(bodies[b].mesh, self._surface((b, group)).nodes) for b, group in self.sides]
        return min(self.refresh.depth, self._share * min(edges), 0.5 * min(self._reaches()))

    def _surface(self, side: Side) -> Surface:
        return self.geometry.prepared[side[0]].surfaces[side[1]]

    def _moved_body(self, index: int, body: Body, new: Depths) -> Body:
        worn = self._worn(index, new)
        if not worn:
            return body
        held = _resting(body)
        mesh = worn_mesh(body.mesh, worn, held, self.refresh.follow, self.refresh.least_quality)
        return replace(body, mesh=mesh)

    def _worn(self, body: int, depths: Depths) -> list[WornSurface]:
        """Surfaces of a body with depths at their nodes, where a track passes them those that it has there."""
        found = []
        for side in (side for side in self.sides if side[0] == body):
            surface, depth = self.geometry.prepared[body].surfaces[side[1]], depths[side]
            track = self.tracks.get(side)
            found.append(WornSurface(surface, depth if track is None else track.hats(surface.points) @ depth))
        return found

    def _volumes(self, rates: Depths) -> dict[Side, float]:
        return {side: float(own @ rates[side]) for side, own in self.by_side(self.areas).items()}

    def _decay(self, states: list[list[Rubbing]]) -> float:
        """See `ripple_decay`; of the sides that stay in place: a track is under the contact for a part of the time."""
        staying = {side: self._surface(side) for side in self.sides if side not in self.tracks}
        return ripple_decay(self.geometry.problem, self.laws, states, staying)

    def _integrals(self, states: list[list[Rubbing]]) -> dict[Side, float]:
        total = dict.fromkeys(self.sides, 0.0)
        for contact, law, own in zip(self.geometry.problem.contacts, self.laws, states):
            for side, K in zip((contact.first, contact.second), law.both):
                if K > 0.0:
                    total[side] += K * sum(float(state.work.sum()) for state in own)
        return total


def _wearing_sides(problem: Problem, laws: Sequence[Archard]) -> tuple[Side, ...]:
    sides = []
    for contact, law in zip(problem.contacts, laws):
        sides += [side for side, K in zip((contact.first, contact.second), law.both) if K > 0.0]
    return tuple(dict.fromkeys(sides))


def _known_bodies(cycle: Cycle, bodies: int) -> None:
    """Raises InputError where a body travels that there is not."""
    for travel in cycle.travel:
        if not 0 <= travel.body < bodies:
            raise InputError(f"wear: wanted travel of a body below {bodies}, found body {travel.body}")


def _tracks(sides: Sequence[Side], cycle: Cycle, prepared: tuple[PreparedBody, ...]) -> dict[Side, Track]:
    """Of the sides whose bodies travel, as they stand in the last step. Raises InputError."""
    found, placements = {}, cycle.steps[-1].placements
    for body, group in sides:
        own = [travel for travel in cycle.travel if travel.body == body]
        if len(own) > 1:
            raise InputError(f"wear of body {body}: wanted one travel of a body that wears, found {len(own)}")
        if own:
            where = placements[body] if placements else Placement.at_rest(prepared[body].assembled.d)
            found[body, group] = track_of(prepared[body].surfaces[group], own[0].in_frame(where))
    return found


def _resting(body: Body) -> list[str]:
    """Facet groups that stay where they are when the mesh moves; a plane of symmetry is not among them."""
    rigid = [body.rigid.group] if body.rigid else []
    fixed = [s.group for s in body.supports if set(s.directions) >= set("xyz"[: body.mesh.dimension])]
    return [*{*fixed, *(t.group for t in body.loads if isinstance(t, Traction)), *rigid}]


def _certify(state: CycleState) -> None:
    """Raises VolumeLost."""
    for side, volume in state.volumes.items():
        certify_volume(f"body {side[0]}, {side[1]!r}", volume, state.integrals[side])
