"""Run time against error of the gear pair's pitch: order 1 and 2, hexahedra and tetrahedra, one and two ranks."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evidence.benchmark.gear_rows import pitch, pitch_cost
from evidence.benchmark.pitch import PitchFacts
from evidence.benchmark.runs import RunFailed


@dataclass(frozen=True)
class PitchRow:
    """A pitch on one mesh. one, pitch [s]: wall time of all but meshing for one position, and for the whole pitch;
    cold: one position with an empty cache of compiled forms. error: of the mean transmission error, relative, against
    the overkill pitch; reference_error: that one's own."""

    shape: str
    order: int
    ranks: int
    elements: float
    dofs: int
    positions: int
    one: float
    pitch: float
    cold: float
    memory_MB: float
    error: float
    reference_error: float
    note: str = ""


@dataclass(frozen=True)
class PitchSizes:
    """elements: across 2b, of each family; overkill: a coarser and a finer mesh of hexahedra of order 2."""

    elements: dict[int, tuple[float, ...]]
    two_ranks: tuple[float, ...]
    positions: int
    overkill: tuple[float, float]


FULL = PitchSizes({1: (0.7, 1.2, 1.9), 2: (0.5, 0.8, 1.2)}, (0.8, 1.2), 20, (1.4, 1.9))
SMALL = PitchSizes({1: (0.7,), 2: (0.5,)}, (0.5,), 4, (0.6, 0.7))


def rows(sizes: PitchSizes, folder: Path) -> Iterator[PitchRow]:
    """Every family, then the first one on two ranks. Raises RunFailed where the overkill pitch fails."""
    coarse, fine = (mean_error(pitch(folder, n, sizes.positions)) for n in sizes.overkill)
    known = fine, abs(coarse / fine - 1.0)
    for order, elements in sizes.elements.items():
        for shape in ("hexahedron", "tetrahedron"):
            for n in elements:
                yield _row(folder, sizes, shape, order, n, 1, known, cold=n == elements[0])
    for n in sizes.two_ranks:
        yield _row(folder, sizes, "hexahedron", 2, n, 2, known)


def mean_error(facts: PitchFacts) -> float:
    """Mean transmission error of the pitch [mm]."""
    return float(np.mean(facts.transmission_error))


def _row(
    folder: Path, sizes: PitchSizes, shape: str, order: int, elements: float, ranks: int, known: tuple[float, float],
    cold: bool = False,
) -> PitchRow:  # fmt: skip
    settings = f'mesh.shape="{shape}"', f"mesh.order={order}"
    nan = float("nan")
    try:
        cost, facts = pitch_cost(folder, elements, sizes.positions, *settings, ranks=ranks)
    except RunFailed as failure:
        note = str(failure).rsplit(": ", 1)[-1][:160]
        return PitchRow(shape, order, ranks, elements, 0, 0, nan, nan, nan, nan, nan, nan, note)
    first = one_position(cold_facts(folder, elements, *settings)) if cold else nan
    return PitchRow(
        shape, order, ranks, elements, facts.dofs, facts.counted, one_position(facts), facts.without_meshing, first,
        cost.memory_MB, mean_error(facts) / known[0] - 1.0, known[1],
    )  # fmt: skip


def one_position(facts: PitchFacts) -> float:
    """What a run of a single position takes, all but meshing [s]."""
    return facts.start + facts.assemble + facts.condense + facts.positions[0]


def cold_facts(folder: Path, elements: float, *settings: str) -> PitchFacts:
    """Two positions with an empty cache of compiled forms. Raises RunFailed."""
    empty = folder / "cold"
    shutil.rmtree(empty, ignore_errors=True)
    os.makedirs(empty)
    return pitch_cost(folder, elements, 2, *settings, cache_folder=empty)[1]
