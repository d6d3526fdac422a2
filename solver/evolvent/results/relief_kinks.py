"""Where a linear tip relief begins: a kink of the flank, over which the pressure is higher than Hertz'.

A spur pair's contact rolls over it all at once, perhaps between two positions. The largest pressure on the way, as
`gear_results.fitted_peak` has it, is known without a position there. It is found where the kink lies in the middle: the
gap across the contact is x²/2R + α|x|, 2α the kink's angle, that of a cylinder and a blunt wedge on one another. Their
pressures on the same half-width a add up:

    F' = π E* a²/4R + E* α a                                    K. L. Johnson, *Contact Mechanics* (1985), 4.43 and 5.44
    M_2 = a²/4 of the first part + a²/6 of the second            from p = p0 √(1 − x²/a²) and (E* α/π) arcosh(a/|x|)

The half-ellipse of this load and second moment is κ times as high as Hertz' p0, which depends on k = 4αR/πb = 2αE*/πp0
alone. The pressure itself has no bound at the kink; how far it rises is a matter of how sharp that is made.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from evolvent.fem.material import contact_modulus
from evolvent.results.engagement import TurnPeak
from evolvent.results.run_data import RunData
from evolvent_meshes.gears.flank import MICROMETRE
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True)
class ReliefKink:
    """What a run's contact meets where it rolls over the start of a linear tip relief."""

    ξ: float
    """Roll distance [mm] of the kink."""
    way: float
    """Roll distance [mm] on either side of it within which the contact may lie on it."""
    hertz: float
    """Hertz' pressure [MPa] for the largest line load beside it."""
    pressure: float
    """The largest fitted pressure [MPa] on the way over it."""


def wedge_factor(k: float) -> float:
    """κ ≥ 1: the fitted peak pressure over a kink in the middle of a line contact, over Hertz'; k = 2αE*/πp0."""
    a = sqrt(1.0 + 0.25 * k**2) - 0.5 * k  # over Hertz' half-width: a² + ka = 1
    return 1.0 / (a * sqrt(1.0 - a * k / 3.0))


def relief_kinks(run: RunData, index: int) -> list[ReliefKink]:
    """Of a spur pair at friction coefficient number `index`, between the tip-edge zones; a helical line lies across the
    kink at every position."""
    if run.pair.pinion.base_helix_angle != 0.0:
        return []
    step = run.pair.pinion.base_radius * run.pitch / len(run.positions)
    modulus = contact_modulus(*run.scene.materials())
    at = np.concatenate([each[index].cut.roll_distance for each in run.positions])
    hertz = np.concatenate([each[index].cut.hertz for each in run.positions])
    found = []
    for ξ, angle, roll in _kinks(run.pair):
        beside = hertz[np.abs(at - ξ) <= step]
        p0 = float(beside.max(initial=0.0))
        if run.inner_path[0] < ξ < run.inner_path[1] and p0 > 0.0:
            radius = float(run.pair.relative_curvature_radius(ξ))
            way = roll * radius * (2.0 * p0 / modulus + angle)  # Hertz' half-width, and while the contact turns
            found.append(ReliefKink(ξ, way, p0, p0 * wedge_factor(angle * modulus / (pi * p0))))
    return found


def peak_over_kink(run: RunData, index: int, peak: TurnPeak) -> ReliefKink | None:
    """The kink at which the largest pressure of the engagement lies, or may lie between two positions; None where
    there is none."""
    ξ = run.pair.pinion.base_radius * peak.angle
    found = [kink for kink in relief_kinks(run, index) if kink.pressure > peak.pressure or abs(ξ - kink.ξ) <= kink.way]
    return max(found, key=lambda kink: kink.pressure, default=None)


def _kinks(pair: GearPair) -> Iterator[tuple[float, float, float]]:
    """Roll distance ξ [mm], angle 2α [rad] and dξ over the arc of the flank, of each linear tip relief."""
    for member, gear, pitch_point in zip(Member, pair.gears, pair.pitch_point_roll_lengths):
        relief = gear.modifications
        start = relief.tip_relief_start_diameter
        if start is None or relief.tip_relief_um == 0.0 or relief.tip_relief_parabolic:
            continue
        ρ = float(gear.roll_length(start))
        roll = gear.base_radius / ρ  # an involute's arc is ρ²/2r_b
        slope = MICROMETRE * relief.tip_relief_um / (float(gear.roll_length(gear.tip_diameter)) - ρ)
        yield member.sign * (ρ - pitch_point), slope * roll, roll
