"""Contact stress of a tooth over its engagement and over the friction coefficient (Yang et al. 2022, Figs 8 to 10)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from meshes.data import Floats
from solver.engagement import Engagement, crossing, engagements
from solver.estimated_errors import plus_minus
from solver.plain_text import signed
from solver.plots_style import FAINT, INK, TEETH, friction_colours, note, sheet
from solver.run_data import RunData

STRESS = "maximum contact stress [MPa]"
OWN_ANGLE = "pinion rotation of the tooth [°]   (0: its flanks meet at the pitch point, mid-face)"
NAMES = {
    1: "tooth 1 (ahead, leaves the mesh)",
    0: "tooth 2 (through the pitch point)",
    -1: "tooth 3 (enters, near the root)",
}
"""The paper's three teeth as this run's tooth pairs over the pitch from φ = 0."""


def engagement_stress(run: RunData) -> Figure:
    """Maximum contact stress of one tooth over its whole engagement for every μ; the crossing enlarged (Fig. 9)."""
    curves = engagements(run)
    cross = _crossing_deg(curves)
    bar = run.errors.bar("max_pressure_MPa", int(np.argmin(run.frictions)))
    figure = sheet("Contact stress of a tooth over its engagement", _see_engagement(curves, cross, bar), (10.4, 5.6))
    main, detail = figure.subplots(1, 2, width_ratios=(2.3, 1.0)) if len(curves) > 1 else (figure.subplots(), None)
    _curves(main, run, curves, [None] * len(curves))
    low, high = (signed(ξ) for ξ in run.inner_path)
    note(main, f"between the tip-edge zones, ξ = {low} to {high} mm", 0.4, 0.99)
    _largest(main, _lowest(curves), bar)
    _pitches(main, run, curves[0])
    main.set(xlabel=OWN_ANGLE, ylabel=STRESS)
    values = np.concatenate([c.max_pressure for c in curves])
    largest = np.nanmax(_lowest(curves).max_pressure) + np.array([-1.0, 1.0]) * bar  # NaN: no bar
    bottom, top = np.nanmin([0.6 * np.nanmin(values), largest[0]]), np.nanmax([np.nanmax(values), largest[1]])
    main.set_ylim(max(0.0, 0.92 * bottom), 1.06 * top)
    main.legend(loc="lower center", bbox_to_anchor=(0.5, 0.09), ncols=4)
    if detail is not None:
        _detail(detail, run, curves, cross if np.isfinite(cross) else 0.0, 5.0)
        detail.set_title(
            "enlarged at the crossing" if np.isfinite(cross) else "enlarged at the pitch point", fontsize=10
        )
        detail.set(xlabel="pinion rotation of the tooth [°]")
    return figure


def tooth_stress(run: RunData) -> Figure:
    """Teeth 1, 2 and 3 over one pitch of pinion rotation for every μ; below, the spread over μ (Fig. 8)."""
    curves = engagements(run)
    see = _see_teeth(curves)
    figure = sheet("Contact stress of teeth 1, 2 and 3 over a pitch of pinion rotation", see, (11.6, 6.6))
    grid = figure.subplots(2, 3, sharex=True, height_ratios=(1.5, 1.0))
    for column, tooth in enumerate(NAMES):
        top, below = grid[0, column], grid[1, column]
        members = [c.tooth == tooth for c in curves]
        _curves(top, run, curves, members, tooth)
        _change(below, run, curves, members, tooth)
        top.set_title(NAMES[tooth], fontsize=10)
        below.set_xlabel("pinion rotation φ [°]")
    grid[0, 0].set_ylabel(STRESS)
    grid[1, 0].set_ylabel(f"change against μ = {_lowest(curves).friction:g} [%]")
    grid[0, 0].legend(loc="best")
    return figure


def friction_trend(run: RunData) -> Figure:
    """Average and maximum contact stress of teeth 1, 2, 3 over μ, and their changes (Fig. 10)."""
    curves = sorted(engagements(run), key=lambda c: c.friction)
    found, μ = trends(curves), [c.friction for c in curves]
    changes = ", ".join(f"tooth {2 - t.tooth} {signed(100 * (t.largest[-1] / t.largest[0] - 1))} %" for t in found)
    see = f"The maximum changes from μ = {μ[0]:g} to {μ[-1]:g}: {changes}."
    figure = sheet("Contact stress over the friction coefficient", see, (10.4, 6.4))
    grid = figure.subplots(2, 2, sharex=True, height_ratios=(1.2, 1.0))
    for trend, colour, marker in zip(found, TEETH, "osD"):
        for column, values in enumerate((trend.average, trend.largest)):
            grid[0, column].plot(μ, values, color=colour, marker=marker, label=NAMES[trend.tooth])
            grid[1, column].plot(μ, 100.0 * (values / values[0] - 1.0), color=colour, marker=marker)
    for column, title in enumerate(("average along the contact line, over the pitch", "maximum over the pitch")):
        grid[0, column].set_title(title, fontsize=10)
        grid[0, column].set_ylim(0.0, 1.5 * max(np.max(t.largest) for t in found))
        grid[1, column].axhline(0.0, color=FAINT, linewidth=1.0)
        grid[1, column].set_xlabel("friction coefficient μ")
        grid[1, column].set_xlim(0.0, 1.05 * μ[-1])
    grid[0, 0].set_ylabel("contact stress [MPa]")
    grid[1, 0].set_ylabel(f"change against μ = {μ[0]:g} [%]")
    grid[0, 1].legend(loc="upper right")
    return figure


def _curves(
    axes: Axes, run: RunData, curves: Sequence[Engagement], members: Sequence[np.ndarray | None], tooth: int = 0
) -> None:
    """Maximum pressure over rotation; over the pinion's own φ where one tooth is picked out."""
    for curve, here, colour in zip(curves, members, friction_colours(run.frictions)):
        x, y = _shown(run, curve, here, tooth)
        axes.plot(x, y, color=colour, marker=".", markersize=3.0, label=f"μ = {curve.friction:g}")


def _shown(run: RunData, curve: Engagement, here: np.ndarray | None, tooth: int) -> tuple[Floats, Floats]:
    if here is None:
        return np.degrees(curve.angle), curve.max_pressure
    return np.degrees(curve.angle[here] - tooth * run.pitch), curve.max_pressure[here]


def _change(axes: Axes, run: RunData, curves: Sequence[Engagement], members: Sequence[np.ndarray], tooth: int) -> None:
    """Change of the maximum pressure against the smallest μ [%]."""
    lowest = _lowest(curves)
    axes.axhline(0.0, color=FAINT, linewidth=1.0)
    for curve, colour in zip(curves, friction_colours(run.frictions)):
        angle, change = relative_change(curve, lowest, curve.tooth == tooth)
        axes.plot(np.degrees(angle - tooth * run.pitch), 100.0 * change, color=colour)


def relative_change(curve: Engagement, lowest: Engagement, here: np.ndarray) -> tuple[Floats, Floats]:
    """(angles [rad], relative change of the maximum pressure) against another friction coefficient's curve."""
    key = np.round(curve.angle, 9)
    _, first, second = np.intersect1d(key[here], np.round(lowest.angle, 9), return_indices=True)
    mine = np.flatnonzero(here)[first]
    return curve.angle[mine], curve.max_pressure[mine] / lowest.max_pressure[second] - 1.0


def present(curves: Sequence[Engagement]) -> list[int]:
    """Which of the three teeth have a contact stress in this pitch."""
    pressures = [(c.tooth, pressure) for c in curves for pressure in (c.max_pressure, c.mean_pressure)]
    return [t for t in NAMES if all(np.isfinite(pressure[tooth == t]).any() for tooth, pressure in pressures)]


def _lowest(curves: Sequence[Engagement]) -> Engagement:
    return min(curves, key=lambda c: c.friction)


def _highest(curves: Sequence[Engagement]) -> Engagement:
    return max(curves, key=lambda c: c.friction)


def _crossing_deg(curves: Sequence[Engagement]) -> float:
    """Where the curves of the least and of the most friction cross [°]; NaN: nowhere."""
    return float(np.degrees(crossing(_lowest(curves), _highest(curves)))) if len(curves) > 1 else float("nan")


def _detail(axes: Axes, run: RunData, curves: Sequence[Engagement], middle: float, half: float) -> None:
    """The curves near `middle` [°]."""
    _curves(axes, run, curves, [None] * len(curves))
    inside = [c.max_pressure[np.abs(np.degrees(c.angle) - middle) <= half] for c in curves]
    values = np.concatenate(inside)
    axes.set_xlim(middle - half, middle + half)
    if np.isfinite(values).any():
        low, high = np.nanmin(values), np.nanmax(values)
        axes.set_ylim(low - 0.05 * (high - low) - 1.0, high + 0.05 * (high - low) + 1.0)
    axes.axvline(middle, color=FAINT, linestyle="--", linewidth=1.0)


def _pitches(axes: Axes, run: RunData, curve: Engagement) -> None:
    """Marks the rotations at which the next tooth pair comes to the same place, and names the teeth."""
    low, high = np.degrees(curve.angle[0]), np.degrees(curve.angle[-1])
    pitch = np.degrees(run.pitch)
    for k in range(int(np.floor(low / pitch)), int(np.ceil(high / pitch)) + 1):
        if low < k * pitch < high:
            axes.axvline(k * pitch, color=FAINT, linestyle=":", linewidth=1.0)
    for tooth in NAMES:
        left, right = max(low, tooth * pitch), min(high, (tooth + 1) * pitch)
        if right - left > 0.3 * pitch:
            across = axes.get_xaxis_transform()
            axes.text(0.5 * (left + right), 0.03, f"tooth {2 - tooth}", transform=across, ha="center", fontsize=9)


def _largest(axes: Axes, curve: Engagement, bar: float) -> None:
    """The error bar [MPa] of the largest pressure, where there is one."""
    if np.isfinite(bar):
        top = int(np.nanargmax(curve.max_pressure))
        place = np.degrees(curve.angle[top]), curve.max_pressure[top]
        axes.errorbar(*place, yerr=bar, color=INK, linewidth=1.2, capsize=4.0, zorder=5.0)


def _see_engagement(curves: Sequence[Engagement], cross: float, bar: float) -> str:
    """bar: of the largest pressure [MPa], NaN where it is not known."""
    lowest, highest = _lowest(curves), _highest(curves)
    top = int(np.nanargmax(lowest.max_pressure))
    place = signed(float(np.degrees(lowest.angle[top])))
    peak = f"Largest {plus_minus(lowest.max_pressure[top], bar, 0)} MPa at {place}° (μ = {lowest.friction:g})"
    if len(curves) == 1:
        return peak + "."
    angle, change = relative_change(highest, lowest, np.ones(len(highest.angle), dtype=bool))
    before, after = (signed(100 * float(np.nanmean(change[side]))) for side in (angle < 0.0, angle > 0.0))
    where = f"the curves cross at {signed(cross)}°" if np.isfinite(cross) else "the curves do not cross"
    means = f"μ = {highest.friction:g} changes it by {before} % on average before the pitch point, {after} % after it"
    return f"{peak}; {means}; {where}."


def _see_teeth(curves: Sequence[Engagement]) -> str:
    if len(curves) == 1:
        return f"One friction coefficient, μ = {curves[0].friction:g}."
    lowest, highest = _lowest(curves), _highest(curves)
    parts = []
    for tooth in present(curves):
        _, change = relative_change(highest, lowest, highest.tooth == tooth)
        low, high = (signed(100 * float(bound)) for bound in (np.nanmin(change), np.nanmax(change)))
        parts.append(f"tooth {2 - tooth} {low} to {high} %")
    return f"From μ = {lowest.friction:g} to {highest.friction:g} the stress changes: " + ", ".join(parts) + "."


@dataclass(frozen=True)
class Trend:
    """Over μ ascending: average and maximum contact stress [MPa] of a tooth over the pitch."""

    tooth: int
    average: Floats
    largest: Floats


def trends(curves: Sequence[Engagement]) -> list[Trend]:
    """Of the three teeth; the average is along the contact line, then over the positions."""
    return [
        Trend(
            tooth,
            np.array([np.nanmean(c.mean_pressure[c.tooth == tooth]) for c in curves]),
            np.array([np.nanmax(c.max_pressure[c.tooth == tooth]) for c in curves]),
        )
        for tooth in present(curves)
    ]
