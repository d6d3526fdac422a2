"""Hertz' point contact: a large steel ball on a steel block."""

from __future__ import annotations

from evidence.claims import Verification, analytical
from evidence.verification.contact.quarter import Quarter
from evidence.verification.references.half_space import Ellipse
from evolvent.contact import hertz
from evolvent.fem.material import STEEL
from evolvent_meshes.shapes.rings import ring_block, ring_sphere

RADIUS, CONTACT = 150.0, 1.0  # mm
CELLS, SIDE, GROWTH = 4, 60.0, 1.7
MODULUS = STEEL.plane_modulus / 2
LOAD = 4 * MODULUS * CONTACT**3 / (3 * RADIUS)  # N
PROBLEM = f"""
A steel ball of {RADIUS:g} mm radius on a steel block under {LOAD:.0f} N, a quarter of both; Hertz' radius a = b is
{CONTACT:g} mm. Second-order hexahedra in rings of a/{CELLS} on the ball, a/{1.25 * CELLS:g} on the block, of which one
ends at a; the bodies are {SIDE / CONTACT:.0f} a wide and high. p0, a and b are those of the ellipsoid that fits the
pressure over the inner 70 %. Hertz' δ is the approach of points at infinity, of which bodies of this size still lack
1 %; so the approach is taken between points 5 a below the surfaces, and held against the half-space there.
"""


def verify() -> Verification:
    """Solves it once."""
    size, fine, depth = CONTACT / CELLS, 1.25 * CONTACT, 1.2 * CONTACT
    exact = hertz.point_contact(LOAD, RADIUS, MODULUS)
    pressed = Quarter(
        ring_sphere(RADIUS, SIDE, SIDE, CONTACT, size, fine, growth=GROWTH, fine_depth=depth),
        ring_block(SIDE, SIDE, CONTACT, size / 1.25, fine, growth=GROWTH, fine_depth=depth),
        Ellipse(float(exact.radius), float(exact.radius), float(exact.peak_pressure), STEEL),
        5 * CONTACT,
        "ball",
    ).solved()
    return Verification(
        "hertz_point",
        "Hertz, point contact",
        PROBLEM,
        pressed.claims(analytical("Johnson 1985, Eqs 4.22-4.24")),
        pressed.figure("distance from the middle / a").draw,
        "The largest stress lies half a contact radius below the surface, nearer than under a line contact",
    )
