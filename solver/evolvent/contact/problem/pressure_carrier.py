"""Which of the two surfaces of a contact carries the pressure.

Nitsche's method takes the traction from one body, and the stabiliser γ with it: γ is some E/h of that body. Where
this is much the stiffer one, γ is large against the stiffness of the contact, and rounding of the jump, multiplied by
γ, hides the equilibrium: from a ratio of the moduli of some 1e4 on no residual of 1e-10 can be reached; and long
before, the pressure oscillates at the corners of a stiff punch. From the softer body the ratio does not count. So the
first surface, which the user names, carries the pressure up to STIFFER, and beyond that the softer one.
"""

from __future__ import annotations

from collections.abc import Sequence

from evolvent.contact.problem.definition import Contact, Side
from evolvent.fem.body import Body

STIFFER = 10.0  # ratio of the plane moduli beyond which the softer body carries the pressure, whichever is named first


def carrying(bodies: Sequence[Body], contact: Contact) -> tuple[Side, Side]:
    """The side of a contact that carries the pressure, and the other one."""
    first, second = (bodies[body].material.plane_modulus for body, _ in (contact.first, contact.second))
    return (contact.second, contact.first) if first > STIFFER * second else (contact.first, contact.second)
