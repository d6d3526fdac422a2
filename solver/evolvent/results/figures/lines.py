"""Pressure along contact lines, and over the friction coefficient at single points: those of the path of contact by ISO
21771, or those of a published study."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.results.contact_slices import Slices
from evolvent.results.drawing.style import FAINT, foot, friction_colours, sheet
from evolvent.results.drawing.teeth import compares_yang, short_name
from evolvent.results.figures.flank import FACE, envelope
from evolvent.results.figures.yang import Point, has_two_lines, paper_points, paper_position
from evolvent.results.line_peaks import pooled_peaks
from evolvent.results.run_data import RunData
from evolvent.scene.plain_text import signed
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

MOST_LINES = 4
PATH_POINTS = {
    "A": "start of the path of contact",
    "AC": "halfway from A to C",
    "B": "inner point of single pair contact",
    "C": "pitch point",
    "CE": "halfway from C to E",
    "D": "outer point of single pair contact",
    "E": "end of the path of contact",
}
"""In the transverse section (ISO 21771)."""
BESIDE = 0.06  # of the width of the axes, between labels that stand side by side
COLOURS, MARKERS = ("#3b7a57", "#2d6fb0", "#8a5a9e", "#c98a1b", "#b03a5b"), "osD^v"


@dataclass(frozen=True)
class Series:
    """A point's pressures (frictions,) [MPa], its row of the table by name, and how it is called."""

    name: str
    cells: tuple[str, ...]
    values: Floats


def has_lines(run: RunData) -> bool:
    """Whether there is something to draw along the lines; of a study's teeth if one is compared."""
    return has_two_lines(run) if compares_yang(run.scene) else bool(_teeth_at(run, telling_position(run)))


def telling_position(run: RunData) -> int:
    """The position to look at: the study's, or the one at which most slices of all lines have a fitted peak."""
    if compares_yang(run.scene):
        return paper_position(run)
    return int(np.argmax([np.isfinite(each[0].cut.peak).sum() for each in run.positions]))


def _teeth_at(run: RunData, k: int) -> list[int]:
    """Tooth pairs with fitted peaks at a position, the one ahead first; of Yang's study teeth 2 and 3."""
    if compares_yang(run.scene):
        return [0, -1]
    teeth = {tooth.tooth for tooth in run.positions[k][0].teeth}
    return [t for t in sorted(teeth, reverse=True) if len(line_of(run.positions[k][0].cut, t)[0])][:MOST_LINES]


def line_pressure_over_z(run: RunData) -> Figure:
    """Fitted peak pressure over z along the contact lines of a position, for every μ."""
    k = telling_position(run)
    teeth, title = _teeth_at(run, k), f"Pressure along the contact lines at φ = {np.degrees(run.angles[k]):.2f}°"
    figure = sheet(title, _see_lines(run, k, teeth), (11.0, 5.2))
    axes, shown = figure.subplots(1, len(teeth), sharey=True, squeeze=False)[0], set[str]()
    for ax, tooth in zip(axes, teeth):
        for solved, colour in zip(run.positions[k], friction_colours(run.frictions)):
            z, _, peak = line_of(solved.cut, tooth)
            ax.plot(z, peak, color=colour, label=f"μ = {solved.result.friction:g}")
        marks = _marks(run, k, tooth)
        shown.update(name for name, _ in marks)
        rows = label_rows([place for _, place in marks], BESIDE * len(teeth) * run.pair.face_width)
        for (name, place), row in zip(marks, rows):
            ax.axvline(place, color=FAINT, linestyle=":", linewidth=1.0)
            height = 0.97 - 0.05 * row
            ax.text(place, height, name, transform=ax.get_xaxis_transform(), ha="center", fontweight="bold")
        ax.set_title(short_name(run, tooth), fontsize=10)
        ax.set(xlabel=FACE, xlim=(-0.5 * run.pair.face_width, 0.5 * run.pair.face_width))
    axes[0].set_ylabel("peak pressure across the line [MPa]")
    axes[0].set_ylim(bottom=0.0)
    axes[-1].legend(title="friction coefficient", loc="lower center", ncols=2)
    said = [] if compares_yang(run.scene) or not shown else [_points_named(shown)]
    foot(figure, *said, "Nothing is drawn where a line bears on a tip edge.")
    return figure


def label_rows(places: Sequence[float], beside: float) -> list[int]:
    """The row, 0 the first, in which each place's label stands, so that no two in a row are nearer than `beside`."""
    rows: list[int] = []
    for k, place in enumerate(places):
        taken = {rows[j] for j in range(k) if abs(places[j] - place) < beside}
        rows.append(min(set(range(k + 1)) - taken))
    return rows


def _points_named(names: Collection[str]) -> str:
    """What the letters of these points mean."""
    said = "; ".join(f"{name}: {what}" for name, what in PATH_POINTS.items() if name in names)
    return f"{said}; in the transverse section (ISO 21771)."


def _marks(run: RunData, k: int, tooth: int) -> list[tuple[str, float]]:
    """(name, z [mm]) of the points on a contact line."""
    if compares_yang(run.scene):
        return [(point.name, point.z) for point in paper_points(run, k) if point.tooth == tooth]
    z, ξ, _ = line_of(run.positions[k][0].cut, tooth)
    order = np.argsort(ξ)
    inside = [(name, at) for name, at in path_points(run.pair) if len(ξ) > 1 and ξ.min() < at < ξ.max()]
    return [(name, float(np.interp(at, ξ[order], z[order]))) for name, at in inside]


def path_points(pair: GearPair) -> list[tuple[str, float]]:
    """Names and roll distances [mm] of the points A to E of the path of contact in the transverse section (ISO 21771):
    A, E its start and end; C the pitch point; B and D the inner and outer point of single pair contact, which there are
    with a transverse contact ratio above 1 and a total one below 2 only."""
    (start, end), pitch = pair.path_of_contact, pair.pinion.transverse_base_pitch
    single = [("B", end - pitch), ("D", start + pitch)] if _single_pair(pair) else []
    return sorted([("A", start), ("C", 0.0), ("E", end), *single], key=lambda point: point[1])


def _single_pair(pair: GearPair) -> bool:
    """Whether a single tooth pair bears at times."""
    return pair.transverse_contact_ratio > 1.0 and pair.total_contact_ratio < 2.0


def points_over_friction(run: RunData) -> Figure:
    """Pressure at points over μ, with the table of their changes."""
    order = np.argsort(run.frictions)
    μ = np.array(run.frictions)[order]
    heads: tuple[str, ...]
    if compares_yang(run.scene):
        k, heads = paper_position(run), ("tooth", "z\n[mm]", "ξ\n[mm]")
        series = [_of_study(run, k, point, order) for point in paper_points(run, k)]
        title = f"Pressure at the points A to D over the friction coefficient, φ = {np.degrees(run.angles[k]):.2f}°"
    else:
        series, heads = _of_path(run, order), ("d\n[mm]", "ξ\n[mm]")
        title = "Pressure at points of the path of contact over the friction coefficient, mid-face"
    spread = {each.name: float(np.ptp(each.values)) for each in series}
    ranked = sorted(spread, key=lambda name: -spread[name])
    see = "Largest change with friction: " + ", ".join(f"{n} {spread[n]:.0f} MPa" for n in ranked) + "."
    figure = sheet(title, see, (10.6, 6.0))
    grid = figure.add_gridspec(2, 2, width_ratios=(1.35, 1.0))
    above, below, side = (figure.add_subplot(grid[place]) for place in ((0, 0), (1, 0), (slice(None), 1)))
    for each, colour, marker in zip(series, COLOURS, MARKERS):
        above.plot(μ, each.values, color=colour, marker=marker, label=each.name)
        below.plot(μ, 100.0 * (each.values / each.values[0] - 1.0), color=colour, marker=marker)
    above.set_ylabel("pressure [MPa]")
    above.set_ylim(0.0, 1.4 * max(each.values.max() for each in series))
    above.legend(ncols=len(series), loc="upper right")
    below.axhline(0.0, color=FAINT, linewidth=1.0)
    below.set(xlabel="friction coefficient μ", ylabel=f"change against μ = {μ[0]:g} [%]")
    _table(side, series, heads)
    if not compares_yang(run.scene):
        foot(figure, _points_named([each.name for each in series]))
    return figure


def _of_study(run: RunData, k: int, point: Point, order: np.ndarray) -> Series:
    values = np.array([at_point(run.positions[k][i].cut, point) for i in order])
    return Series(point.name, (f"{2 - point.tooth}", signed(point.z, 2), signed(point.ξ, 2)), values)


def _points_to_follow(pair: GearPair) -> list[tuple[str, float]]:
    """The points of the path of contact; where there are no B and D, those halfway from its pitch point to its ends in
    their place."""
    points, (start, end) = path_points(pair), pair.path_of_contact
    halfway = [] if _single_pair(pair) else [("AC", 0.5 * start), ("CE", 0.5 * end)]
    return sorted([*points, *halfway], key=lambda point: point[1])


def _of_path(run: RunData, order: np.ndarray) -> list[Series]:
    """Those of the points to follow that have a pressure at mid-face: A and E often bear on a tip edge."""
    names, ξ = zip(*_points_to_follow(run.pair))
    maps = [envelope(run, int(index), np.array(ξ)) for index in order]
    middle = int(np.argmin(np.abs(maps[0][0])))
    found = np.array([peak[:, middle] for _, peak in maps])
    base, pitch = run.pair.pinion.base_radius, run.pair.pitch_point_roll_lengths[0]
    return [
        Series(name, (f"{2.0 * np.hypot(base, pitch + at):.2f}", signed(at, 2)), values)
        for name, at, values in zip(names, ξ, found.T)
        if np.isfinite(values).all()
    ]


def has_path_points(run: RunData) -> bool:
    """Whether a point has a pressure at all coefficients."""
    return compares_yang(run.scene) or bool(_of_path(run, np.arange(len(run.frictions))))


def _table(axes: Axes, series: Sequence[Series], heads: tuple[str, ...]) -> None:
    axes.axis("off")
    spread = [float(np.ptp(each.values)) for each in series]
    rows = [
        [each.name, *each.cells, f"{size:.1f}", f"{100.0 * size / each.values.min():.1f} %"]
        for each, size in zip(series, spread)
    ]
    columns = ["point", *heads, "max − min\n[MPa]", "of min"]
    table = axes.table(rows, colLabels=columns, loc="center", cellLoc="center", edges="horizontal")
    table.auto_set_font_size(False)
    table.set_fontsize(9)
    table.scale(1.0, 1.9)


def line_of(cut: Slices, tooth: int) -> tuple[Floats, Floats, Floats]:
    """(z, ξ, fitted peak pooled with its neighbours') of a tooth's slices, z ascending; tip edges left out."""
    peak = pooled_peaks(cut)
    here = np.flatnonzero((cut.tooth == tooth) & np.isfinite(peak))
    here = here[np.argsort(cut.z[here])]
    return cut.z[here], cut.roll_distance[here], peak[here]


def at_point(cut: Slices, point: Point) -> float:
    """Fitted peak pressure at a point of the contact line [MPa], linear between slices; NaN off the line."""
    z, _, peak = line_of(cut, point.tooth)
    return float(np.interp(point.z, z, peak, left=np.nan, right=np.nan)) if len(z) else float("nan")


def _see_lines(run: RunData, k: int, teeth: Sequence[int]) -> str:
    lowest, highest = int(np.argmin(run.frictions)), int(np.argmax(run.frictions))
    texts = []
    for tooth in teeth:
        (z, _, peak), (places, _, other) = (line_of(run.positions[k][i].cut, tooth) for i in (lowest, highest))
        _, mine, its = np.intersect1d(np.round(z, 9), np.round(places, 9), return_indices=True)
        change = f" ({signed(100 * (other[its].mean() / peak[mine].mean() - 1))} %)" if highest != lowest else ""
        texts.append(f"{short_name(run, tooth)}, {peak.min():.0f} to {peak.max():.0f} MPa{change}")
    more = f", in brackets the mean change to μ = {run.frictions[highest]:g}" if highest != lowest else ""
    return f"At μ = {run.frictions[lowest]:g}{more}: " + "; ".join(texts) + "."
