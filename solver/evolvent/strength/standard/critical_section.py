"""The critical section of a tooth root: where tangents at 30° to the tooth's axis touch the fillet that a rack cuts.

ISO 6336-3:2006, 6.2 (Method B); Zhang et al., Processes 2023, 11, 1807, Eqs 12-15 and 22-25, in their correct form.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq

from evolvent.strength.standard.virtual_gear import VirtualGear, virtual_gear
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.gear import GearParameters

TANGENT = math.pi / 3.0
"""Angle between the tooth's axis and the normal of the 30° tangent of an external gear [rad]."""
STEEPEST = 1.5
"""Largest auxiliary angle that is sought [rad]."""


@dataclass(frozen=True)
class Rack:
    """The rack that generates a root, in its normal section."""

    dedendum: float
    """Dedendum h_fP: depth of the cut below the rack's reference line [mm]."""
    tip_radius: float
    """Tip radius ρ_fP [mm]."""
    undercut: float = 0.0
    """Undercut s_pr that protuberance leaves beneath the flank, less the machining allowance [mm]."""


@dataclass(frozen=True)
class CriticalSection:
    """The section at the 30° tangents; it does not depend on where the load acts."""

    gear: VirtualGear
    """Virtual gear of the root."""
    chord: float
    """Thickness s_Fn of the tooth in the section [mm]."""
    radius: float
    """Radius of curvature ρ_F of the fillet at the section [mm]."""
    height: float
    """Distance of the chord from the gear's axis [mm]."""


def rack_of(gear: GearParameters) -> Rack:
    """The rack of a gear."""
    return Rack(
        gear.dedendum_coefficient * gear.normal_module, gear.rack_tip_radius, 1e-3 * gear.protuberance_um
    )


def critical_section(gear: VirtualGear, rack: Rack) -> CriticalSection:
    """Section at which 30° tangents touch the fillet. Raises InputError where the rack's tip is no fillet for them."""
    z, m, α = gear.teeth, gear.module, gear.pressure_angle
    E = (
        math.pi / 4.0 * m - rack.dedendum * math.tan(α) + rack.undercut / math.cos(α)
        - (1.0 - math.sin(α)) * rack.tip_radius / math.cos(α)
    )
    G = (rack.tip_radius - rack.dedendum) / m + gear.profile_shift
    H = 2.0 / z * (math.pi / 2.0 - E / m) - TANGENT
    θ = _auxiliary_angle(G, H, z)
    reach = G / math.cos(θ) - rack.tip_radius / m
    chord = z * math.sin(TANGENT - θ) + math.sqrt(3.0) * reach
    radius = rack.tip_radius / m + 2.0 * G**2 / (math.cos(θ) * (z * math.cos(θ) ** 2 - 2.0 * G))
    height = 0.5 * (z * math.cos(TANGENT - θ) + reach)
    if min(chord, radius) <= 0.0:
        raise InputError(
            f"root of a gear with z_n = {z:.4g}: wanted a section that 30° tangents touch, found a chord of "
            f"{chord * m:.3g} mm and a fillet radius of {radius * m:.3g} mm; correct the rack's depth or tip radius"
        )
    return CriticalSection(gear, chord * m, radius * m, height * m)


def root_section(gear: GearParameters) -> CriticalSection:
    """Critical section of a gear as its basic rack cuts it."""
    return critical_section(virtual_gear(gear), rack_of(gear))


def _auxiliary_angle(G: float, H: float, z: float) -> float:
    """Auxiliary angle θ [rad] with θ = 2G/z tan θ − H. Raises InputError where there is none."""

    def rest(θ: float) -> float:
        return θ - 2.0 * G / z * math.tan(θ) + H

    if rest(0.0) * rest(STEEPEST) > 0.0:
        raise InputError(
            f"root of a gear with z_n = {z:.4g}: wanted an auxiliary angle between 0 and {STEEPEST} rad, found none; "
            "correct the rack's depth, its tip radius or the profile shift"
        )
    return float(brentq(rest, 0.0, STEEPEST, xtol=1e-15))
