"""How the cost of a pitch grows: with positions, friction coefficients, ranks and the size of the gears."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np

from evidence.benchmark.gear_rows import pitch_cost
from evidence.benchmark.gears import FRICTION
from evidence.benchmark.runs import RunFailed
from evolvent_meshes.arrays import Floats

SEVEN, STRONGEST = "0.07,0.08,0.11,0.12,0.15,0.20,0.30", "0.30"


@dataclass(frozen=True)
class SizeRow:
    """Both gears' sectors, one friction coefficient: condense [s] once, seconds and Newton iterations of one more
    position, memory of the run."""

    elements: float
    dofs: int
    assemble: float
    condense: float
    position: float
    iterations: float
    memory_MB: float
    note: str = ""


@dataclass(frozen=True)
class RatioRow:
    """One bar: a ratio of seconds measured side by side. above, below: what was divided [s]."""

    what: str
    dofs: int
    above: float
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
    """What is run: elements across 2b of the sizes, of the ratios, and the mesh level of the two ranks."""

    sizes: tuple[float, ...]
    ratio: float
    positions: int
    ranks_level: str
    ranks_elements: float


FULL = ScalingSizes((1.0, 1.4, 2.0, 2.6, 3.2, 3.5), 1.7, 40, "standard", 3.0)
SMALL = ScalingSizes((1.0, 1.2), 1.0, 4, "quick", 1.0)
"""The last size is the largest that 24 GB hold; where there is less, its row says that it failed."""


def size_rows(sizes: ScalingSizes, folder: Path) -> Iterator[SizeRow]:
    """Up to the first size that fails, which says why."""
    for elements in sizes.sizes:
        try:
            _, facts = pitch_cost(folder, elements, 2)
        except RunFailed as failure:
            nothing = float("nan")
            yield SizeRow(elements, 0, nothing, nothing, nothing, nothing, nothing, str(failure).rsplit(": ", 1)[-1])
            return
        yield SizeRow(
            elements, facts.dofs, facts.assemble, facts.condense, median(facts.positions), median(facts.iterations),
            facts.memory_MB,
        )  # fmt: skip


def exponent(dofs: Floats, values: Floats) -> float:
    """The slope p of values ~ dofs^p, fitted in logarithms."""
    return float(np.polyfit(np.log(dofs), np.log(values), 1)[0])


def ratio_rows(sizes: ScalingSizes, folder: Path) -> Iterator[RatioRow]:
    """The bars that are ratios. Raises RunFailed."""
    _, once = pitch_cost(folder, sizes.ratio, 0)
    _, whole = pitch_cost(folder, sizes.ratio, sizes.positions)
    factoring = once.assemble + once.condense
    everything = whole.assemble + whole.condense + sum(whole.positions)
    yield RatioRow(
        f"a pitch of {sizes.positions} positions over assembling and factoring both gears",
        whole.dofs, everything, factoring, everything / factoring, 3.0, 1.5,
    )  # fmt: skip
    yield RatioRow(
        f"{sizes.positions} positions alone over assembling and factoring both gears",
        whole.dofs, sum(whole.positions), factoring, sum(whole.positions) / factoring, 3.0, 1.5,
    )  # fmt: skip
    _, seven = pitch_cost(folder, sizes.ratio, sizes.positions, frictions=SEVEN)
    all_seven = seven.assemble + seven.condense + sum(seven.positions)
    _, strong = pitch_cost(folder, sizes.ratio, sizes.positions, frictions=STRONGEST)
    slow = strong.assemble + strong.condense + sum(strong.positions)
    for name, one in ((FRICTION, everything), (STRONGEST, slow)):  # the more friction, the more is solved again
        yield RatioRow(f"seven friction coefficients over one, {name}", seven.dofs, all_seven, one, all_seven / one,
                       1.5, 1.25)  # fmt: skip
    yield _ranks(sizes, folder)


def _ranks(sizes: ScalingSizes, folder: Path) -> RatioRow:
    """Whole processes: what one rank takes over what two take. The bar is a least value."""
    seconds, dofs = {}, 0
    for ranks in (1, 2):
        cost, facts = pitch_cost(
            folder, sizes.ranks_elements, sizes.positions // 2, level=sizes.ranks_level, frictions=SEVEN, ranks=ranks
        )
        seconds[ranks], dofs = cost.wall, facts.dofs
    return RatioRow(
        f"one rank over two, {sizes.ranks_level}, seven friction coefficients", dofs, seconds[1], seconds[2],
        seconds[1] / seconds[2], 1.5, 1.8,
    )  # fmt: skip
