"""Moments of inertia of gear bodies, from their transverse section and density."""

from __future__ import annotations

import numpy as np
from scipy.integrate import simpson

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.gears.profile import Profile
from evolvent_meshes.input_checks import Words, refuse

POINTS = 2001
"""Of fillet and involute each: the moment of inertia is then right to 1e-9."""
TONNE_PER_MM3 = 1e-12
"""One kg/m³."""
ROUNDING = 1e-3
"""By which the meshed body may have more inertia than the drawn one."""


def polar_moment(gear: GearParameters, density: float) -> float:
    """I [t·mm²] about the axis of a gear with its bore and what lies beside its web left out; so are modifications.

    density: [kg/m³]. ∫ρr² dV = ρ b ∮ r⁴/4 dθ along the section's rim. 1 kg·m² is 1000 t·mm².
    """
    profile, t = Profile(gear), np.linspace(0.0, 1.0, POINTS)
    curves = [profile.fillet(t), profile.involute_at_roll(np.linspace(*profile.roll_lengths, POINTS))]
    if profile.edge is not None:
        curves.append(profile.edge_line(t))
    half = sum(_swept(points) for points in curves)
    root, _, tip = profile.radii
    half += root**4 * (profile.sector_angle - profile.root_angle) + tip**4 * profile.tip_angle
    whole = 2.0 * gear.z * half - 2.0 * np.pi * (gear.bore_diameter / 2.0) ** 4
    moment = gear.face_width * whole / 4.0
    if (web := gear.thin_web) is not None:
        outer, inner = (0.5 * diameter for diameter in gear.web_diameters)
        moment -= (gear.face_width - web.thickness) * np.pi * (outer**4 - inner**4) / 2.0
    return float(TONNE_PER_MM3 * density * moment)


def equivalent_mass(pair: GearPair, inertias: tuple[float, float]) -> float:
    """m_e = I_1 I_2 / (I_1 r_b2² + I_2 r_b1²) [t] of moments of inertia [t·mm²] of pinion and wheel."""
    pinion, wheel = inertias
    return pinion * wheel / (pinion * pair.wheel.base_radius**2 + wheel * pair.pinion.base_radius**2)


def refuse_less_than_the_body(member: Member, inertia: float, body: float, remedy: str) -> None:
    """Raises InputError for an inertia that is less than that of the meshed body, all of whose mass moves [t·mm²].
    remedy: the setting that has all inertia at the bore."""
    if inertia < (1.0 - ROUNDING) * body:
        refuse(
            f"dynamics.{member.label}_inertia_kg_m2",
            f"at least that of the meshed body, {1e-3 * body:.4g} kg m², which gives way with all of its mass",
            Words(f"{1e-3 * inertia:.4g} kg m²"),
            f"delete the key for the body's own, enlarge the bore, or take {remedy}",
        )  # fmt: skip


def _swept(points: Floats) -> float:
    """|∫ r⁴ dθ| along points (n, 2) of a curve."""
    radius, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    return float(-simpson(radius**4, x=angle))
