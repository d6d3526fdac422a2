"""How often error bars contain the true error, and how far flanks with levels of their own are off."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from typing import Any

import numpy as np

from evidence.benchmarks.accuracy.error_bars import BarRow, hit_rate
from evidence.benchmarks.accuracy.two_level import AccuracyRow
from evidence.benchmarks.pages.section import PageSection, verdict
from evidence.tables import Column, Table


def _times(rows: Sequence[BarRow]) -> float:
    """The median of bar over true error, where there is one."""
    return float(np.median([row.bar / row.error for row in rows if row.error > 0.0]))


HITS = Table(
    list[BarRow],
    (
        Column("figure", lambda rows: rows[0].figure, words=True), Column("cases", len),
        Column("inside", lambda rows: sum(row.inside for row in rows)), Column("%", hit_rate, ".0%"),
        Column("times the error, median", _times, ".1f"),
        Column("inside, decided", lambda rows: sum(row.inside for row in rows if row.decided)),
        Column("decided", lambda rows: sum(row.decided for row in rows)),
    ),
)  # fmt: skip
"""A line a figure, of all its rows."""


LEVELS = Table(
    AccuracyRow,
    (
        Column("pair", "case", words=True), Column("difference of", "what", words=True),
        Column("%", "figure", ".2%"), Column("bar, %", "bar", ".1%"),
        Column("", lambda row: "" if isnan(row.bar) else verdict(row.met), words=True),
    ),
)  # fmt: skip
"""A line a figure."""


def _hits(rows: Sequence[BarRow]) -> list[str]:
    groups: dict[str, list[BarRow]] = {}
    for row in rows:
        groups.setdefault(row.figure, []).append(row)
    return [HITS.markdown(groups.values())]


def _bars_said(rows: Sequence[BarRow]) -> list[str]:
    return [
        "He's pair and a narrow helical pair at several meshes of both orders and shapes, against meshes several times "
        "finer: the error bar "
        f"holds the true error of **{sum(row.inside for row in rows)} of {len(rows)}** figures. Wanted: 90 %. "
        "Pressures are those between the tip-edge zones of the mesh that is judged. "
        "*Decided*: where the reference is good enough to tell."
    ]


def _excitation_said(rows: Sequence[BarRow]) -> list[str]:
    return [
        "The same of the excitation (`evolvent excitation`), under 25, 100 and 200 % of the torque, against finer "
        "meshes at four times the positions: the bars hold "
        f"**{sum(row.inside for row in rows)} of {len(rows)}** figures. Wanted: 90 %. "
        "Without a word behind it a figure is that of a position, with the error of the mesh alone. The tangent "
        "stiffness of a position at which a tooth pair comes into contact, and so its smallest value, may be that "
        "before or after."
    ]


def _spacing_said(rows: Sequence[BarRow]) -> list[str]:
    cases = {row.case for row in rows}
    *counts, most = sorted({int(case.split()[-2]) for case in cases})
    return [
        "The part of the error bars that comes from the spacing of positions (`spacing_error` in summary.json), of "
        f"{len({case.rsplit(', ', 1)[0] for case in cases})} pairs at {', '.join(map(str, counts))} and {most} "
        "positions a pitch against many more on the same mesh, with and without friction: it holds the true error of "
        f"**{sum(row.inside for row in rows)} of {len(rows)}** figures and is {_times(rows):.1f} times as large in the "
        "median. Wanted: 90 %, and below 5 times. *Decided*: where the bar of the many positions is small enough "
        "to tell."
    ]


def _levels_said(rows: Sequence[AccuracyRow]) -> list[str]:
    barred = [row for row in rows if not isnan(row.bar)]
    return [
        "`MeshSettings(two_level=True)` against exact condensation of the very same cells, and its fitted peak "
        "pressures against Hertz' for the line load of each slice; slices between the tip-edge zones, *beside face "
        "ends* those nearer than one normal module to one. Hertz' pressure is that for the curvatures where the loaded "
        "contact lies on both flanks: teeth bend, and near the pinion's root that changes it by several per cent. "
        f"**{sum(row.met for row in barred)} of {len(barred)}** bars are met."
    ]


SECTIONS: tuple[PageSection[Any], ...] = (
    PageSection("Error bars", "bars", Table(BarRow), words=_bars_said, after=_hits),
    PageSection("", "excitation_bars", Table(BarRow), words=_excitation_said, after=_hits),
    PageSection("The spacing of positions", "spacing", Table(BarRow), words=_spacing_said, after=_hits),
    PageSection("Flanks finer than their body", "two_level", LEVELS, words=_levels_said),
)
