"""Facts on the contact solution on which the figures of contact fatigue rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.results.tables.table import Table
from evolvent.strength.fatigue.criterion import VON_MISES
from evolvent.strength.fatigue.fitted_tractions import shear_differences
from evolvent.strength.fatigue.flank_fatigue import FatigueMaterial
from evolvent.strength.fatigue.flank_loads import LoadedPosition
from evolvent.strength.results.friction_fatigue import FrictionFatigue
from evolvent.strength.results.friction_reversal import near_reversal
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

Materials = tuple[FatigueMaterial, FatigueMaterial]


@dataclass(frozen=True)
class FatigueFacts:
    """An entry of fatigue.json: a friction coefficient."""

    friction: float
    """Friction coefficient μ."""
    points: int
    """Points of each flank at which criteria are evaluated: slices of the contact at all positions."""
    left_out_percent: float
    """Slices under load that are left out, as they lie on a tip edge or in its zone, where pressure is singular, or
    cover the start of a linear relief of a spur pair, where it depends on how sharp the kink is."""
    near_reversal_percent: float
    """Points of the pinion near which friction reverses: histories do not hold there (near_friction_reversal)."""
    largest_pressure_MPa: float
    """Largest contact pressure of all points."""
    largest_pressure_MPa_error: float
    """Error bar of a run's largest pressure; null without a coarse companion (`output.error_bars`)."""
    pressure_over_shear_yield: float | None
    """Largest contact pressure over σ_y/√3; null without fatigue.yield_stress_MPa. A line contact yields above 3.1;
    above 4.0, less with friction, it goes on yielding with each passage (Johnson, Contact Mechanics, 1985, 9.2)."""
    mises_over_yield: float | None
    """Largest von Mises stress over σ_y; null without fatigue.yield_stress_MPa."""
    fitted_shear_median_percent: float
    """Median error by half-ellipses fitted to the pressures: largest shear stress from 0.6 to 1.3 half-widths below a
    slice under the pressures and friction as solved, over that under the half-ellipse, less 1."""
    fitted_shear_most_percent: float
    """Size of the error by fitted half-ellipses that nine in ten slices do not exceed."""
    pinion_pitch_diameter_mm: float
    """Diameter of the pinion's working pitch circle, at which the flanks do not slide."""


FATIGUE_FACTS = Table("fatigue.json", FatigueFacts)

SHAKEDOWN = 4.0
"""Contact pressure over shear yield stress up to which a line contact without friction shakes down elastically."""


def fatigue_facts(
    pair: GearPair,
    found: FrictionFatigue,
    positions: Sequence[LoadedPosition],
    inner: tuple[float, float],
    materials: Materials,
) -> FatigueFacts:
    """Facts at one friction coefficient. inner: see `RunData.inner_path`; materials: of pinion and wheel."""
    loaded = sum(int((each.cut.line_load > 0.0).sum()) for each in positions)
    pinion = found.gears[Member.PINION].loads
    peaks, reverses = pinion.peak, near_reversal(pair, Member.PINION, pinion, found.friction)
    differences = 100.0 * shear_differences(positions, inner, materials[0].poissons_ratio)
    known, σy = len(differences) > 0, materials[0].yield_stress
    largest = float(peaks.max()) if known else np.nan
    mises = max(float(own.values[VON_MISES].max(initial=0.0)) for own in found.gears)
    return FatigueFacts(
        friction=found.friction, points=len(peaks),
        left_out_percent=100.0 * (1.0 - len(peaks) / loaded) if loaded else 0.0,
        near_reversal_percent=100.0 * float(reverses.mean()) if len(peaks) else 0.0, largest_pressure_MPa=largest,
        largest_pressure_MPa_error=largest * found.pressure_error,
        pressure_over_shear_yield=None if σy is None else largest * np.sqrt(3.0) / σy,
        mises_over_yield=None if σy is None else mises / σy,
        fitted_shear_median_percent=float(np.median(differences)) if known else np.nan,
        fitted_shear_most_percent=float(np.quantile(np.abs(differences), 0.9)) if known else np.nan,
        pinion_pitch_diameter_mm=float(pair.working_pitch_diameters[0]),
    )


def warnings_of(facts: FatigueFacts, found: FrictionFatigue) -> list[str]:
    """Sentences on the figures of a friction coefficient that do not hold, and why."""
    said, name = [], f"μ = {facts.friction:g}"
    loads = found.gears[0].loads
    if len(loads.peak) and found.at_zone_end(float(loads.roll_distance[np.argmax(loads.peak)])):
        said.append(
            f"{name}: contact pressure is largest where the zone of a tip edge begins, so that the largest values say "
            "neither how large they become nor where; relieve the tips (tip_relief_um), or take the medians over points"
        )
    if facts.pressure_over_shear_yield is not None and facts.pressure_over_shear_yield > SHAKEDOWN:
        said.append(
            f"{name}: the largest contact pressure is {facts.pressure_over_shear_yield:.1f} times the shear yield "
            f"stress, above the {SHAKEDOWN:g} up to which a line contact shakes down (Johnson 1985, 9.2): stress is "
            "not elastic there, and Dang Van and Fatemi-Socie do not hold"
        )
    return said
