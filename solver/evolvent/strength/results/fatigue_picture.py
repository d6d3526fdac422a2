"""Picture of contact fatigue: over the flank of the pinion, over the depth below it, and what friction changes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from evolvent.results.drawing.style import FAINT, PINION, PRESSURE_MAP, foot, friction_colours, png, sheet, styled
from evolvent.strength.fatigue.criterion import DANG_VAN, DEEP, ORTHOGONAL_SHEAR, VON_MISES
from evolvent.strength.results.fatigue_facts import FatigueFacts
from evolvent.strength.results.fatigue_rows import FatigueDepthRow, FatigueMapRow
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

PROFILES = {VON_MISES: "-", ORTHOGONAL_SHEAR: "--", DANG_VAN: ":"}
"""Criteria over the depth, and the style of their lines."""
LEVELS, DEPTHS, SHOWN = 24, 201, 2.5
"""Colours, depths at which they are drawn, and the deepest in half-widths of the contact."""


def fatigue_picture(
    title: str, facts: Sequence[FatigueFacts], over: Sequence[FatigueMapRow], section: Sequence[FatigueDepthRow],
    below: Sequence[FatigueDepthRow],
) -> bytes:
    """PNG of `fatigue_figure`."""
    with styled():
        return png(fatigue_figure(title, facts, over, section, below))


def fatigue_figure(
    title: str, facts: Sequence[FatigueFacts], over: Sequence[FatigueMapRow], section: Sequence[FatigueDepthRow],
    below: Sequence[FatigueDepthRow],
) -> Figure:
    """The criterion of Dang Van over the pinion's flank and over the depth below mid-face, at the last friction
    coefficient; three criteria below the most loaded point, at all.

    title: of the scene. over: all over the flanks; section: below points at mid-face; below: below the most loaded one.
    """
    last = over[-1].friction
    points = [
        row for row in over
        if (row.gear, row.friction, row.criterion) == (Member.PINION.label, last, DANG_VAN.name)
    ]
    cut = [row for row in section if (row.gear, row.friction) == (Member.PINION.label, last)]
    largest = [max(row.at_surface, row.at_0_02, row.at_0_05, row.at_0_1, row.below) for row in points]
    scale = Normalize(0.0, max(*largest, *(row.value for row in cut)))
    figure = sheet(f"{title}: contact fatigue", f"Dang Van's equivalent shear stress on the pinion, μ = {last:g}; "
                   "right: criteria below the point with the largest contact pressure", (13.5, 5.0))
    flank, depth, profiles = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 0.9))
    _over_flank(flank, points, scale)
    _section(depth, cut, float(np.median([row.half_width_mm for row in points])), scale)
    depth.set_title(f"{DANG_VAN.words}: below {'mid-face' if _has_width(points) else 'the flank'}", fontsize=10)
    for axes in (flank, depth):
        axes.axhline(facts[0].pinion_pitch_diameter_mm, color=FAINT, lw=0.8, ls="--")
    figure.colorbar(ScalarMappable(scale, PRESSURE_MAP), ax=depth, label=f"{DANG_VAN.words} [MPa]")
    _below(profiles, [row for row in below if row.gear == Member.PINION.label])
    foot(
        figure,
        "Elastic half-plane under the pressures and friction of the contact solution, one passage. Points in the zones "
        "of tip edges, where pressure is singular, are left out. Dashed line: pitch circle.",
    )
    return figure


def _has_width(points: Sequence[FatigueMapRow]) -> bool:
    """Whether points lie at several heights: not in plane strain."""
    return len({row.height_mm for row in points}) > 1


def _over_flank(axes: Axes, points: Sequence[FatigueMapRow], scale: Normalize) -> None:
    """Dang Van's criterion, the largest below the surface, over face and diameter; over the diameter alone in plane
    strain."""
    columns = [(row.height_mm, row.diameter_mm, row.below) for row in points]
    height, diameter, values = np.array(columns).T
    axes.set_title(f"{DANG_VAN.words}: largest below {DEEP:g} half-widths", fontsize=10)
    axes.set_ylabel("diameter of the pinion [mm]")
    if _has_width(points):
        axes.tricontourf(height, diameter, values, _levels(scale), cmap=PRESSURE_MAP, norm=scale)
        axes.set_xlabel("face [mm]")
    else:
        axes.plot(values, diameter, color=PINION, marker=".")
        axes.set_xlabel(f"{DANG_VAN.words} [MPa]")


def _section(axes: Axes, rows: Sequence[FatigueDepthRow], half_width: float, scale: Normalize) -> None:
    """Dang Van's criterion over depth and diameter. rows: point by point; half_width: of the contact, median of the
    flank [mm]."""
    depths = np.linspace(0.0, 1e3 * half_width * SHOWN, DEPTHS)
    count = len({row.depth_over_half_width for row in rows})
    points = [rows[k : k + count] for k in range(0, len(rows), count)]
    values = [
        np.interp(depths, [row.depth_um for row in point], [row.value for row in point]) for point in points
    ]
    diameters = [point[0].diameter_mm for point in points]
    axes.contourf(depths, diameters, values, _levels(scale), cmap=PRESSURE_MAP, norm=scale)
    axes.set_xlabel("depth [µm]")


def _levels(scale: Normalize) -> Floats:
    """Limits of the colours, none above the scale."""
    return np.linspace(0.0, float(scale.vmax or 1.0), LEVELS + 1)


def _below(axes: Axes, rows: Sequence[FatigueDepthRow]) -> None:
    """Criteria over the depth, a colour a friction coefficient."""
    frictions = list(dict.fromkeys(row.friction for row in rows))
    for friction, colour in zip(frictions, friction_colours(frictions)):
        shown = [row for row in rows if row.friction == friction and row.depth_over_half_width <= SHOWN]
        for criterion, style in PROFILES.items():
            own = [row for row in shown if row.criterion == criterion.name]
            axes.plot([row.value for row in own], [row.depth_um for row in own], style, color=colour)
        axes.plot([], [], color=colour, label=f"μ = {friction:g}")
    for criterion, style in PROFILES.items():
        axes.plot([], [], style, color=FAINT, label=criterion.words)
    axes.set_ylim(axes.get_ylim()[1], 0.0)
    axes.set_xlabel("criterion [MPa]")
    axes.set_ylabel("depth [µm]")
    axes.set_xlim(left=0.0)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
