"""How often error bars of root stress contain the true error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evidence.benchmarks.accuracy.root_bars import RootBarRow
from evidence.benchmarks.pages.section import PageSection
from evidence.tables import Column, Table


def _share(rows: Sequence[RootBarRow], count: str, of: str) -> float:
    return sum(getattr(row, count) for row in rows) / sum(getattr(row, of) for row in rows)


def _error(rows: Sequence[RootBarRow]) -> float:
    """Median true error of the largest stress, over the stress."""
    return float(np.median([row.error_MPa / row.value_MPa for row in rows]))


HITS = Table(
    tuple[str, list[RootBarRow]],
    (
        Column("", lambda group: group[0], words=True), Column("largest stresses", lambda group: len(group[1])),
        Column("inside", lambda group: sum(row.inside for row in group[1])),
        Column("%", lambda group: sum(row.inside for row in group[1]) / len(group[1]), ".0%"),
        Column("inside, decided", lambda group: sum(row.inside for row in group[1] if row.decided)),
        Column("decided", lambda group: sum(row.decided for row in group[1])),
        Column("median error, %", lambda group: _error(group[1]), ".2%"),
        Column("largest error, %", lambda group: max(row.error_MPa / row.value_MPa for row in group[1]), ".2%"),
        Column("median bar, %", lambda group: np.median([row.bar_MPa / row.value_MPa for row in group[1]]), ".2%"),
        Column("rotations inside, %", lambda group: _share(group[1], "positions_inside", "positions"), ".0%"),
    ),
)
"""A line a group of rows, with its name."""


def _said(rows: Sequence[RootBarRow]) -> list[str]:
    positions = sum(row.positions for row in rows)
    held = sum(row.positions_inside for row in rows)
    return [
        "The same of root stress (`evolvent strength`), on meshes with one, two and four times the elements of a run "
        "around their fillets (the command has twice), against a mesh with four times the elements around its fillets "
        "and all cells halved, at twice the positions: the bars hold the true error of "
        f"**{sum(row.inside for row in rows)} of {len(rows)}** largest tensions and compressions, and that of "
        f"{held} of {positions} stresses above a tenth of these at single rotations. Wanted: 90 %; at level "
        "standard an error below 2 %."
    ]


def _hits(rows: Sequence[RootBarRow]) -> list[str]:
    """By pair and cells, side, and fillet."""
    names = (
        [f"{row.pair}, {', '.join(row.mesh.split(', ')[:2])}" for row in rows],
        [f"{row.side}" for row in rows],
        [f"{row.fillet} times the elements around the fillet" for row in rows],
    )
    groups = [
        (name, [row for row, its in zip(rows, own) if its == name]) for own in names for name in dict.fromkeys(own)
    ]
    return [HITS.markdown(groups)]


SECTIONS = (PageSection("", "root_bars", Table(RootBarRow), words=_said, after=_hits),)
