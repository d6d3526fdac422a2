"""Run time against error of the gear pair's pitch: order 1 and 2, hexahedra and tetrahedra, one and two ranks, flanks
in one mesh with their body and in levels of their own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from pathlib import Path

from evidence.benchmarks.gears.pitch import LEVELS, pitch_cost
from evidence.processes import RunFailed, empty_cache

ONE_MESH, IN_LEVELS = "one mesh", "levels"
Kind = tuple[str, int, int, str, float]
"""The first five fields of a PitchRow."""


@dataclass(frozen=True)
class PitchRow:
    """A pitch on one mesh."""

    shape: str
    order: int
    ranks: int
    flanks: str
    """In one mesh with their body, or in levels of their own."""
    elements: float
    """Across the contact width 2b."""
    dofs: int
    """Of one fine mesh of both sectors, also with levels."""
    positions: int
    one: float = nan
    """Wall time of all but meshing for one position [s]; `pitch` that of the whole pitch."""
    pitch: float = nan
    cold: float = nan
    """Of one position with an empty cache of compiled forms [s]."""
    memory_MB: float = nan
    error: float = nan
    """Relative, of the mean transmission error, against the overkill pitch."""
    reference_error: float = nan
    """Of that pitch."""
    note: str = ""


@dataclass(frozen=True)
class PitchSizes:
    """Elements across 2b of what is run."""

    elements: dict[int, tuple[float, ...]]
    """By order."""
    two_ranks: tuple[float, ...]
    levels: tuple[float, ...]
    """On one rank, hexahedra of order 2."""
    positions: int
    overkill: tuple[float, float]
    """A coarser and a finer mesh of hexahedra of order 2."""


FULL = PitchSizes({1: (0.7, 1.2, 1.9), 2: (0.5, 0.8, 1.2)}, (0.8, 1.2), (0.8, 1.2, 1.7), 20, (1.4, 1.9))
SMALL = PitchSizes({1: (0.7,), 2: (0.5,)}, (0.5,), (0.5,), 4, (0.6, 0.7))


def rows(sizes: PitchSizes, folder: Path) -> Iterator[PitchRow]:
    """Every family, then hexahedra of order 2 on two ranks and with levels. Raises RunFailed where the
    overkill pitch fails."""
    coarse, fine = (pitch_cost(folder, n, sizes.positions)[1].mean_error for n in sizes.overkill)
    known = fine, abs(coarse / fine - 1.0)
    for order, elements in sizes.elements.items():
        for shape in ("hexahedron", "tetrahedron"):
            for n in elements:
                yield _row(folder, sizes, (shape, order, 1, ONE_MESH, n), known, cold=n == elements[0])
    for n in sizes.two_ranks:
        yield _row(folder, sizes, ("hexahedron", 2, 2, ONE_MESH, n), known)
    for n in sizes.levels:
        yield _row(folder, sizes, ("hexahedron", 2, 1, IN_LEVELS, n), known)


def _row(
    folder: Path, sizes: PitchSizes, kind: Kind, known: tuple[float, float], cold: bool = False
) -> PitchRow:
    """known: the overkill pitch's mean transmission error and its own error."""
    shape, order, ranks, flanks, elements = kind
    settings = [f'mesh.shape="{shape}"', f"mesh.order={order}", *([LEVELS] if flanks == IN_LEVELS else [])]
    try:
        cost, facts = pitch_cost(folder, elements, sizes.positions, *settings, ranks=ranks)
    except RunFailed as failure:
        return PitchRow(*kind, 0, 0, note=failure.reason)
    first = nan
    if cold:
        first = pitch_cost(folder, elements, 2, *settings, variables=empty_cache(folder))[1].one_position
    return PitchRow(
        *kind, facts.dofs, facts.counted, facts.one_position, facts.without_meshing, first, cost.memory_MB,
        facts.mean_error / known[0] - 1.0, known[1],
    )
