"""The section [wear]: Archard's wear of the flanks."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from evolvent.scene.schema.errors import InputProblem, shown, validation_error
from evolvent.scene.schema.section import SceneSection, as_tuple, key

QUARTERS = 4
"""Default number of reports."""
SMALLEST, LARGEST = 1e-16, 1e-5
"""Limits of K/H [mm²/N]: dry mild steel has 4e-6 (evolvent.wear.pin_on_disc), lubricated gears down to 1e-12."""


def _coefficient(gear: str) -> Any:
    """Declares the key of a wear coefficient."""
    return key(
        f"Archard's K/H of the {gear}, wear coefficient over hardness; 0: it does not wear",
        f"0, or a number from {SMALLEST:g} to {LARGEST:g}, in mm²/N",
        "mind the unit: 1 m²/N is 1e6 mm²/N, 1/Pa is 1e6 mm²/N; `evolvent wear-coefficient` finds it from a test",
        default=0.0,
        ge=0,
        le=LARGEST,
    )


Cycles = Annotated[float, Field(ge=1, le=1e13)]
MOST_REPORTS = 100
SHORTEST_BLOCK = 1e-4
"""Shortest first block, over wear.cycles."""


def _points(value: Any) -> Any:
    """A list of cycles, or a single one, as a tuple."""
    return None if value is None else as_tuple(value)


class WearSection(SceneSection):
    """[wear]: Archard's wear of both flanks. Without this section nothing wears."""

    cycles: Cycles = key("revolutions of the pinion", "a number from 1 to 1e13")
    pinion_mm2_per_N: float = _coefficient("pinion")
    wheel_mm2_per_N: float = _coefficient("wheel")
    report_at_cycles: Annotated[tuple[Cycles, ...] | None, BeforeValidator(_points)] = key(
        "after which cycles the worn pair is written out, besides the last; by default at each quarter",
        f"a list of up to {MOST_REPORTS} rising numbers from 1 on and below wear.cycles",
        default=None,
        max_length=MOST_REPORTS,
    )
    tolerance: float = key(
        "largest share of a block's worn volume that may be removed in the wrong place", "a number from 0.001 to 0.5",
        default=0.05, ge=1e-3, le=0.5,
    )
    blocks: Literal["implicit", "explicit"] = key(
        "whether the contact follows the wear within a block of cycles, or only from block to block",
        '"implicit" or "explicit"', "implicit is stable for any length of block", default="implicit",
    )
    first_block_cycles: Cycles | None = key(
        "length of the first block of cycles; a hundredth of wear.cycles by default",
        f"a number from {SHORTEST_BLOCK:g} wear.cycles, 1 at least, up to wear.cycles",
        "delete the key for the default", default=None,
    )
    refresh_um: float | None = key(
        "depth of wear at which the meshes follow the worn flanks and both gears are condensed again; 5e-3 m_n by "
        "default",
        "a number from 0.001 to 1000, in µm", "delete the key for the default", default=None, ge=1e-3, le=1e3,
    )

    @model_validator(mode="after")
    def _something_wears(self) -> Self:
        for name in ("pinion_mm2_per_N", "wheel_mm2_per_N"):
            value = getattr(self, name)
            if 0.0 < value < SMALLEST:
                remedy = "mind the unit: 1 m²/N is 1e6 mm²/N, 1/Pa is 1e6 mm²/N"
                raise validation_error(InputProblem(name, shown(value), f"0, or a number from {SMALLEST:g} on", remedy))
        if self.pinion_mm2_per_N == self.wheel_mm2_per_N == 0.0:
            found, remedy = "0 on both gears", "give K/H of the pinion or of the wheel, or delete the section [wear]"
            allowed = "a K/H above 0 on one gear at least"
            raise validation_error(InputProblem("pinion_mm2_per_N", found, allowed, remedy))
        return self

    @model_validator(mode="after")
    def _reports_in_order(self) -> Self:
        points = self.report_at_cycles or ()
        if any(a >= b for a, b in zip(points, (*points[1:], self.cycles))):
            allowed = f"rising numbers from 1 on and below wear.cycles, {self.cycles:g}"
            remedy = "sort them and leave out repeated ones and the last"
            raise validation_error(InputProblem("report_at_cycles", shown(points), allowed, remedy))
        first, least = self.first_block_cycles, SHORTEST_BLOCK * self.cycles
        if first is not None and not least <= first <= self.cycles:
            allowed = f"from {least:g} to wear.cycles, {self.cycles:g}"
            remedy = "give a shorter block" if first > self.cycles else "give a longer one: there would be too many"
            raise validation_error(InputProblem("first_block_cycles", shown(first), allowed, remedy))
        return self

    @property
    def reports(self) -> tuple[float, ...]:
        """Cycles after which the worn pair is written, the last included."""
        if self.report_at_cycles is None:
            return tuple(self.cycles * k / QUARTERS for k in range(1, QUARTERS + 1))
        return (*self.report_at_cycles, self.cycles)
