"""A pitch of positions that are searched already: friction, and how the flanks slide, elastic part included."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

from mpi4py import MPI

from solver.gear_model import GearModel
from solver.gear_position import PositionResult, SharedPosition
from solver.gear_sweep import Pitch, SweepState, SweptPosition, initial_state, sweep_pitch
from solver.parallel import together
from wear.elastic_sliding import Deflection, Grids, PitchDeflection

Rubbed = tuple[PositionResult, Deflection]


@dataclass(frozen=True)
class RubbingSweep:
    """At one friction coefficient; `own` angles of the pitch are this rank's. step: between positions [rad]."""

    pitch: Pitch
    friction: float
    grids: Grids
    step: float
    comm: MPI.Comm
    own: range

    def rubbed(self, model: GearModel, shared: Sequence[SharedPosition]) -> list[PositionResult]:
        """This rank's positions that count, from all that it has searched. Raises NotConverged."""
        found = self._solved(model, shared)
        everyone = tuple(each for part in self.comm.allgather([own for _, own in found]) for each in part)
        deflected = PitchDeflection(model.bodies, self.grids, self.step, everyone)
        numbers = [k - self.pitch.warm_up for k in self.own if k >= self.pitch.warm_up]
        points = [result.contact for result, _ in found]
        slid = [replace(p, sliding=p.sliding + e) for p, e in zip(points, deflected.sliding(numbers, points))]
        return [replace(result, contact=own) for (result, _), own in zip(found, slid)]

    def _solved(self, model: GearModel, shared: Sequence[SharedPosition]) -> list[Rubbed]:
        """With friction the ranks take turns: each goes on from the one before."""
        state = initial_state([self.friction])
        if not model.has_friction_terms(self.friction):
            return together(self.comm, partial(self._swept, model, shared, state))[0]
        found: list[Rubbed] = []
        for rank in range(self.comm.size):
            own = shared if rank == self.comm.rank else ()
            mine, state = together(self.comm, partial(self._swept, model, own, state))
            state = self.comm.bcast(state, rank)
            found += mine
        return found

    def _swept(
        self, model: GearModel, shared: Sequence[SharedPosition], state: SweepState
    ) -> tuple[list[Rubbed], SweepState]:
        found = []
        for k, common in zip(self.own, shared):
            swept = next(sweep_pitch(model, self.pitch, [self.friction], state, k, common))
            state = replace(swept.state, footprint=None)
            if not swept.warm_up:
                found.append((swept.results[0], self._deflection(model, swept, common)))
        return found, state

    def _deflection(self, model: GearModel, swept: SweptPosition, common: SharedPosition) -> Deflection:
        memory, stand = swept.state.memories[0], swept.results[0].stand
        if memory is not None:
            return Deflection.of(model.bodies, stand, memory.rows, memory.forces, self.grids)
        contact, force = common.contact, common.smooth.force
        rows, forces = (contact.rows(0)[0], contact.rows(1)[0]), (contact.pushed(0, force), contact.pushed(1, force))
        return Deflection.of(model.bodies, stand, rows, forces, self.grids)
