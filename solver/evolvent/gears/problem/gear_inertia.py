"""Moments of inertia of gear bodies, from their transverse section and density."""

from __future__ import annotations

import numpy as np
from scipy.integrate import simpson

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.gears.profile import Profile
from evolvent_meshes.input_checks import Words, instance, number, refuse

POINTS = 2001
"""Number of points of fillet and involute each: the moment of inertia is then right to 1e-9."""
ROUNDING = 1e-3
"""Relative difference by which a meshed body may have more inertia than the drawn one, and a given value less than
either."""


def polar_moment(gear: GearParameters, density: float) -> float:
    """I [t·mm²] about the axis of a gear with its bore and what lies beside its web left out; so are modifications.

    density: [t/mm³]; steel has 7.85e-9. ∫ρr² dV = ρ b ∮ r⁴/4 dθ along the section's rim. 1 kg·m² is 1000 t·mm².

    Raises InputError.
    """
    instance("gear", gear, GearParameters, "give pair.pinion or pair.wheel")
    check_density(density)
    moment = _disc_moment(gear, _section(gear), gear.bore_diameter)
    if (web := gear.thin_web) is not None:
        outer, inner = (0.5 * diameter for diameter in gear.web_diameters)
        moment -= (gear.face_width - web.thickness) * np.pi * (outer**4 - inner**4) / 2.0
    return float(density * moment)


def check_density(density: float) -> None:
    """Raises InputError for a density [t/mm³] that no material of gears has."""
    wanted = "a number from 1e-10 to 3e-8, in t/mm³"
    number("density", density, wanted, "steel has 7.85e-9, which is 7850 kg/m³", lambda ϱ: 1e-10 <= ϱ <= 3e-8)


def teeth_moment(gear: GearParameters, density: float) -> float:
    """Moment of inertia [t·mm²] of the teeth alone, outside the root circle. density: [t/mm³]."""
    return float(density * _disc_moment(gear, _section(gear), gear.root_diameter))


def solid_moment(gear: GearParameters, density: float) -> float:
    """Moment of inertia [t·mm²] of a solid disc of tip diameter and face width. density: [t/mm³]."""
    return float(density * gear.face_width * np.pi * gear.tip_diameter**4 / 32.0)


def _disc_moment(gear: GearParameters, section: float, bore: float) -> float:
    """Geometric moment [mm⁵] of a disc with teeth and a bore [mm]. section: ∮ r⁴ dθ of its rim [mm⁴]."""
    return float(gear.face_width * (section - 2.0 * np.pi * (bore / 2.0) ** 4) / 4.0)


def _section(gear: GearParameters) -> float:
    """Integral ∮ r⁴ dθ [mm⁴] along the rim of the transverse section."""
    profile, t = Profile(gear), np.linspace(0.0, 1.0, POINTS)
    curves = [profile.fillet(t), profile.involute_at_roll(np.linspace(*profile.roll_lengths, POINTS))]
    if profile.edge is not None:
        curves.append(profile.edge_line(t))
    half = sum(_swept(points) for points in curves)
    root, _, tip = profile.radii
    half += root**4 * (profile.sector_angle - profile.root_angle) + tip**4 * profile.tip_angle
    return float(2.0 * gear.z * half)


def equivalent_mass(pair: GearPair, inertias: tuple[float, float]) -> float:
    """Equivalent mass m_e = I_1 I_2 / (I_1 r_b2² + I_2 r_b1²) [t] along the line of action. inertias: moments of
    inertia [t·mm²] of pinion and wheel."""
    pinion, wheel = inertias
    return pinion * wheel / (pinion * pair.wheel.base_radius**2 + wheel * pair.pinion.base_radius**2)


def added_inertia(inertia: float, body: float) -> float:
    """Moment of inertia beyond that of the gear's body, in its unit; 0 within `ROUNDING` of it."""
    return inertia - body if inertia > (1.0 + ROUNDING) * body else 0.0


def refuse_light_gears(pair: GearPair, inertias: tuple[float, float], density: float, remedy: str) -> None:
    """Raises InputError where pinion or wheel has less moment of inertia [t·mm²] than its body as it is drawn.

    density: [t/mm³]. remedy: as in `refuse_less_than_the_body`.
    """
    for member, gear, inertia in zip(Member, pair.gears, inertias):
        refuse_less_than_the_body(member, inertia, polar_moment(gear, density), remedy)


def refuse_less_than_the_body(member: Member, inertia: float, body: float, remedy: str) -> None:
    """Raises InputError for an inertia that is less than that of the gear's body, all of whose mass moves [t·mm²].
    remedy: the setting that has all inertia at the bore."""
    if inertia < (1.0 - ROUNDING) * body:
        refuse(
            f"dynamics.{member.label}_inertia_kg_m2",
            f"at least that of the gear's body, {1e-3 * body:.4g} kg m², which gives way with all of its mass",
            Words(f"{1e-3 * inertia:.4g} kg m²"),
            f"delete the key for the body's own (in Python: polar_moment), enlarge the bore, or take {remedy}",
        )


def _swept(points: Floats) -> float:
    """Integral |∫ r⁴ dθ| along points (n, 2) of a curve."""
    radius, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    return float(-simpson(radius**4, x=angle))
