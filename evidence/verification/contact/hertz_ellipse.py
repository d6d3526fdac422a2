"""Hertz' elliptical contact: a barrel-shaped steel punch on a steel block."""

from __future__ import annotations

from evidence.claims import Verification, analytical
from evidence.verification.contact.quarter import Quarter
from evidence.verification.references.half_space import Ellipse
from evolvent.contact import hertz
from evolvent.fem.material import STEEL
from evolvent_meshes.shapes.ellipse import ellipse_block, ellipse_punch

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
Boussinesq's point force integrated over Hertz' pressure (tests/evidence/verification/references/test_half_space.py:
equal to Thomas & Hoersch 1930).
"""


def verify() -> Verification:
    """Solves it once."""
    axes, b = (HERTZ.major, HERTZ.minor), HERTZ.minor
    size, fine, depth = b / CELLS, 1.25 * b, 1.2 * b
    pressed = Quarter(
        ellipse_punch(axes, (A, B), SIDE, size, fine, growth=GROWTH, fine_depth=depth),
        ellipse_block(axes, SIDE, size / 1.25, fine, growth=GROWTH, fine_depth=depth),
        Ellipse(*axes, HERTZ.peak_pressure, STEEL),
        5 * b,
    ).solved()
    return Verification(
        "hertz_ellipse",
        "Hertz, elliptical contact",
        PROBLEM,
        pressed.claims(analytical("Johnson 1985, section 4.2")),
        pressed.figure("distance from the middle / that of the ellipse's edge in the same direction").draw,
        "On the ellipse's radius all points of the pressure fall on one curve, along the long axis and across it",
    )
