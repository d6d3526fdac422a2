"""The criteria by name, with the slopes of their S-N lines."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Criterion:
    """A measure of what fatigues a material point. Lives follow N ∝ value^−m."""

    name: str
    """In tables."""
    words: str
    """In pictures and on pages."""
    unit: str
    """MPa, or nothing."""
    exponent: float | None = None
    """m of its own S-N line, of the largest value below the surface where it has such; None without a source."""
    source: str = ""
    """Of the exponent."""
    below: bool = True
    """Whether it is of interest below the surface."""


CONTACT_PRESSURE = Criterion(
    "contact_pressure", "contact pressure", "MPa", 13.22,
    "ISO 6336-2, pitting: life factor 1.6 up to 1e5 load cycles, 1.0 at 5e7", below=False,
)  # fmt: skip
ORTHOGONAL_SHEAR = Criterion(
    "orthogonal_shear", "range of orthogonal shear", "MPa", 9.3,
    "Lundberg and Palmgren 1947: c/e with c = 31/3, e = 10/9",
)  # fmt: skip
LARGEST_SHEAR = Criterion("largest_shear", "largest shear", "MPa")
VON_MISES = Criterion("von_mises", "von Mises", "MPa")
DANG_VAN = Criterion("dang_van", "Dang Van", "MPa")
TENSION = Criterion("tension", "tension along the flank", "MPa", below=False)
FATEMI_SOCIE = Criterion("fatemi_socie", "Fatemi-Socie", "")
