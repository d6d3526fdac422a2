"""A pitch of positions that are searched already: friction, and how the flanks slide, elastic part included."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

from mpi4py import MPI

from solver.gear_model import GearModel
from solver.gear_points import ContactPoints, contact_points
from solver.gear_position import PositionResult, SharedPosition
from solver.gear_sweep import Pitch, SweepState, SweptPosition, initial_state, sweep_pitch
from solver.parallel import together
from wear.elastic_sliding import Deflection, Grids, PitchDeflection


@dataclass(frozen=True)
class Rubbed:
    """A rank's positions that count: results, and contact points of the states without friction; their sliding with
    what deflection adds."""

    results: list[PositionResult]
    smooth: list[ContactPoints]


@dataclass(frozen=True)
class RubbingSweep:
    """At one friction coefficient; `own` angles of the pitch are this rank's of `comm`. grids: of both flanks. step:
    between positions [rad]."""

    pitch: Pitch
    friction: float
    grids: Grids
    step: float
    comm: MPI.Comm
    own: range

    def rubbed(self, model: GearModel, shared: Sequence[SharedPosition]) -> Rubbed:
        """From all positions that this rank has searched. Raises NotConverged."""
        swept = self._swept(model, shared)
        counted = [s for k, s in zip(self.own, shared) if k >= self.pitch.warm_up]
        deflections = together(self.comm, lambda: [self._deflection(model, *pair) for pair in zip(swept, counted)])
        deflected = self._exchanged(model, swept, deflections)
        return together(self.comm, partial(self._slid, model, swept, counted, deflected))

    def _swept(self, model: GearModel, shared: Sequence[SharedPosition]) -> list[SweptPosition]:
        """Those that count. With friction the ranks take turns: each goes on from the one before."""
        state = initial_state([self.friction])
        if not model.has_friction_terms(self.friction):
            return together(self.comm, partial(self._in_turn, model, shared, state))[0]
        found: list[SweptPosition] = []
        for rank in range(self.comm.size):
            own = shared if rank == self.comm.rank else ()
            mine, state = together(self.comm, partial(self._in_turn, model, own, state))
            state = self.comm.bcast(state, rank)
            found += mine
        return found

    def _in_turn(
        self, model: GearModel, shared: Sequence[SharedPosition], state: SweepState
    ) -> tuple[list[SweptPosition], SweepState]:
        found = []
        for k, common in zip(self.own, shared):
            swept = next(sweep_pitch(model, self.pitch, [self.friction], state, k, common))
            state = replace(swept.state, footprint=None)
            found += [] if swept.warm_up else [swept]
        return found, state

    def _deflection(self, model: GearModel, swept: SweptPosition, common: SharedPosition) -> Deflection:
        memory, stand = swept.state.memories[0], swept.results[0].stand
        if memory is not None:
            return Deflection.of(model.bodies, stand, memory.rows, memory.forces, self.grids)
        contact, force = common.contact, common.smooth.force
        rows, forces = (contact.rows(0)[0], contact.rows(1)[0]), (contact.pushed(0, force), contact.pushed(1, force))
        return Deflection.of(model.bodies, stand, rows, forces, self.grids)

    def _exchanged(
        self, model: GearModel, swept: Sequence[SweptPosition], deflections: Sequence[Deflection]
    ) -> PitchDeflection:
        """This rank's positions, and their neighbours on other ranks."""
        own = dict(zip(self._numbers, deflections))
        ends = {k: own[k] for k in self._numbers[:1] + self._numbers[-1:]}
        known = {k: each for part in self.comm.allgather(ends) for k, each in part.items()} | own
        stands = self.comm.allgather([position.results[0].stand for position in swept])
        worn = model.bodies[0].worn, model.bodies[1].worn
        return PitchDeflection(self.grids, self.step, tuple(each for part in stands for each in part), known, worn)

    def _slid(
        self, model: GearModel, swept: Sequence[SweptPosition], shared: Sequence[SharedPosition], pitch: PitchDeflection
    ) -> Rubbed:
        results = [position.results[0] for position in swept]
        rough = self._with_more([result.contact for result in results], pitch)
        found = [replace(result, contact=points) for result, points in zip(results, rough)]
        if not model.has_friction_terms(self.friction):
            return Rubbed(found, rough)
        return Rubbed(found, self._with_more([self._smooth_points(model, common) for common in shared], pitch))

    def _smooth_points(self, model: GearModel, shared: SharedPosition) -> ContactPoints:
        stand = shared.contact.stand.turned(model.load.on, float(shared.smooth.motion[0]))
        return contact_points(shared.contact, shared.smooth.traction, 0.0, stand.extra)

    def _with_more(self, points: Sequence[ContactPoints], pitch: PitchDeflection) -> list[ContactPoints]:
        pairs = zip(points, pitch.added(self._numbers, points))
        return [replace(own, sliding=own.sliding + more) for own, more in pairs]

    @property
    def _numbers(self) -> list[int]:
        """Of this rank's positions that count, within the pitch."""
        return [k - self.pitch.warm_up for k in self.own if k >= self.pitch.warm_up]
