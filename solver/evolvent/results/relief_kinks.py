"""Pressure over the start of a linear tip relief, a kink of the flank at which it exceeds Hertz' pressure.

The whole contact line of a spur pair passes the kink at once, possibly between two positions. The largest fitted peak
(`contact_slices.fitted_peak`) during that passage is known in closed form. It occurs with the kink in the middle of the
contact: the gap is then x²/2R + α|x|, 2α the angle of the kink, as between a cylinder and a blunt wedge. Their
pressures on the same half-width a add up:

    F' = π E* a²/4R + E* α a                                    K. L. Johnson, *Contact Mechanics* (1985), 4.43 and 5.44
    M_2 = a²/4 of the first part + a²/6 of the second            from p = p0 √(1 − x²/a²) and (E* α/π) arcosh(a/|x|)

The half-ellipse with this load and second moment is κ times as high as Hertz' p0, where κ depends on
k = 4αR/πb = 2αE*/πp0 alone. The pressure itself is unbounded at an ideal kink; how far it rises depends on the radius
with which the kink is manufactured.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from evolvent.fem.material import contact_modulus
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.results.engagement import EngagementPeak
from evolvent.results.run_data import RunData
from evolvent_meshes.gears.flank import MICROMETRE
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True)
class ReliefKink:
    """Contact pressure at the start of a linear tip relief."""

    roll_distance: float
    """Roll distance ξ of the kink from the pitch point [mm]."""
    half_range: float
    """Roll distance on either side of the kink within which the contact covers it [mm]."""
    hertz: float
    """Hertz' peak pressure for the largest line load near the kink [MPa]."""
    pressure: float
    """Largest fitted peak pressure while the contact passes the kink [MPa]."""


def wedge_factor(k: float) -> float:
    """Ratio κ ≥ 1 of the fitted peak pressure, with a kink in the middle of a line contact, to Hertz' peak pressure for
    the same load. k: 2αE*/πp0."""
    a = sqrt(1.0 + 0.25 * k**2) - 0.5 * k  # half-width over Hertz': a² + ka = 1
    return 1.0 / (a * sqrt(1.0 - a * k / 3.0))


def relief_kinks(run: RunData, index: int) -> list[ReliefKink]:
    """The kinks of a spur pair between its tip-edge zones, at the friction coefficient with this index. Empty for a
    helical pair, whose contact line crosses the kink at every position."""
    if run.pair.pinion.base_helix_angle != 0.0:
        return []
    step = run.pair.pinion.base_radius * run.pitch / len(run.positions)
    modulus = contact_modulus(*run.scene.materials())
    cut = Slices.joined([each[index].cut for each in run.positions])
    kinks = []
    for ξ, angle, roll in _kinks(run.pair):
        hertz = np.where(np.abs(cut.roll_distance - ξ) <= step, cut.hertz, 0.0)
        p0 = float(hertz.max(initial=0.0))
        if run.inner_path[0] < ξ < run.inner_path[1] and p0 > 0.0:
            radius = float(cut.radius[np.argmax(hertz)])
            half_range = roll * radius * (2.0 * p0 / modulus + angle)  # Hertz' half-width, and the turn of the normal
            kinks.append(ReliefKink(ξ, half_range, p0, p0 * wedge_factor(angle * modulus / (pi * p0))))
    return kinks


def peak_over_kink(run: RunData, index: int, peak: EngagementPeak) -> ReliefKink | None:
    """The kink at which the largest pressure of an engagement lies, or may lie between two positions; None where no
    kink applies. peak: the engagement's largest pressure."""
    ξ = run.pair.pinion.base_radius * peak.angle
    relevant = [
        kink for kink in relief_kinks(run, index)
        if kink.pressure > peak.pressure or abs(ξ - kink.roll_distance) <= kink.half_range
    ]  # fmt: skip
    return max(relevant, key=lambda kink: kink.pressure, default=None)


def _kinks(pair: GearPair) -> Iterator[tuple[float, float, float]]:
    """For each linear tip relief: roll distance ξ [mm], angle of the kink 2α [rad], derivative of ξ by the flank's arc
    length."""
    for member, gear, pitch_point in zip(Member, pair.gears, pair.pitch_point_roll_lengths):
        relief = gear.modifications
        start = relief.tip_relief_start_diameter
        if start is None or relief.tip_relief_um == 0.0 or relief.tip_relief_parabolic:
            continue
        ρ = float(gear.roll_length(start))
        roll = gear.base_radius / ρ  # an involute's arc is ρ²/2r_b
        slope = MICROMETRE * relief.tip_relief_um / (float(gear.roll_length(gear.tip_form_diameter)) - ρ)
        yield member.sign * (ρ - pitch_point), slope * roll, roll
