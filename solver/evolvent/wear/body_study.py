"""A wear study of a problem of the public API: blocks of cycles, certified volumes, meshes that follow the wear.

    study = WearStudy(problem, (Archard(first=1.4e-10),), Cycle((Step(),), (Travel(1, translation=(1e3, 0, 0)),)))
    for block in study.blocks(1000.0, BlockSettings(first=10.0)): ...

In the example a cycle is 1 m of sliding. Depths (n,) are those of all sides that wear, one side after the other: at the
nodes, or over the track of a body that travels (sliding_track.py).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.contact.problem.definition import Problem, Side
from evolvent.wear.archard import Archard, certify_volume
from evolvent.wear.block_stepping import (
    RETRIED_ERRORS,
    Block,
    BlockSettings,
    CycleEvaluation,
    WearState,
    initial_wear_state,
    next_block,
)
from evolvent.wear.contact_scales import deformation, ripple_decay
from evolvent.wear.cycle import Cycle, SideDepths, SlidingContact, WornCycle, depth_per_cycle, solve_cycle
from evolvent.wear.mesh_motion import MeshVolumeLost
from evolvent.wear.sliding_track import Track
from evolvent.wear.worn_geometry import MeshMotion, WornGeometry
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.mesh.mesh_data import MeshData

EDGE_SHARE = 0.25
"""Limit of the depth in the gap over the shortest cell edge at a worn surface: up to this the depth changes the body's
stiffness by no more than the mesh resolves."""


@dataclass(frozen=True)
class CycleState(CycleEvaluation):
    """A cycle solved on worn bodies.

    contacts: per contact, the states in which it slides.
    volumes: per side that wears, Σ m h per cycle at its nodes [mm³; mm² in 2D].
    integrals: the same as (K/H)∫∫p|v_s| dA dt at the contact points.
    """

    contacts: tuple[tuple[SlidingContact, ...], ...]
    volumes: dict[Side, float]
    integrals: dict[Side, float]


class WearStudy:
    """Wear of any problem of the public API; a `WearModel` for block stepping.

    laws: Archard's coefficients, one pair a contact.
    geometry: the bodies as meshed at present.
    mesh_updates: number of times that the meshes have followed the wear.
    """

    def __init__(
        self, problem: Problem, laws: Sequence[Archard], cycle: Cycle, mesh_motion: MeshMotion | None = None
    ) -> None:
        """Condenses the bodies. Raises InputError for laws that do not fit the contacts, where nothing wears, and where
        a body travels whose surface is not a track."""
        if len(laws) != len(problem.contacts):
            raise InputError(f"wear: wanted a law for each of {len(problem.contacts)} contacts, found {len(laws)}")
        self.laws, self.cycle, self.mesh_motion = tuple(laws), cycle, mesh_motion or MeshMotion()
        self.geometry = WornGeometry.unworn(problem, self.laws, cycle)
        self.mesh_updates, self._edge_share = 0, EDGE_SHARE

    @property
    def sides(self) -> tuple[Side, ...]:
        """The sides (body, facet group) that wear."""
        return self.geometry.sides

    @property
    def tracks(self) -> Mapping[Side, Track]:
        """The tracks of the sides that travel."""
        return self.geometry.tracks

    @property
    def areas(self) -> Floats:
        """(n,) areas of all worn nodes, and of the nodes of tracks [mm²; mm in 2D]."""
        return self.geometry.areas

    def by_side(self, depth: Floats) -> SideDepths:
        """Depths (n,) per side: at its nodes, or over the grid of its track."""
        return self.geometry.by_side(depth)

    def meshes(self, depth: Floats) -> tuple[MeshData, ...]:
        """The bodies' meshes moved to depths (n,) [mm]. Raises MeshInverted."""
        return tuple(body.mesh for body in self.geometry.moved_problem(depth, self.mesh_motion).bodies)

    def blocks(
        self, cycles: float, settings: BlockSettings, begin: Floats | None = None
    ) -> Iterator[Block[CycleState]]:
        """Blocks until `cycles` cycles are done.

        begin: (n,) depths to start from [mm]; none by default. Raises WearStopped, VolumeLost; from the first cycle
        also NotConverged and SearchError.
        """
        start = np.zeros(len(self.areas)) if begin is None else begin
        state: WearState[CycleState] = initial_wear_state(self, start, settings)
        while state.cycles < cycles * (1.0 - 1e-12):
            block = next_block(self, state, cycles, settings)
            state = block.state
            yield block

    def evaluate(self, depth: Floats, previous: CycleState | None = None) -> CycleState:
        """One cycle at depths (n,), see `WearModel`. Also raises VolumeLost, which a shorter block does not mend."""
        return self._solve(depth, 0.0)

    def implicit_block(self, depth: Floats, start: CycleState, length: float) -> tuple[Floats, CycleState]:
        """A block by the contact law with wear, see `WearModel`; for cycles with travel only. Tracks wear at the rate
        of the block's start."""
        on_track = self.geometry.on_track
        track_depth = np.where(on_track, length * start.rate, 0.0)
        end = self._solve(depth + track_depth, length)
        return np.where(on_track, track_depth, length * end.rate), end

    def accept(self, depth: Floats, end: CycleState) -> CycleState:
        """Updates the meshes where the gap lacks too much of depths (n,), see `WearModel`."""
        self.geometry.refuse_beyond_reach(depth)
        if (depth - self.geometry.mesh_depth).max() <= self.geometry.gap_limit(self.mesh_motion, self._edge_share):
            return end
        before = self.geometry, self.mesh_updates
        try:
            self.update_meshes(depth)
            return self.evaluate(depth)
        except RETRIED_ERRORS as error:
            self.geometry, self.mesh_updates = before
            if isinstance(error, MeshVolumeLost):  # its error on curved surfaces grows with the depth of an update
                self._edge_share *= 0.5
            raise

    def update_meshes(self, depth: Floats) -> None:
        """Moves the meshes to depths (n,) [mm] and condenses the bodies anew. Raises MeshInverted, MeshVolumeLost."""
        self.geometry, self.mesh_updates = self.geometry.moved(depth, self.mesh_motion), self.mesh_updates + 1

    def _solve(self, depth: Floats, block: float) -> CycleState:
        """One cycle at depths (n,); block: cycles of an implicit block. Raises VolumeLost, NotConverged, SearchError,
        StepsTooLong."""
        geometry = self.geometry
        worn = WornCycle(geometry.problem, self.laws, self.cycle, geometry.in_gap(depth), geometry.tracks, block)
        states = solve_cycle(worn, geometry.systems)
        rates = depth_per_cycle(self.laws, geometry.problem, states)
        in_place = {side: geometry.surface(side) for side in self.sides if side not in self.tracks}
        state = CycleState(
            rate=np.concatenate([rates[side] for side in self.sides]),
            areas=self.areas,
            deformation=deformation(geometry.problem, states),
            ripple_decay=ripple_decay(geometry.problem, self.laws, states, in_place),
            contacts=tuple(map(tuple, states)),
            volumes={side: float(areas @ rates[side]) for side, areas in self.by_side(self.areas).items()},
            integrals=self._integrals(states),
        )
        for (body, group), volume in state.volumes.items():
            certify_volume(f"body {body}, {group!r}", volume, state.integrals[body, group])
        return state

    def _integrals(self, states: Sequence[Sequence[SlidingContact]]) -> dict[Side, float]:
        total = dict.fromkeys(self.sides, 0.0)
        for contact, law, sliding in zip(self.geometry.problem.contacts, self.laws, states):
            for side, K in zip((contact.first, contact.second), law.coefficients):
                if K > 0.0:
                    total[side] += K * sum(float(state.work.sum()) for state in sliding)
        return total
