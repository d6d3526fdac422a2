"""A claim: a figure that was measured, what it is held against, and how far off it may be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from math import isfinite

from matplotlib.figure import Figure


class Reference(Enum):
    """What a claim is held against. Only a regression proves nothing but that nothing changed."""

    ANALYTICAL = "analytical"
    EXTERNAL = "external"
    OVERKILL = "overkill"
    REGRESSION = "regression"


@dataclass(frozen=True)
class Claim:
    """`found` lies within `tolerance` (absolute) of `wanted`.

    quantity: what it is, with its unit. source: the formula, publication or mesh that `wanted` comes from.
    missed: why a bar is known to be missed. Such a claim must fail: that it holds one day shall be noticed.
    one_sided: more than `wanted` is no error.
    """

    quantity: str
    found: float
    wanted: float
    tolerance: float
    reference: Reference
    source: str
    missed: str = ""
    one_sided: bool = False

    @staticmethod
    def relative(
        quantity: str,
        found: float,
        wanted: float,
        tolerance: float,
        reference: Reference,
        source: str,
        missed: str = "",
    ) -> Claim:
        """The tolerance is a share of `wanted`."""
        return Claim(quantity, found, wanted, tolerance * abs(wanted), reference, source, missed)

    @staticmethod
    def bound(
        quantity: str, error: float, largest: float, reference: Reference, source: str, missed: str = ""
    ) -> Claim:
        """An error (a norm, not negative) is at most `largest`."""
        return Claim(quantity, error, 0.0, largest, reference, source, missed)

    @staticmethod
    def at_least(
        quantity: str, found: float, least: float, tolerance: float, reference: Reference, source: str, missed: str = ""
    ) -> Claim:
        """`found` is above `least`, or below it by no more than `tolerance`."""
        return Claim(quantity, found, least, tolerance, reference, source, missed, one_sided=True)

    @property
    def error(self) -> float:
        """|found − wanted|; 0 where more than `wanted` is no error."""
        return 0.0 if self.one_sided and self.found >= self.wanted else abs(self.found - self.wanted)

    @property
    def holds(self) -> bool:
        """False for a found number that is not one."""
        return self.error <= self.tolerance

    @property
    def as_expected(self) -> bool:
        """It holds, or it is known to be missed and is a finite number that is off."""
        return isfinite(self.found) and self.holds != bool(self.missed)

    @property
    def verdict(self) -> str:
        """holds, FAILS, missed (as known), or HOLDS NOW, where a miss was known."""
        if self.missed and isfinite(self.found):
            return "HOLDS NOW" if self.holds else "missed"
        return "holds" if self.holds else "FAILS"

    def __str__(self) -> str:
        reason = f" ({self.missed})" if self.missed else ""
        least = "at least " if self.one_sided else ""
        return (
            f"{self.quantity}: found {self.found:.6g}, wanted {least}{self.wanted:.6g} ± {self.tolerance:.3g} "
            f"({self.reference.value}: {self.source}), error {self.error:.3g}: {self.verdict}{reason}"
        )


@dataclass(frozen=True)
class Rung:
    """A verification problem solved. name: of its picture's file. problem: what is solved, and its known answer, in a
    paragraph. draw: its figure, found against exact. see: the line below the figure's title that says what to see."""

    name: str
    title: str
    problem: str
    claims: tuple[Claim, ...]
    draw: Callable[[Figure], None]
    see: str = ""
