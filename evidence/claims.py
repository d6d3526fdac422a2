"""Claims: computed figures, the reference values that they are compared with, and their tolerances."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from math import isfinite

from matplotlib.figure import Figure


class Reference(Enum):
    """Kind of a reference value. A regression shows only that nothing changed."""

    ANALYTICAL = "analytical"
    EXTERNAL = "external"
    OVERKILL = "overkill"
    REGRESSION = "regression"


@dataclass(frozen=True)
class Claim:
    """A figure lies within a tolerance of a reference value."""

    quantity: str
    """Its name and unit."""
    found: float
    wanted: float
    tolerance: float
    """Absolute."""
    reference: Reference
    source: str
    """Of `wanted`: formula, publication or mesh."""
    missed: str = ""
    """Why it is known not to hold. Such a claim must fail, so that it is noticed on the day it holds."""
    one_sided: bool = False
    """More than `wanted` is no error."""

    @property
    def error(self) -> float:
        """|found − wanted|; 0 where more than `wanted` is no error."""
        return 0.0 if self.one_sided and self.found >= self.wanted else abs(self.found - self.wanted)

    @property
    def holds(self) -> bool:
        """False for NaN."""
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
class Source:
    """Where reference values come from; makes the claims against them."""

    reference: Reference
    name: str
    """Formula, publication or mesh."""

    def absolute(self, quantity: str, found: float, wanted: float, tolerance: float, missed: str = "") -> Claim:
        """With an absolute tolerance."""
        return Claim(quantity, found, wanted, tolerance, self.reference, self.name, missed)

    def relative(self, quantity: str, found: float, wanted: float, tolerance: float, missed: str = "") -> Claim:
        """With a tolerance relative to `wanted`."""
        return self.absolute(quantity, found, wanted, tolerance * abs(wanted), missed)

    def bound(self, quantity: str, error: float, largest: float, missed: str = "") -> Claim:
        """An error (a norm, not negative) is at most `largest`."""
        return self.absolute(quantity, error, 0.0, largest, missed)

    def at_least(self, quantity: str, found: float, least: float, tolerance: float) -> Claim:
        """`found` is above `least`, or below it by no more than an absolute tolerance."""
        return Claim(quantity, found, least, tolerance, self.reference, self.name, one_sided=True)


def analytical(name: str) -> Source:
    """An exact solution."""
    return Source(Reference.ANALYTICAL, name)


def external(name: str) -> Source:
    """Published by others."""
    return Source(Reference.EXTERNAL, name)


def overkill(name: str) -> Source:
    """The same problem on a much finer mesh."""
    return Source(Reference.OVERKILL, name)


def regression(name: str) -> Source:
    """Another computation of this program."""
    return Source(Reference.REGRESSION, name)


@dataclass(frozen=True)
class Verification:
    """A verification problem, solved."""

    name: str
    """Of the file of its figure."""
    title: str
    statement: str
    """What is solved, and its known solution, in a paragraph."""
    claims: tuple[Claim, ...]
    draw: Callable[[Figure], None]
    """Its figure: computed and exact solution."""
    caption: str = ""
    """The line below the figure's title that says what to see."""
