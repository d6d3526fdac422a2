"""The section [fatigue]: criteria of contact fatigue over the flanks and the depth below them."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import BeforeValidator, Field, field_validator, model_validator

from evolvent.scene.schema.errors import InputProblem, shown, validation_error
from evolvent.scene.schema.section import SceneSection, as_tuple, key

DEPTHS = (
    "a list of 5 to 60 ascending numbers from 0 to 10, with 0, 0.02, 0.05 and 0.1 among them, the last at least 1, in "
    "half-widths of the contact"
)
NEEDED = 0.0, 0.02, 0.05, 0.1
"""Depths [half-widths] that every list holds: the tables have each criterion there."""
DEEPEST = 1.0
"""Smallest value of the last depth [half-widths]: the largest shear stress below a line contact lies above it."""
EXPONENTS = "a list of up to 12 different numbers from 1 to 100"
Depth = Annotated[float, Field(ge=0, le=10)]
Exponent = Annotated[float, Field(ge=1, le=100)]


class FatigueSection(SceneSection):
    """[fatigue]: `evolvent fatigue` reads it."""

    depths: Annotated[tuple[Depth, ...], BeforeValidator(as_tuple)] = key(
        "depths at which criteria are evaluated, over the half-width of the contact", DEPTHS,
        "begin with 0, 0.02, 0.05, 0.1", min_length=5, max_length=60,
        default=(0.0, 0.01, 0.02, 0.05, 0.1, 0.15, *(round(0.1 * k, 1) for k in range(2, 16)), 2.0, 2.5, 3.0, 4.0, 5.0),
    )
    yield_stress_MPa: float | None = key(
        "yield stress of the flanks' material, of a hardened case that of the case; without it the criterion of Fatemi "
        "and Socie is left out, and nothing is said of yielding",
        "a number from 50 to 5000", default=None, ge=50, le=5000,
    )
    tension_factor: float = key(
        "factor a on hydrostatic tension of the criterion of Dang Van: 3 τ_w/σ_w − 1.5 of the fatigue limits in fully "
        "reversed torsion and bending; 0.3 has τ_w/σ_w = 0.6",
        "a number from 0 to 2", default=0.3, ge=0, le=2,
    )
    compression_factor: float = key(
        "the same on hydrostatic compression; at 0 the locus is constant there, at τ_w; as large as tension_factor it "
        "is the straight line of Dang Van, which is not conservative below rolling contacts",
        "a number from 0 to 2", default=0.0, ge=0, le=2,
    )
    normal_factor: float = key(
        "factor k on the largest tension on the plane of the criterion of Fatemi and Socie; the default is a choice, "
        "tests of the material have its value",
        "a number from 0 to 5", needs=("yield_stress_MPa",), default=1.0, ge=0, le=5,
    )
    exponents: Annotated[tuple[Exponent, ...], BeforeValidator(as_tuple)] = key(
        "slopes m, N ∝ value^−m, for which lives are compared, beside those that a criterion has by its source: a "
        "sensitivity, as no source has S-N lines of this form for Tresca, von Mises, Dang Van or Fatemi-Socie here",
        EXPONENTS, max_length=12, default=(8.0, 10.0, 13.0),
    )

    @field_validator("exponents")
    @classmethod
    def _different(cls, exponents: tuple[float, ...]) -> tuple[float, ...]:
        if len(set(exponents)) < len(exponents):
            raise validation_error(InputProblem("", shown(exponents), EXPONENTS, "name each once"))
        return exponents

    @model_validator(mode="after")
    def _what_tables_need(self) -> Self:
        lacking = [f"{depth:g}" for depth in NEEDED if depth not in self.depths]
        hint = None
        if not all(b > a for a, b in zip(self.depths, self.depths[1:])):
            hint = "let them ascend"
        elif lacking:
            hint = f"add {', '.join(lacking)}, at which tables have each criterion"
        elif self.depths[-1] < DEEPEST:
            hint = f"go down to {DEEPEST:g} or deeper, as shear below a contact is largest at about 0.8"
        if hint is not None:
            raise validation_error(InputProblem("depths", shown(self.depths), DEPTHS, hint))
        return self
