"""Points of the path of contact at which pairs of teeth begin or end to share the load, on a gear's flank."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ContactPoint:
    """A point of load."""

    name: str
    """Name as in Zhang et al. 2023 (Fig. 6), and in words."""
    below_tip: float
    """Distance from the gear's tip along the line of action, in base pitches."""
    pairs: int
    """Tooth pairs in contact where the load is largest there: on the side with fewer of them."""


def contact_points(contact_ratio: float) -> tuple[ContactPoint, ...]:
    """Points at which pairs begin or end to share the load, from the tip down.

    contact_ratio: ε_αn, from 1 to 3. Below 2 the outer and the inner point of single contact lie between the ends; from
    2 on the boundary points b, c, d, e of double contact.
    """
    ε = contact_ratio
    if ε < 2.0:
        return (
            ContactPoint("tip", 0.0, 2), ContactPoint("outer point of single contact", ε - 1.0, 1),
            ContactPoint("inner point of single contact", 1.0, 1), ContactPoint("start of contact", ε, 2),
        )
    return (
        ContactPoint("tip (a)", 0.0, 3), ContactPoint("outer point of double contact (b)", ε - 2.0, 2),
        ContactPoint("double contact (c)", 1.0, 2), ContactPoint("double contact (d)", ε - 1.0, 2),
        ContactPoint("inner point of double contact (e)", 2.0, 2), ContactPoint("start of contact (f)", ε, 3),
    )
