"""Hertz' elliptical contact: a barrel-shaped steel punch on a steel block."""

from __future__ import annotations

from evidence.claims import Claim, Reference, Rung
from evidence.ladder.below import shear
from evidence.ladder.half_space import Ellipse
from evidence.ladder.quarter import Pressed, Quarter
from meshes.ellipse import ellipse_block, ellipse_punch
from solver import hertz
from solver.material import STEEL

RADII, LOAD = (500.0, 125.0), 2600.0  # mm, N
CELLS, SIDE, GROWTH = 4, 60.0, 1.7
MODULUS = STEEL.plane_modulus / 2
A, B = 1 / (2 * RADII[0]), 1 / (2 * RADII[1])
HERTZ = hertz.elliptical_contact(LOAD, A, B, MODULUS)
PROBLEM = f"""
A steel punch z = A x² + B y² with radii of curvature of {RADII[0]:g} and {RADII[1]:g} mm on a steel block under
{LOAD:g} N, a quarter of both. Hertz' half-axes are a = {HERTZ.major:.4g} and b = {HERTZ.minor:.4g} mm. Second-order
hexahedra in rings that are stretched with the ellipse, b/{CELLS} on the punch and b/{1.25 * CELLS:g} on the block, of
which one ends at the ellipse. p0, a and b are those of the ellipsoid that fits the pressure over the inner 70 %. The
approach is taken between points 5 b below the surfaces, as for the ball. The stresses on the axis are those of
Boussinesq's point force integrated over Hertz' pressure; the largest shear is also that of Johnson's table.
"""


def measure() -> Rung:
    """Solves it once."""
    axes, b = (HERTZ.major, HERTZ.minor), HERTZ.minor
    size, fine, depth = b / CELLS, 1.25 * b, 1.2 * b
    pressed = Quarter(
        ellipse_punch(axes, (A, B), SIDE, size, fine, growth=GROWTH, fine_depth=depth),
        ellipse_block(axes, SIDE, size / 1.25, fine, growth=GROWTH, fine_depth=depth),
        Ellipse(*axes, HERTZ.peak_pressure, STEEL),
        5 * b,
    ).solved()
    return Rung(
        "hertz_ellipse",
        "Hertz, elliptical contact",
        PROBLEM,
        (*pressed.claims("Johnson 1985, Eqs 4.26-4.32"), *_tabulated(pressed)),
        pressed.figure("distance from the middle / that of the ellipse's edge in the same direction").draw,
        "On the ellipse's radius all points of the pressure fall on one curve, along the long axis and across it",
    )


def _tabulated(pressed: Pressed) -> tuple[Claim, ...]:
    """The block's largest shear against the printed one for b/a = 0.4."""
    value, depth = pressed.stresses[1].largest(shear, HERTZ.minor)
    source = "Johnson 1985, table 4.1, b/a = 0.4"
    shown = value / HERTZ.peak_pressure, depth / HERTZ.minor
    return (
        Claim.relative("largest shear stress of the block / p0", shown[0], 0.325, 0.01, Reference.EXTERNAL, source),
        Claim.relative("its depth / b", shown[1], 0.665, 0.02, Reference.EXTERNAL, source),
    )
