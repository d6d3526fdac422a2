"""Contact stress of a tooth over its engagement and over the friction coefficient (Yang et al. 2022, Figs 8 and 9).

Where the contact is fewer than two elements wide, peaks scatter with its place in the cells. Pictures then have a note
and show computed values as points. The line is Hertz' stress for the same loads times the running median of the ratio
of computed stress to Hertz': loads are accurate, and features such as single pair contact are preserved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.results.drawing.style import AT_ZONE_END, FAINT, HOLLOW, INK, OVER_KINK, foot, friction_colours, sheet
from evolvent.results.drawing.teeth import long_name, short_name, shown_teeth
from evolvent.results.engagement import Engagement, EngagementPeak, crossing, engagement, engagements, with_hertz
from evolvent.results.mesh_facts import cells_across, few_cells_across
from evolvent.results.relief_kinks import AWAY, kink_notes, largest_kink
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import few_positions
from evolvent.scene.plain_text import signed
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member

STRESS = "maximum contact stress [MPa]"
TOOTH_ANGLE = "pinion rotation [°]   (0: tooth pair in contact at the pitch point, mid-face)"
CROSS: dict[str, Any] = {"marker": "x", "markersize": 4.0, "linestyle": ""}
"""Marker of a pressure over the start of a linear relief."""
MEDIAN = 5
"""Number of positions of the running median where the mesh does not resolve the contact."""


def engagement_stress(run: RunData) -> Figure:
    """Figure of the maximum contact stress of a tooth over its engagement for every μ, with their crossing enlarged
    (Fig. 9)."""
    curves = engagements(run)
    cross = _crossing_deg(run, curves)
    bar = run.errors.bar("max_pressure_MPa", int(np.argmin(run.frictions)))
    subtitle = _engagement_subtitle(run, curves, cross, bar)
    figure = sheet("Contact stress of a tooth over its engagement", subtitle, (10.4, 6.2))
    main, detail = figure.subplots(1, 2, width_ratios=(2.3, 1.0)) if len(curves) > 1 else (figure.subplots(), None)
    _curves(main, run, curves, [None] * len(curves))
    low, high = (signed(ξ) for ξ in run.inner_path)
    between = f"The largest stress is taken between the tip-edge zones, from ξ = {low} to {high} mm."
    foot(figure, between, *kink_notes(run, int(np.argmin(run.frictions))), *_resolved(run), *_sampled(run))
    for curve, colour in zip(curves, friction_colours(run.frictions)):
        for end in _zone_ends(curve):
            main.plot(np.degrees(end.angle), end.pressure, color=colour, **HOLLOW)
        main.plot(np.degrees(curve.angle), curve.kink_pressure, color=colour, **CROSS)
    _largest(main, _lowest(curves), bar)
    _pitches(main, run, curves[0])
    main.set(xlabel=TOOTH_ANGLE, ylabel=STRESS)
    values = np.concatenate([[*c.pressure_curve[1], *c.kink_pressure] for c in curves])
    largest = _lowest(curves).peak.pressure + np.array([-1.0, 1.0]) * bar  # NaN: no bar
    bottom, top = np.nanmin([0.6 * np.nanmin(values), largest[0]]), np.nanmax([np.nanmax(values), largest[1]])
    main.set_ylim(max(0.0, 0.92 * bottom), 1.06 * top)
    handles = [*main.get_legend_handles_labels()[0], *_keys(run, curves)]
    columns = 3 if len(handles) in (5, 6) else 4
    main.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=columns)
    if detail is not None:
        _detail(detail, run, curves, cross if np.isfinite(cross) else 0.0, 5.0)
        place = "where they cross" if np.isfinite(cross) else "at the pitch point"
        detail.set_title(f"enlarged {place}", fontsize=10)
        detail.set(xlabel="pinion rotation [°]")
    return figure


def tooth_stress(run: RunData) -> Figure:
    """Figure of the stress of each tooth over one pitch for every μ, and of its change with μ (Fig. 8)."""
    curves = engagements(run)
    subtitle = _teeth_subtitle(run, smoothed(run, curves))
    figure = sheet("Contact stress of the teeth over a pitch of pinion rotation", subtitle, (11.6, 6.6))
    teeth = shown_teeth(curves)
    grid = figure.subplots(2, len(teeth), sharex=True, height_ratios=(1.5, 1.0), squeeze=False)
    for column, tooth in enumerate(teeth):
        top, below = grid[0, column], grid[1, column]
        members = [c.tooth == tooth for c in curves]
        _curves(top, run, curves, members, tooth)
        _change(below, run, smoothed(run, curves), members, tooth)
        top.set_title(long_name(tooth), fontsize=10)
        below.set_xlabel("pinion rotation φ [°]")
    grid[0, 0].set_ylabel(STRESS)
    grid[1, 0].set_ylabel(f"change from μ = {_lowest(curves).friction:g} [%]")
    grid[0, 0].legend(loc="best")
    foot(figure, *_resolved(run))
    return figure


def _curves(
    axes: Axes, run: RunData, curves: Sequence[Engagement], members: Sequence[Bools | None], tooth: int = 0
) -> None:
    """Curves of the maximum pressure over the tooth's rotation. members: for each curve, the entries (n,) bool of tooth
    pair `tooth`, drawn over φ; None for all entries."""
    coarse, lines = few_cells_across(run), smoothed(run, curves)
    for curve, line, here, colour in zip(curves, lines, members, friction_colours(run.frictions)):
        label = f"μ = {curve.friction:g}"
        points = {"linestyle": "", "alpha": 0.45} if coarse else {"label": label}
        axes.plot(*_shown(run, curve, here, tooth), color=colour, marker=".", markersize=4.0 - (not coarse), **points)
        if coarse:
            axes.plot(*_shown(run, line, here, tooth), color=colour, label=label)


def _zone_ends(curve: Engagement) -> list[EngagementPeak]:
    """Peaks at the limits of tip-edge zones: those of a spur pair, and the largest pressure if it is one."""
    return [peak for peak in dict.fromkeys([*curve.zone_ends, curve.peak]) if peak.at_zone_end]


def _keys(run: RunData, curves: Sequence[Engagement]) -> list[Line2D]:
    """Entries of the legend for points, lines, hollow markers and crosses."""
    coarse = [
        Line2D([], [], color=FAINT, linestyle="", marker=".", markersize=6.0, label="computed"),
        Line2D([], [], color=FAINT, label="Hertz × running median"),
    ]
    hollow = [Line2D([], [], color=FAINT, label=AT_ZONE_END, **HOLLOW)]
    crosses = [Line2D([], [], color=FAINT, label=OVER_KINK, **CROSS)]
    return [
        *(coarse if few_cells_across(run) else ()),
        *(hollow if any(_zone_ends(curve) for curve in curves) else ()),
        *(crosses if any(np.isfinite(curve.kink_pressure).any() for curve in curves) else ()),
    ]


def smoothed(run: RunData, curves: Sequence[Engagement]) -> list[Engagement]:
    """The curves; where the mesh does not resolve the contact, with smoothed maximum pressures, see the module."""
    if not few_cells_across(run):
        return list(curves)
    by_hertz = with_hertz(run)
    hertz = [engagement(by_hertz, run.frictions.index(c.friction), run.inner_path).max_pressure for c in curves]
    return [replace(c, max_pressure=exact * running_median(c.max_pressure / exact)) for c, exact in zip(curves, hertz)]


def _resolved(run: RunData) -> list[str]:
    """Footnote where the mesh does not resolve the contact; none where it does."""
    if not few_cells_across(run):
        return []
    return [
        f"Only {cells_across(run):.1f} elements across the contact: points as computed; lines: Hertz for the same loads"
        f" times the running median, over {MEDIAN} positions, of computed over Hertz."
    ]


def _sampled(run: RunData) -> list[str]:
    """Footnote where positions are too few, else none."""
    sentence = few_positions(friction_rows(run)[int(np.argmin(run.frictions))])
    return [sentence] if sentence else []


def running_median(values: Floats) -> Floats:
    """Median (n,) of the `MEDIAN` values around each of the values (n,), of fewer at the ends; NaN where the value
    is."""
    known = np.flatnonzero(np.isfinite(values))
    reach, medians = MEDIAN // 2, np.full(len(values), np.nan)
    for place, index in enumerate(known):
        span = min(reach, place, len(known) - 1 - place)  # as many on either side: the values at the ends are unchanged
        medians[index] = np.median(values[known[place - span : place + span + 1]])
    return medians


def _shown(run: RunData, curve: Engagement, here: Bools | None, tooth: int) -> tuple[Floats, Floats]:
    """Rotations [°] and pressures [MPa] to draw, see `_curves`."""
    if here is None:
        angle, pressure = curve.pressure_curve
        return np.degrees(angle), pressure
    return np.degrees(curve.angle[here] - tooth * run.pitch), curve.max_pressure[here]


def _change(axes: Axes, run: RunData, curves: Sequence[Engagement], members: Sequence[Bools], tooth: int) -> None:
    """Curves of the change of the maximum pressure against the smallest μ [%]."""
    lowest = _lowest(curves)
    axes.axhline(0.0, color=FAINT, linewidth=1.0)
    for curve, colour in zip(curves, friction_colours(run.frictions)):
        angle, change = relative_change(curve, lowest, curve.tooth == tooth)
        axes.plot(np.degrees(angle - tooth * run.pitch), 100.0 * change, color=colour)


def relative_change(curve: Engagement, lowest: Engagement, here: Bools) -> tuple[Floats, Floats]:
    """Rotations (m,) [rad] and relative change (m,) of the maximum pressure against the curve `lowest` of another
    friction coefficient. here: (n,) bool, entries of the curve to compare."""
    key = np.round(curve.angle, 9)
    _, first, second = np.intersect1d(key[here], np.round(lowest.angle, 9), return_indices=True)
    entries = np.flatnonzero(here)[first]
    return curve.angle[entries], curve.max_pressure[entries] / lowest.max_pressure[second] - 1.0


def _lowest(curves: Sequence[Engagement]) -> Engagement:
    return min(curves, key=lambda c: c.friction)


def _highest(curves: Sequence[Engagement]) -> Engagement:
    return max(curves, key=lambda c: c.friction)


def _crossing_deg(run: RunData, curves: Sequence[Engagement]) -> float:
    """Rotation [°] at which the curves of least and most friction cross; NaN where they do not, or where it is unknown
    because scatter of the peaks would move it by degrees."""
    if len(curves) == 1 or few_cells_across(run):
        return float("nan")
    return float(np.degrees(crossing(_lowest(curves), _highest(curves))))


def _detail(axes: Axes, run: RunData, curves: Sequence[Engagement], middle: float, half: float) -> None:
    """The curves within `half` [°] of the rotation `middle` [°]."""
    _curves(axes, run, curves, [None] * len(curves))
    inside = [c.max_pressure[np.abs(np.degrees(c.angle) - middle) <= half] for c in curves]
    values = np.concatenate(inside)
    axes.set_xlim(middle - half, middle + half)
    if np.isfinite(values).any():
        low, high = np.nanmin(values), np.nanmax(values)
        axes.set_ylim(low - 0.05 * (high - low) - 1.0, high + 0.05 * (high - low) + 1.0)
    axes.axvline(middle, color=FAINT, linestyle="--", linewidth=1.0)


def _pitches(axes: Axes, run: RunData, curve: Engagement) -> None:
    """Marks of each pitch of rotation, with the names of the tooth pairs between them."""
    low, high = np.degrees(curve.angle[np.isfinite(curve.max_pressure)][[0, -1]])
    pitch = np.degrees(run.pitch)
    for k in range(int(np.floor(low / pitch)), int(np.ceil(high / pitch)) + 1):
        if low < k * pitch < high:
            axes.axvline(k * pitch, color=FAINT, linestyle=":", linewidth=1.0)
    for tooth in shown_teeth([curve]):
        left, right = max(low, tooth * pitch), min(high, (tooth + 1) * pitch)
        if right - left > 0.35 * pitch:
            across = axes.get_xaxis_transform()
            axes.text(0.5 * (left + right), 0.03, short_name(tooth), transform=across, ha="center", fontsize=9)


def _largest(axes: Axes, curve: Engagement, bar: float) -> None:
    """Error bar of the largest pressure. bar: [MPa], NaN where it is unknown."""
    if np.isfinite(bar):
        place = np.degrees(curve.peak.angle), curve.peak.pressure
        axes.errorbar(*place, yerr=bar, color=INK, linewidth=1.2, capsize=4.0, zorder=5.0)


def _engagement_subtitle(run: RunData, curves: Sequence[Engagement], cross: float, bar: float) -> str:
    """Subtitle: the largest pressure, and the effect of friction. cross: rotation of the crossing [°]; bar: error bar
    of the largest pressure [MPa]; both NaN where unknown."""
    lowest, highest = _lowest(curves), _highest(curves)
    top = lowest.peak
    place = signed(float(np.degrees(top.angle)))
    away = f" {AWAY}" if largest_kink(run, int(np.argmin(run.frictions))) else ""
    peak = f"Largest{away} {plus_minus(top.pressure, bar, 0)} MPa at {place}° (μ = {lowest.friction:g})"
    if len(curves) == 1:
        return peak + "."
    angle, change = relative_change(highest, lowest, np.ones(len(highest.angle), dtype=bool))
    passed = Member.named(run.scene.load.driving).sign * angle
    before, after = (signed(100 * float(np.nanmean(change[side]))) for side in (passed < 0.0, passed > 0.0))
    where = f"the curves cross at {signed(cross)}°" if np.isfinite(cross) else "the curves do not cross"
    means = f"μ = {highest.friction:g} changes it by {before} % on average before the pitch point, {after} % after it"
    return f"{peak}; {means}" + ("." if few_cells_across(run) else f"; {where}.")


def _teeth_subtitle(run: RunData, curves: Sequence[Engagement]) -> str:
    """Subtitle: range of the change of stress with friction for each tooth."""
    if len(curves) == 1:
        return f"One friction coefficient, μ = {curves[0].friction:g}."
    lowest, highest = _lowest(curves), _highest(curves)
    parts = []
    for tooth in shown_teeth(curves):
        _, change = relative_change(highest, lowest, highest.tooth == tooth)
        low, high = (signed(100 * float(bound)) for bound in (np.nanmin(change), np.nanmax(change)))
        parts.append(f"{short_name(tooth)} by {low} to {high} %")
    return f"From μ = {lowest.friction:g} to {highest.friction:g} the stress changes: " + ", ".join(parts) + "."
