"""Transient contact of a pair beside its statics, at one speed and friction coefficient."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.contact_cells import cells_across
from evolvent.gears.pressure.pitch_pressure import PitchPressure, pitch_pressures
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats

UM = 1e3


@dataclass(frozen=True, eq=False)
class TransientCase:
    """A speed and friction coefficient, with the statics of the same positions."""

    speed: MeshSpeed
    """Speed of the pinion."""
    friction: float
    """Friction coefficient μ."""
    found: MeshPeriods
    """Transient motion: its last mesh period, and what led to it."""
    static: tuple[PositionResult, ...]
    """Static results at the positions of the last mesh period."""
    load: float
    """Load along the line of action [N; N/mm in 2D]."""

    @property
    def name(self) -> str:
        """Speed and friction coefficient, as messages state them."""
        return f"{self.speed.rpm:g} r/min, μ = {self.friction:g}"

    @property
    def results(self) -> tuple[PositionResult, ...]:
        """Positions of the last mesh period."""
        return tuple(moment.result for moment in self.found.moments)

    @property
    def first_periods(self) -> list[list[PositionResult]]:
        """Positions of the first mesh periods from rest, period by period; none where it does not begin at rest."""
        results, n = [moment.result for moment in self.found.beginning], len(self.found.moments)
        return [results[k : k + n] for k in range(0, len(results), n)]


@dataclass(frozen=True, eq=False)
class CasePressures:
    """Fitted pressures of a case; NaN where nothing is known."""

    case: TransientCase
    """Speed and friction coefficient, with the motion."""
    moving: PitchPressure
    """Fitted pressures of the last mesh period, with inertia."""
    still: PitchPressure
    """Fitted pressures of the same positions without inertia."""

    def peaks(self) -> tuple[Floats, Floats]:
        """Largest pressure at each position (n,), with inertia and without [MPa]."""
        return self.moving.at_positions, self.still.at_positions


def elements_across(model: GearModel, pressures: Sequence[CasePressures]) -> float:
    """Elements across the fitted contact width, median of all slices of all cases; NaN where nothing touches."""
    pinion = model.bodies[0]
    half_widths = np.concatenate([cut.half_width for each in pressures for cut in each.moving.cuts])
    return cells_across(half_widths, pinion.z, pinion.roll_length, pinion.gear.base_radius, pinion.mesh.order)


def case_pressures(model: GearModel, cases: Sequence[TransientCase]) -> list[CasePressures]:
    """Fitted pressures of all cases, between common tip-edge zones. These are of all positions that are reported, also
    of those from rest, as tip edges bear further in under several times the load."""
    still = {case.friction: case.static for case in cases}  # the same at all speeds
    begun = [period for case in cases for period in case.first_periods]
    columns = [*(case.results for case in cases), *still.values(), *begun]
    found = pitch_pressures(model, [tuple(column[k] for column in columns) for k in range(len(columns[0]))])
    static = dict(zip(still, found[len(cases) :]))
    return [CasePressures(case, moving, static[case.friction]) for case, moving in zip(cases, found)]
