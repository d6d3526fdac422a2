"""A transient followed until it repeats with the mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.transient.divided_steps import StepsTaken
from evolvent.dynamics.transient.pair_state import PairState
from evolvent.dynamics.transient.pair_transient import PairMoment, PairTransient
from evolvent.dynamics.transient.step_balance import NOTHING_KNOWN, Residuals, StepEnergies
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class MeshPeriods:
    """Last mesh period of a transient, and how the transient became steady."""

    moments: tuple[PairMoment, ...]
    """Results at the positions of the last mesh period, at ascending rotations of the pinion from 0 on."""
    errors: Floats
    """Transmission error [mm] at all positions since the start."""
    changes: Floats
    """Largest change of the transmission error from each mesh period to the next, over its peak-to-peak value."""
    wanted: float
    """Largest value of `changes` at which the motion counts as steady."""
    residuals: Residuals
    """Largest residuals of the balances of all time steps."""
    lowest_error: float
    """Lowest transmission error at the ends of all time steps [mm]."""
    beginning: tuple[PairMoment, ...] = ()
    """Results at the positions of the first mesh periods, where they are asked for."""

    @property
    def periods(self) -> int:
        """Number of computed mesh periods."""
        return len(self.errors) // len(self.moments)

    @property
    def is_steady(self) -> bool:
        """Whether the last mesh period repeats the one before."""
        return len(self.changes) > 0 and bool(self.changes[-1] <= self.wanted)

    @property
    def mean_force(self) -> float:
        """Mean mesh force of the last period [N; N/mm in 2D]: in a steady state the load's, as no momentum is left. The
        mean of its positions where these are all time steps, else the impulse over the time."""
        if self.steps.accepted == len(self.moments):
            return float(np.mean([moment.mesh_force for moment in self.moments]))
        way = self.moments[-1].time - self.moments[-2].time
        return self.steps.impulse / (len(self.moments) * way)

    @property
    def steps(self) -> StepsTaken:
        """Time steps of the last period."""
        return StepsTaken.joined(moment.steps for moment in self.moments)

    @property
    def energies(self) -> StepEnergies:
        """Energies of the last mesh period."""
        return StepEnergies.summed(moment.energies for moment in self.moments)


def until_steady(
    transient: PairTransient, start: PairState, most: int, wanted: float, first: int = 0,
    computed: Callable[[], None] = lambda: None,
) -> MeshPeriods:
    """Mesh periods until the transmission error changes by at most `wanted` of its peak-to-peak value from one to the
    next, `most` at most. first: so many mesh periods are reported with all their positions. computed: called after each
    mesh period. Raises NotConverged, SearchError, Unbalanced."""
    count, errors, changes = transient.contacts.positions, [], []
    moments: list[PairMoment] = []
    beginning: list[PairMoment] = []
    residuals, lowest = NOTHING_KNOWN, np.inf
    for moment in transient.run(start, most):
        moments.append(moment)
        residuals, lowest = residuals.larger(moment.residuals), min(lowest, moment.steps.lowest_error)
        errors.append(moment.result.transmission_error)
        if len(errors) <= first * count:
            beginning.append(moment)
        if len(moments) < count:
            continue
        last, before = np.array(errors[-count:]), np.array(errors[-2 * count : -count])
        period = [moments[-1], *moments[:-1]]  # the last one stands at rotation 0 again
        moments = []
        computed()
        if len(before):
            changes.append(float(np.abs(last - before).max() / max(np.ptp(last), 1e-300)))
            if changes[-1] <= wanted:
                break
    return MeshPeriods(
        tuple(period), np.array(errors), np.array(changes), wanted, residuals, lowest, tuple(beginning)
    )
