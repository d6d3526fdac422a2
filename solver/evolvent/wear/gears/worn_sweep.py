"""A pitch of positions that are searched already: friction, and how the flanks slide, elastic part included."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from mpi4py import MPI

from evolvent.fem.parallel.ranks import together
from evolvent.gears.contact.contact_points import ContactPoints, contact_points
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.periodic_pitch import ROUNDS, errors_of, is_closed, never_closed
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition, initial_state, sweep_pitch
from evolvent.gears.sweep.position import PositionResult, SharedPosition
from evolvent.wear.gears.elastic_sliding import Deflection, Grids, PitchDeflection
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class Rubbed:
    """A rank's positions: results, and contact points of the states without friction; their sliding with what
    deflection adds."""

    results: list[PositionResult]
    smooth: list[ContactPoints]


@dataclass(frozen=True)
class Turn:
    """How far a sweep has come, from rank to rank. again: in a further round. errors: transmission errors (1,) so far
    [mm]. found: the positions of this turn."""

    state: SweepState
    again: bool = False
    errors: tuple[Floats, ...] = ()
    closed: bool = False
    found: Mapping[int, SweptPosition] = field(default_factory=dict)


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
        deflections = together(self.comm, lambda: [self._deflection(model, *pair) for pair in zip(swept, shared)])
        deflected = self._exchanged(model, swept, deflections)
        return together(self.comm, partial(self._slid, model, swept, shared, deflected))

    def _swept(self, model: GearModel, shared: Sequence[SharedPosition]) -> list[SweptPosition]:
        """With friction the ranks take turns: each goes on from the one before, the first one from the last, until
        nothing is left of where the sweep began (periodic_pitch.py)."""
        state = initial_state([self.friction])
        common = dict(zip(self.own, shared))
        if not model.has_friction_terms(self.friction):
            found = together(self.comm, partial(self._in_turn, model, common, Turn(state))).found
            return [found[k] for k in self.own]
        turn, mine = Turn(state), dict[int, SweptPosition]()
        for again in range(1 + ROUNDS):
            for rank in range(self.comm.size):
                own = common if rank == self.comm.rank else {}
                turn = together(self.comm, partial(self._in_turn, model, own, replace(turn, again=again > 0)))
                mine |= turn.found
                turn = self.comm.bcast(replace(turn, found={}), rank)
                if turn.closed:
                    return [mine[k] for k in self.own]
            turn = replace(turn, state=turn.state.earlier(1))
        raise never_closed(turn.errors, self.pitch)

    def _in_turn(self, model: GearModel, own: Mapping[int, SharedPosition], turn: Turn) -> Turn:
        """The turn of a rank with these positions, until the pitch closes."""
        for k, common in own.items():
            swept = next(sweep_pitch(model, self.pitch, [self.friction], turn.state, k, common))
            errors = (*turn.errors, errors_of(swept, [self.friction]))
            closed = turn.again and is_closed(errors, self.pitch)
            state = replace(swept.state, footprint=None)
            turn = Turn(state, turn.again, errors, closed, {**turn.found, k: swept})
            if closed:
                break
        return turn

    def _deflection(self, model: GearModel, swept: SweptPosition, common: SharedPosition) -> Deflection:
        memory, stand = swept.state.memories[0], swept.results[0].stand
        if memory is not None:
            return Deflection.of(model.bodies, stand, memory.rows, memory.forces, self.grids)
        contact, force = common.contact, common.smooth.force
        pinion, wheel = ((contact.rows(gear)[0], contact.pushed(gear, force)) for gear in Member)
        rows, forces = (pinion[0], wheel[0]), (pinion[1], wheel[1])
        return Deflection.of(model.bodies, stand, rows, forces, self.grids)

    def _exchanged(
        self, model: GearModel, swept: Sequence[SweptPosition], deflections: Sequence[Deflection]
    ) -> PitchDeflection:
        """This rank's positions, and their neighbours on other ranks."""
        own = dict(zip(self.own, deflections))
        ends = {k: own[k] for k in (*self.own[:1], *self.own[-1:])}
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
        pairs = zip(points, pitch.added(self.own, points))
        return [replace(own, sliding=own.sliding + more) for own, more in pairs]
