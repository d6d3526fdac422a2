"""How the cost of a pitch grows: with positions, friction coefficients, ranks and the size of the gears."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from pathlib import Path

import numpy as np

from evidence.benchmarks.gears.pitch import LEVELS, PitchFacts, pitch_cost
from evidence.benchmarks.gears.three_teeth import FRICTION
from evidence.processes import RunFailed
from evolvent_meshes.arrays import Floats

SEVEN, STRONGEST = "0.07,0.08,0.11,0.12,0.15,0.20,0.30", "0.30"


@dataclass(frozen=True)
class SizeRow:
    """A pitch of two positions at one friction coefficient, on one mesh of each sector or with levels on its flank."""

    elements: float
    """Across the contact width 2b."""
    dofs: int
    """Of one fine mesh of both sectors, also with levels."""
    assemble: float = nan
    """Once [s], as `condense`."""
    condense: float = nan
    position: float = nan
    """One more position [s]; `iterations` are its Newton steps."""
    iterations: float = nan
    memory_MB: float = nan
    note: str = ""


@dataclass(frozen=True)
class RatioRow:
    """A ratio of seconds measured side by side, and its bar."""

    what: str
    dofs: int
    above: float
    """What is divided [s]; `below` by what."""
    below: float
    ratio: float
    bar: float
    aim: float

    @property
    def is_least(self) -> bool:
        """Whether more is better: the aim lies beyond the bar."""
        return self.aim > self.bar

    @property
    def met(self) -> bool:
        return self.ratio >= self.bar if self.is_least else self.ratio <= self.bar


@dataclass(frozen=True)
class ScalingSizes:
    """What is run."""

    sizes: tuple[float, ...]
    """Elements across 2b; the last one is the largest that 24 GB hold, and its row says so where there is less."""
    levels: tuple[float, ...]
    """Elements across 2b of flanks with levels."""
    ratio: float
    """Elements across 2b of the ratios."""
    positions: int
    ranks_level: str
    """Mesh level of the ratio of ranks, and its elements across 2b."""
    ranks_elements: float


FULL = ScalingSizes((1.0, 1.4, 2.0, 2.6, 3.2, 3.5), (1.0, 1.7, 3.0, 4.5, 6.0), 1.7, 40, "standard", 3.0)
SMALL = ScalingSizes((1.0, 1.2), (1.0,), 1.0, 4, "quick", 1.0)


def size_rows(sizes: ScalingSizes, folder: Path) -> Iterator[SizeRow]:
    """One fine mesh of each sector, up to the first size that fails, whose row says why."""
    return _size_rows(sizes.sizes, folder)


def level_rows(sizes: ScalingSizes, folder: Path) -> Iterator[SizeRow]:
    """The same with levels."""
    return _size_rows(sizes.levels, folder, LEVELS)


def _size_rows(sizes: tuple[float, ...], folder: Path, *settings: str) -> Iterator[SizeRow]:
    for elements in sizes:
        try:
            _, facts = pitch_cost(folder, elements, 2, *settings)
        except RunFailed as failure:
            yield SizeRow(elements, 0, note=failure.reason)
            return
        last = facts.counted - 1  # the first one searches longer, those solved again start from their last solution
        yield SizeRow(
            elements, facts.dofs, facts.assemble, facts.condense, facts.positions[last], facts.iterations[last],
            facts.memory_MB,
        )


def exponent(dofs: Floats, values: Floats) -> float:
    """The slope p of values ~ dofs^p, fitted in logarithms."""
    return float(np.polyfit(np.log(dofs), np.log(values), 1)[0])


def ratio_rows(sizes: ScalingSizes, folder: Path) -> Iterator[RatioRow]:
    """The bars that are ratios. Raises RunFailed."""
    over, several = "over assembling and factoring both gears", "seven friction coefficients"
    _, once = pitch_cost(folder, sizes.ratio, 0)
    _, whole = pitch_cost(folder, sizes.ratio, sizes.positions)
    _, levels = pitch_cost(folder, sizes.ratio, sizes.positions, LEVELS)
    pitch = f"a pitch of {sizes.positions} positions"
    for what, above in ((pitch, _seconds(whole)), (f"{sizes.positions} positions alone", sum(whole.positions)),
                        (f"{pitch}, flanks in levels,", _seconds(levels))):
        yield _ratio(f"{what} {over}", whole.dofs, above, once.factoring, 3.0, 1.5)
    _, seven = pitch_cost(folder, sizes.ratio, sizes.positions, frictions=SEVEN)
    _, strong = pitch_cost(folder, sizes.ratio, sizes.positions, frictions=STRONGEST)  # where more is solved again
    for name, one in ((FRICTION, whole), (STRONGEST, strong)):
        yield _ratio(f"{several} over one, {name}", seven.dofs, _seconds(seven), _seconds(one), 1.5, 1.25)
    (alone, facts), (two, _) = (
        pitch_cost(folder, sizes.ranks_elements, sizes.positions // 2, level=sizes.ranks_level, frictions=SEVEN,
                   ranks=ranks)
        for ranks in (1, 2)
    )
    yield _ratio(f"one rank over two, {sizes.ranks_level}, {several}", facts.dofs, alone.wall, two.wall, 1.5, 1.8)


def _seconds(facts: PitchFacts) -> float:
    return facts.factoring + sum(facts.positions)


def _ratio(what: str, dofs: int, above: float, below: float, bar: float, aim: float) -> RatioRow:
    return RatioRow(what, dofs, above, below, above / below, bar, aim)
