"""Choice of the surface of a contact that carries the pressure.

Nitsche's method takes the traction from one body, and with it the stabiliser γ, which is of the order of E/h of that
body. If that body is much the stiffer one, γ is large against the stiffness of the contact. Rounding errors of the
jump, multiplied by γ, then hide the equilibrium: from a ratio of the moduli of about 1e4 on no residual of 1e-10 can be
reached, and at much smaller ratios the pressure oscillates at the corners of a stiff punch. With the traction of the
softer body the ratio has no influence. So the surface that the user names first carries the pressure up to
STIFFNESS_RATIO, and beyond it that of the softer body.
"""

from __future__ import annotations

from collections.abc import Sequence

from evolvent.contact.problem.definition import Contact, Side
from evolvent.fem.body import Body

STIFFNESS_RATIO = 10.0
"""Ratio of the plane moduli beyond which the softer body carries the pressure, whichever is named first."""


def pressure_sides(bodies: Sequence[Body], contact: Contact) -> tuple[Side, Side]:
    """The side of a contact that carries the pressure, and the other one."""
    first, second = (bodies[body].material.plane_modulus for body, _ in (contact.first, contact.second))
    return (contact.second, contact.first) if first > STIFFNESS_RATIO * second else (contact.first, contact.second)
