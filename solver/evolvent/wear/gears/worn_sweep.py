"""The friction sweep over a pitch whose positions are already searched, and the sliding with its elastic part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from mpi4py import MPI

from evolvent.fem.parallel.ranks import together
from evolvent.gears.contact.contact_points import ContactPoints, contact_points
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.periodic_pitch import ROUNDS, is_periodic, never_periodic, transmission_errors
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import SharedPosition
from evolvent.wear.gears.elastic_sliding import Deflection, Grids, PitchDeflection
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class SweptPitch:
    """A rank's positions of the pitch; the sliding of all points includes its elastic part.

    results: the solved positions.
    smooth: contact points of the states without friction.
    """

    results: list[PositionResult]
    smooth: list[ContactPoints]


@dataclass(frozen=True)
class SweepProgress:
    """Progress of a sweep, passed from rank to rank.

    state: to continue from.
    again: whether the pitch is being repeated.
    errors: (1,) transmission errors so far [mm].
    closed: whether the friction state is periodic.
    positions: those solved by the present rank in its turn, by number; empty while it is sent between ranks.
    """

    state: SweepState
    again: bool = False
    errors: tuple[Floats, ...] = ()
    closed: bool = False
    positions: Mapping[int, SweptPosition] = field(default_factory=dict)


@dataclass(frozen=True)
class WornSweep:
    """A sweep over one pitch of worn flanks at one friction coefficient.

    pitch: all its angles, ascending.
    friction: friction coefficient.
    grids: of pinion and wheel flank.
    step: pinion rotation between positions [rad].
    comm: the ranks that share the pitch.
    numbers: numbers of this rank's positions.
    """

    pitch: Pitch
    friction: float
    grids: Grids
    step: float
    comm: MPI.Comm
    numbers: range

    def solve(self, model: GearModel, shared: Sequence[SharedPosition]) -> SweptPitch:
        """Solves the pitch from the positions that this rank has searched. All ranks call it. Raises NotConverged."""
        swept = self._swept(model, shared)
        deflections = together(self.comm, lambda: [self._deflection(model, *pair) for pair in zip(swept, shared)])
        deflected = self._exchanged(model, swept, deflections)
        return together(self.comm, partial(self._completed, model, swept, shared, deflected))

    def _swept(self, model: GearModel, shared: Sequence[SharedPosition]) -> list[SweptPosition]:
        """Positions of this rank, solved with friction. The ranks solve one after the other, as the gears pass their
        positions, each from the friction history of the one before, and repeat the pitch until the friction state is
        periodic (periodic_pitch.py)."""
        progress = SweepProgress(initial_state([self.friction]))
        by_number = dict(zip(self.numbers, shared))
        if not model.has_friction_terms(self.friction):
            swept = together(self.comm, partial(self._in_turn, model, by_number, progress)).positions
            return [swept[k] for k in self.numbers]
        mine: dict[int, SweptPosition] = {}
        for again in range(1 + ROUNDS):
            for rank in range(self.comm.size)[:: model.load.driving.sign]:
                searched = by_number if rank == self.comm.rank else {}
                before = replace(progress, again=again > 0)
                progress = together(self.comm, partial(self._in_turn, model, searched, before))
                mine |= progress.positions
                progress = self.comm.bcast(replace(progress, positions={}), rank)
                if progress.closed:
                    return [mine[k] for k in self.numbers]
            progress = replace(progress, state=progress.state.earlier(model.load.driving.sign))
        raise never_periodic(progress.errors, self.pitch)

    def _in_turn(
        self, model: GearModel, searched: Mapping[int, SharedPosition], progress: SweepProgress
    ) -> SweepProgress:
        """Solves the positions of one rank, until the friction state is periodic."""
        sense, count = model.load.driving.sign, len(self.pitch.angles)
        passed = Pitch(self.pitch.angles[::sense])
        for k, common in sorted(searched.items())[::sense]:
            number = k if sense > 0 else count - 1 - k
            swept = next(sweep_pitch(model, passed, [self.friction], progress.state, number, common))
            errors = (*progress.errors, transmission_errors(swept, [self.friction]))
            closed = progress.again and is_periodic(errors, self.pitch)
            state = replace(swept.state, patch=None)
            progress = SweepProgress(state, progress.again, errors, closed, {**progress.positions, k: swept})
            if closed:
                break
        return progress

    def _deflection(self, model: GearModel, swept: SweptPosition, common: SharedPosition) -> Deflection:
        history, stand = swept.state.histories[0], swept.results[0].stand
        if history is not None:
            return Deflection.of(model.bodies, stand, history.rows, history.forces, self.grids)
        geometry, force = common.contact.geometry, common.smooth.force
        pinion, wheel = ((geometry.rows(gear)[0], geometry.flank_forces(gear, force)) for gear in Member)
        rows, forces = (pinion[0], wheel[0]), (pinion[1], wheel[1])
        return Deflection.of(model.bodies, stand, rows, forces, self.grids)

    def _exchanged(
        self, model: GearModel, swept: Sequence[SweptPosition], deflections: Sequence[Deflection]
    ) -> PitchDeflection:
        """Deflections of this rank's positions and of their neighbours on other ranks."""
        mine = dict(zip(self.numbers, deflections))
        ends = {k: mine[k] for k in (*self.numbers[:1], *self.numbers[-1:])}
        known = {k: each for part in self.comm.allgather(ends) for k, each in part.items()} | mine
        stands = self.comm.allgather([position.results[0].stand for position in swept])
        worn = model.bodies[0].worn, model.bodies[1].worn
        return PitchDeflection(self.grids, self.step, tuple(each for part in stands for each in part), known, worn)

    def _completed(
        self, model: GearModel, swept: Sequence[SweptPosition], shared: Sequence[SharedPosition], pitch: PitchDeflection
    ) -> SweptPitch:
        """The results, with the elastic part of the sliding added at their contact points."""
        results = [position.results[0] for position in swept]
        points = self._with_elastic_sliding([result.contact for result in results], pitch)
        complete = [replace(result, contact=contact) for result, contact in zip(results, points)]
        if not model.has_friction_terms(self.friction):
            return SweptPitch(complete, points)
        smooth = [self._smooth_points(model, common) for common in shared]
        return SweptPitch(complete, self._with_elastic_sliding(smooth, pitch))

    def _smooth_points(self, model: GearModel, shared: SharedPosition) -> ContactPoints:
        stand = shared.contact.stand.turned(model.load.on, float(shared.smooth.motion[0]))
        return contact_points(shared.contact.geometry, shared.smooth.traction, 0.0, stand.beyond_nominal)

    def _with_elastic_sliding(
        self, points: Sequence[ContactPoints], pitch: PitchDeflection
    ) -> list[ContactPoints]:
        elastic = pitch.elastic_sliding(self.numbers, points)
        return [replace(each, sliding=each.sliding + more) for each, more in zip(points, elastic)]
