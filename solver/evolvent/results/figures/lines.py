"""Pressure along contact lines, and at points of the path of contact (ISO 21771) over the friction coefficient."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.pressure.line_peaks import between, pooled_peaks
from evolvent.results.drawing.style import FAINT, foot, friction_colours, sheet
from evolvent.results.drawing.teeth import short_name
from evolvent.results.figures.flank import FACE, envelope
from evolvent.results.run_data import RunData
from evolvent.scene.plain_text import signed
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.pair import GearPair

MOST_LINES = 4
"""Largest number of contact lines in a figure."""
PATH_POINTS = {
    "A": "start of the path of contact",
    "AC": "halfway from A to C",
    "B": "inner point of single pair contact",
    "C": "pitch point",
    "CE": "halfway from C to E",
    "D": "outer point of single pair contact",
    "E": "end of the path of contact",
}
"""Points of the path of contact in the transverse section (ISO 21771)."""
BESIDE = 0.06
"""Smallest distance of labels side by side, over the width of the axes."""
COLOURS, MARKERS = ("#3b7a57", "#2d6fb0", "#8a5a9e", "#c98a1b", "#b03a5b"), "osD^v"


@dataclass(frozen=True)
class Series:
    """Pressure at a point over the friction coefficient."""

    name: str
    """Name of the point."""
    cells: tuple[str, ...]
    """Coordinates of the point as texts of the table."""
    values: Floats
    """(frictions,) pressure at the point [MPa]."""


def has_lines(run: RunData) -> bool:
    """Whether there are contact lines to draw."""
    return bool(_teeth_at(run, shown_position(run)))


def shown_position(run: RunData) -> int:
    """Index of the position to draw, at which most slices have a fitted peak."""
    return int(np.argmax([np.isfinite(each[0].cut.peak).sum() for each in run.positions]))


def _teeth_at(run: RunData, k: int) -> list[int]:
    """Tooth pairs with fitted peaks at position k, the leading pair first."""
    teeth = {tooth.tooth for tooth in run.positions[k][0].teeth}
    return [t for t in sorted(teeth, reverse=True) if len(line_of(run.positions[k][0].cut, t)[0])][:MOST_LINES]


def line_pressure_over_z(run: RunData) -> Figure:
    """Figure of the fitted peak pressure over z along the contact lines of a position, for every μ."""
    k = shown_position(run)
    teeth, title = _teeth_at(run, k), f"Pressure along the contact lines at φ = {np.degrees(run.angles[k]):.2f}°"
    figure = sheet(title, _lines_subtitle(run, k, teeth), (11.0, 5.2))
    axes, shown = figure.subplots(1, len(teeth), sharey=True, squeeze=False)[0], set[str]()
    for ax, tooth in zip(axes, teeth):
        for solved, colour in zip(run.positions[k], friction_colours(run.frictions)):
            z, ξ, peak = line_of(solved.cut, tooth)
            ax.plot(z, peak, color=colour, linestyle=":", linewidth=1.0)
            shown_peak = np.where(between(ξ, run.inner_path), peak, np.nan)
            ax.plot(z, shown_peak, color=colour, label=f"μ = {solved.result.friction:g}")
        marks = _marks(run, k, tooth)
        shown.update(name for name, _ in marks)
        rows = label_rows([place for _, place in marks], BESIDE * len(teeth) * run.pair.face_width)
        for (name, place), row in zip(marks, rows):
            ax.axvline(place, color=FAINT, linestyle=":", linewidth=1.0)
            height = 0.97 - 0.05 * row
            ax.text(place, height, name, transform=ax.get_xaxis_transform(), ha="center", fontweight="bold")
        ax.set_title(short_name(tooth), fontsize=10)
        ax.set(xlabel=FACE, xlim=(-0.5 * run.pair.face_width, 0.5 * run.pair.face_width))
    axes[0].set_ylabel("peak pressure across the line [MPa]")
    axes[0].set_ylim(bottom=0.0)
    axes[-1].legend(title="friction coefficient", loc="lower center", ncols=2)
    legend = [_points_named(shown)] if shown else []
    foot(figure, *legend, "Dotted in the tip-edge zones; not drawn where a contact line bears on a tip edge.")
    return figure


def label_rows(places: Sequence[float], beside: float) -> list[int]:
    """Row, from 0, for the label at each place, so that no two labels of a row are nearer than `beside`."""
    rows: list[int] = []
    for k, place in enumerate(places):
        taken = {rows[j] for j in range(k) if abs(places[j] - place) < beside}
        rows.append(min(set(range(k + 1)) - taken))
    return rows


def _points_named(names: Collection[str]) -> str:
    """Footnote with the meaning of the points of the path of contact."""
    meanings = "; ".join(f"{name}: {what}" for name, what in PATH_POINTS.items() if name in names)
    return f"{meanings}; in the transverse section (ISO 21771)."


def _marks(run: RunData, k: int, tooth: int) -> list[tuple[str, float]]:
    """Names and heights z [mm] of the points on a tooth pair's contact line at position k."""
    z, ξ, _ = line_of(run.positions[k][0].cut, tooth)
    order = np.argsort(ξ)
    inside = [(name, at) for name, at in path_points(run.pair) if len(ξ) > 1 and ξ.min() < at < ξ.max()]
    return [(name, float(np.interp(at, ξ[order], z[order]))) for name, at in inside]


def path_points(pair: GearPair) -> list[tuple[str, float]]:
    """Names and roll distances [mm] of the points A to E of the path of contact in the transverse section (ISO 21771).

    A and E are its start and end, C is the pitch point. B and D are the inner and outer point of single pair contact;
    they exist only if the transverse contact ratio is above 1 and the total contact ratio below 2.
    """
    (start, end), pitch = pair.path_of_contact, pair.pinion.transverse_base_pitch
    single = [("B", end - pitch), ("D", start + pitch)] if _single_pair(pair) else []
    return sorted([("A", start), ("C", 0.0), ("E", end), *single], key=lambda point: point[1])


def _single_pair(pair: GearPair) -> bool:
    """Whether a single tooth pair is in contact during a part of the pitch."""
    return pair.transverse_contact_ratio > 1.0 and pair.total_contact_ratio < 2.0


def points_over_friction(run: RunData) -> Figure:
    """Figure of the pressure at points over μ, with a table of their changes."""
    order = np.argsort(run.frictions)
    μ = np.array(run.frictions)[order]
    series = _of_path(run, order)
    spread = {each.name: float(np.ptp(each.values)) for each in series}
    ranked = sorted(spread, key=lambda name: -spread[name])
    subtitle = "Largest change with friction: " + ", ".join(f"{n} {spread[n]:.0f} MPa" for n in ranked) + "."
    title = "Pressure at points of the path of contact over the friction coefficient, mid-face"
    figure = sheet(title, subtitle, (10.6, 6.0))
    grid = figure.add_gridspec(2, 2, width_ratios=(1.35, 1.0))
    above, below, side = (figure.add_subplot(grid[place]) for place in ((0, 0), (1, 0), (slice(None), 1)))
    for each, colour, marker in zip(series, COLOURS, MARKERS):
        above.plot(μ, each.values, color=colour, marker=marker, label=each.name)
        below.plot(μ, 100.0 * (each.values / each.values[0] - 1.0), color=colour, marker=marker)
    above.set_ylabel("pressure [MPa]")
    above.set_ylim(0.0, 1.4 * max(each.values.max() for each in series))
    above.legend(ncols=len(series), loc="upper right")
    below.axhline(0.0, color=FAINT, linewidth=1.0)
    below.set(xlabel="friction coefficient μ", ylabel=f"change from μ = {μ[0]:g} [%]")
    _table(side, series)
    foot(figure, _points_named([each.name for each in series]))
    return figure


def _points_to_follow(pair: GearPair) -> list[tuple[str, float]]:
    """Names and roll distances [mm] of the points of the path of contact; without B and D, the points halfway from the
    pitch point to its ends instead."""
    points, (start, end) = path_points(pair), pair.path_of_contact
    halfway = [] if _single_pair(pair) else [("AC", 0.5 * start), ("CE", 0.5 * end)]
    return sorted([*points, *halfway], key=lambda point: point[1])


def _of_path(run: RunData, order: Ints) -> list[Series]:
    """Pressure at those points that have one at mid-face; A and E often lie on a tip edge. order: friction
    coefficients, ascending."""
    names, ξ = zip(*_points_to_follow(run.pair))
    maps = [envelope(run, int(index), np.array(ξ)) for index in order]
    middle = int(np.argmin(np.abs(maps[0][0])))
    peaks = np.array([peak[:, middle] for _, peak in maps])
    base, pitch = run.pair.pinion.base_radius, run.pair.pitch_point_roll_lengths[0]
    return [
        Series(name, (f"{2.0 * np.hypot(base, pitch + at):.2f}", signed(at, 2)), values)
        for name, at, values in zip(names, ξ, peaks.T)
        if np.isfinite(values).all()
    ]


def has_path_points(run: RunData) -> bool:
    """Whether a point has a pressure at all friction coefficients."""
    return bool(_of_path(run, np.arange(len(run.frictions))))


def _table(axes: Axes, series: Sequence[Series]) -> None:
    """Table of the points and of the change of their pressures."""
    axes.axis("off")
    spread = [float(np.ptp(each.values)) for each in series]
    rows = [
        [each.name, *each.cells, f"{size:.1f}", f"{100.0 * size / each.values.min():.1f} %"]
        for each, size in zip(series, spread)
    ]
    columns = ["point", "d\n[mm]", "ξ\n[mm]", "max − min\n[MPa]", "of min"]
    table = axes.table(rows, colLabels=columns, loc="center", cellLoc="center", edges="horizontal")
    table.auto_set_font_size(False)
    table.set_fontsize(9)
    table.scale(1.0, 1.9)


def line_of(cut: Slices, tooth: int) -> tuple[Floats, Floats, Floats]:
    """Heights z (n,) [mm], ascending, roll distances (n,) [mm] and fitted peaks (n,) [MPa], averaged with neighbours,
    of a tooth pair's slices off the tip edges."""
    peak = pooled_peaks(cut)
    here = np.flatnonzero((cut.tooth == tooth) & np.isfinite(peak))
    here = here[np.argsort(cut.z[here])]
    return cut.z[here], cut.roll_distance[here], peak[here]


def _lines_subtitle(run: RunData, k: int, teeth: Sequence[int]) -> str:
    """Subtitle: range of the pressure along each line, and its mean change with friction."""
    lowest, highest = int(np.argmin(run.frictions)), int(np.argmax(run.frictions))
    texts = []
    for tooth in teeth:
        (z, ξ, peak), (places, _, other) = (line_of(run.positions[k][i].cut, tooth) for i in (lowest, highest))
        inside = between(ξ, run.inner_path)
        if not inside.any():
            continue
        _, first, second = np.intersect1d(np.round(z, 9), np.round(places, 9), return_indices=True)
        change = f" ({signed(100 * (other[second].mean() / peak[first].mean() - 1))} %)" if highest != lowest else ""
        texts.append(f"{short_name(tooth)}, {peak[inside].min():.0f} to {peak[inside].max():.0f} MPa{change}")
    more = f", in brackets the mean change to μ = {run.frictions[highest]:g}" if highest != lowest else ""
    return f"At μ = {run.frictions[lowest]:g}{more}: " + "; ".join(texts) + "."
