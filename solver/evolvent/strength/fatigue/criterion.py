"""Fatigue criteria by name, the places at which they are evaluated, and the slopes of their S-N lines."""

from __future__ import annotations

from dataclasses import dataclass

SURFACE, BELOW = "surface", "below"
"""Names of places: depth 0, and the largest value from `DEEP` down."""
SHALLOW = {f"{depth:g} half-widths": depth for depth in (0.02, 0.05, 0.1)}
"""Name -> depth over the half-width of the contact. Stress by friction falls steeply there and that by pressure rises:
the largest value over a range of depths would be that at one of its ends."""
DEEP = 0.2
"""Depth at which `BELOW` begins, in half-widths of the contact."""
NEAR_SURFACE = SURFACE, *SHALLOW
EVERYWHERE = *NEAR_SURFACE, BELOW


@dataclass(frozen=True)
class Criterion:
    """A measure of what fatigues a material point. Lives follow N ∝ value^−m."""

    name: str
    """Name in tables."""
    words: str
    """Name in pictures and on pages."""
    unit: str = "MPa"
    """Unit of the values; empty for a strain."""
    places: tuple[str, ...] = EVERYWHERE
    """Places at which the criterion is of interest."""
    exponent: float | None = None
    """Exponent m of the criterion's own S-N line; None without a source."""
    source: str = ""
    """Source of the exponent."""
    exponent_place: str = ""
    """Place of the values that the source speaks of."""
    without_life: tuple[str, ...] = ()
    """Places at which it is a multiple of μ p0: a life by it would be one by the friction coefficient alone."""
    pressure_power: float = 1.0
    """Largest power with which the criterion grows with the contact pressure."""
    of_history: bool = True
    """Whether the criterion is one of the stress while the contact passes."""

    def slopes_at(self, place: str) -> tuple[tuple[float, str], ...]:
        """Exponent m and its source, where there is a source for values at this place."""
        return ((self.exponent, self.source),) if self.exponent is not None and place == self.exponent_place else ()


CONTACT_PRESSURE = Criterion(
    "contact_pressure", "contact pressure", places=(SURFACE,), exponent=13.22, exponent_place=SURFACE,
    source="ISO 6336-2, Z_NT of through-hardened and case-hardened steel without any pitting, 1.6 at 1e5 and 1.0 at "
    "5e7 load cycles; on nominal stress with load factors", of_history=False,
)
ORTHOGONAL_SHEAR = Criterion(
    "orthogonal_shear_range", "range of orthogonal shear stress", exponent=9.19, exponent_place=BELOW,
    without_life=(SURFACE,),
    source="Lundberg and Palmgren, line contact: c/e with c = 31/3, e = 9/8, at equal depth and stressed volume",
)
MAXIMUM_SHEAR = Criterion("maximum_shear", "maximum shear stress (Tresca)")
VON_MISES = Criterion("von_mises", "von Mises")
DANG_VAN = Criterion("dang_van", "Dang Van")
TENSION = Criterion("tension", "tensile stress along the flank", places=NEAR_SURFACE, without_life=(SURFACE,))
FATEMI_SOCIE = Criterion("fatemi_socie", "Fatemi-Socie", unit="", pressure_power=2.0)


def criteria_of(yield_stress: float | None) -> list[Criterion]:
    """Criteria that are computed. yield_stress: σ_y of the material [MPa], None where it is not known."""
    always = [CONTACT_PRESSURE, ORTHOGONAL_SHEAR, MAXIMUM_SHEAR, VON_MISES, DANG_VAN, TENSION]
    return always if yield_stress is None else [*always, FATEMI_SOCIE]
