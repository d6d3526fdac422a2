"""How often error bars contain the true error, and how far flanks with levels of their own are off."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import isnan
from typing import Any

import numpy as np

from evidence.benchmarks.accuracy.error_bars import BarRow, hit_rate
from evidence.benchmarks.accuracy.excitation_bars import ExcitationRow
from evidence.benchmarks.accuracy.two_level import AccuracyRow
from evidence.benchmarks.pages.section import PageSection, verdict
from evidence.tables import Column, Row, Table, markdown


def _times(rows: Sequence[BarRow]) -> float:
    """The median of bar over true error, where there is one."""
    return float(np.median([row.bar / row.error for row in rows if row.error > 0.0]))


def _sum(rows: Sequence[ExcitationRow], name: str) -> int:
    return sum(getattr(row, name) for row in rows)


HITS = Table(
    list[BarRow],
    (
        Column("figure", lambda rows: rows[0].figure, words=True), Column("cases", len),
        Column("inside", lambda rows: sum(row.inside for row in rows)), Column("%", hit_rate, ".0%"),
        Column("times the error, median", _times, ".1f"),
        Column("inside, decided", lambda rows: sum(row.inside for row in rows if row.decided)),
        Column("decided", lambda rows: sum(row.decided for row in rows)),
    ),
)
"""A line a figure, of all its rows."""


EXCITATION_HITS = Table(
    tuple[str, list[ExcitationRow]],
    (
        Column("", lambda group: group[0], words=True), Column("figures", lambda group: _sum(group[1], "count")),
        Column("inside", lambda group: _sum(group[1], "inside")),
        Column("%", lambda group: _sum(group[1], "inside") / _sum(group[1], "count"), ".0%"),
        Column("decided", lambda group: _sum(group[1], "decided")),
        Column("inside, decided", lambda group: _sum(group[1], "decided_inside")),
    ),
)
"""A line a group of rows, with its name."""


LEVELS = Table(
    AccuracyRow,
    (
        Column("pair", "case", words=True), Column("difference of", "what", words=True),
        Column("%", "figure", ".2%"), Column("bar, %", "bar", ".1%"),
        Column("", lambda row: "" if isnan(row.bar) else verdict(row.met), words=True),
    ),
)
"""A line a figure."""


def _hits(rows: Sequence[BarRow]) -> list[str]:
    return [HITS.markdown(_grouped(rows, lambda row: row.figure))]


def _bars_said(rows: Sequence[BarRow]) -> list[str]:
    return [
        "He's pair and a narrow helical pair at several meshes of both orders and shapes, against meshes several times "
        "finer: the error bar "
        f"holds the true error of **{sum(row.inside for row in rows)} of {len(rows)}** figures. Wanted: 90 %. "
        "Pressures are those between the tip-edge zones of the mesh that is judged. "
        "*Decided*: where the reference is good enough to tell."
    ]


def _excitation_said(rows: Sequence[ExcitationRow]) -> list[str]:
    percents = ", ".join(f"{percent:g}" for percent in sorted({row.percent for row in rows}))
    return [
        f"The same of the excitation (`evolvent excitation`), under {percents} % of the torque that the meshes are "
        "sized for, against finer meshes at four times the positions: the bars hold "
        f"**{sum(row.inside for row in rows)} of {sum(row.count for row in rows)}** figures. Wanted: 90 %. "
        "Figures of *positions* have bars of the mesh alone. The tangent stiffness of a position at which a tooth pair "
        "comes into contact, and so its smallest value, may be that before or after."
    ]


def _grouped(rows: Iterable[Row], key: Callable[[Row], str]) -> list[list[Row]]:
    """Rows with the same key together, in their order."""
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return list(groups.values())


def _excitation_hits(rows: Sequence[ExcitationRow]) -> list[str]:
    """By figure, by torque, and how errors fall with the mesh."""
    by_figure = _grouped(rows, lambda row: f"{row.pair}, {row.quantity}, {row.figure}")
    by_torque = _grouped(rows, lambda row: f"{row.pair}, {row.percent:g} %")
    by_mesh = _grouped((row for row in rows if row.figure == "positions"), lambda row: f"{row.pair}, {row.mesh}")
    return [
        EXCITATION_HITS.markdown([(f"{each[0].pair}: {_words(each[0].quantity)}, {each[0].figure}", each)
                                  for each in by_figure]),
        EXCITATION_HITS.markdown([(f"{each[0].pair}, {each[0].percent:g} % of the torque", each)
                                  for each in by_torque]),
        "The median error of a position in per cent of the mean, by mesh (order, shape, elements across the contact "
        "width) and torque; behind it what the reference itself may be off by:",
        _convergence(by_mesh),
    ]


def _words(column: str) -> str:
    """A column of excitation.csv without its unit."""
    return column.rsplit("_um", 1)[0].rsplit("_N_per", 1)[0].replace("_", " ")


def _convergence(by_mesh: Sequence[Sequence[ExcitationRow]]) -> str:
    """A line a mesh, of transmission error and tangent stiffness."""
    percents = sorted({row.percent for rows in by_mesh for row in rows})
    names = "transmission_error_um", "tangent_stiffness_N_per_um"
    head = ["pair", "mesh", *(f"{_words(name)}, {percent:g} %" for name in names for percent in percents)]
    lines = []
    for rows in by_mesh:
        found = {(row.quantity, row.percent): row for row in rows}
        cells = [found[name, percent] for name in names for percent in percents]
        shown = (f"{100 * cell.error:.2f} ({100 * cell.reference_error:.2f})" for cell in cells)
        lines.append([rows[0].pair, rows[0].mesh, *shown])
    return markdown(head, lines, range(2, len(head)))


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
    PageSection("", "excitation_bars", Table(ExcitationRow), words=_excitation_said, after=_excitation_hits),
    PageSection("The spacing of positions", "spacing", Table(BarRow), words=_spacing_said, after=_hits),
    PageSection("Flanks finer than their body", "two_level", LEVELS, words=_levels_said),
)
