"""Picture of contact fatigue: over the flank of the pinion, over the depth below it, and what friction changes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from evolvent.results.drawing.style import FAINT, PINION, PRESSURE_MAP, foot, friction_colours, sheet
from evolvent.strength.fatigue.criterion import DANG_VAN, DEEP, ORTHOGONAL_SHEAR, VON_MISES
from evolvent.strength.results.fatigue_facts import FatigueFacts
from evolvent.strength.results.fatigue_rows import FatigueDepthRow, FatigueMapRow
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

PROFILES = {VON_MISES: "-", ORTHOGONAL_SHEAR: "--", DANG_VAN: ":"}
"""Criteria over the depth, and the style of their lines."""
Colour = str | tuple[float, ...]
LEVELS, DEPTHS, SHOWN = 24, 201, 2.5
"""Colours, depths at which they are drawn, and the deepest in half-widths of the contact."""

HATCHED: Mapping[str, Any] = {"facecolor": "none", "edgecolor": "white", "hatch": "///", "lw": 0.0}
"""How the flank is drawn where friction reverses."""
REVERSAL = "Hatched, hollow points: friction reverses nearby, so that the stress history, and the value, does not hold."
"""Sentence at the foot of the picture where there are such points."""


def fatigue_figure(
    title: str, facts: Sequence[FatigueFacts], over: Sequence[FatigueMapRow], section: Sequence[FatigueDepthRow],
    below: Sequence[FatigueDepthRow],
) -> Figure:
    """The criterion of Dang Van over the pinion's flank and over the depth below mid-face, at the first friction
    coefficient above 0, if there is one; three criteria below the most loaded point, at all coefficients.

    title: of the scene. over: all over the flanks; section: below points at mid-face; below: below the most loaded one.
    """
    first = next((row.friction for row in over if row.friction), 0.0)
    points = [
        row for row in over
        if (row.gear, row.friction, row.criterion) == (Member.PINION.label, first, DANG_VAN.name)
    ]
    fact = next(fact for fact in facts if fact.friction == first)
    error = fact.largest_pressure_MPa_error / fact.largest_pressure_MPa
    where = "the point with the largest contact pressure" + (" away from the pitch line" if first else "")
    cut = [row for row in section if (row.gear, row.friction) == (Member.PINION.label, first)]
    largest = [max(row.at_surface, row.at_0_02, row.at_0_05, row.at_0_1, row.below) for row in points]
    scale = Normalize(0.0, max(*largest, *(row.value for row in cut)))
    figure = sheet(f"{title}: contact fatigue", f"Dang Van's equivalent shear stress on the pinion, μ = {first:g}; "
                   f"right: criteria below {where}",
                   (13.5, 5.0))
    flank, depth, profiles = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 0.9))
    _over_flank(flank, points, scale, error)
    _section(depth, cut, float(np.median([row.half_width_mm for row in points])), scale)
    _hatch_reversal(depth, points, sorted({row.diameter_mm for row in cut}))
    depth.set_title(f"{DANG_VAN.words}: below {'mid-face' if _has_width(points) else 'the flank'}", fontsize=10)
    for axes in (flank, depth):
        axes.axhline(fact.pinion_pitch_diameter_mm, color=FAINT, lw=0.8, ls="--")
    figure.colorbar(ScalarMappable(scale, PRESSURE_MAP), ax=depth, label=f"{DANG_VAN.words} [MPa]")
    _below(profiles, [row for row in below if row.gear == Member.PINION.label], error)
    band = f"Bands: estimated error by the contact pressure, {100.0 * error:.2g} % at μ = {first:g}."
    foot(
        figure,
        *([REVERSAL] if any(row.near_friction_reversal for row in points) else []),
        *([band] if np.isfinite(error) else []),
        "Elastic half-plane under the pressures and friction of the contact solution, one passage. Points in the zones "
        "of tip edges, where pressure is singular, are left out. Dashed line: pitch circle.",
    )
    return figure


def _has_width(points: Sequence[FatigueMapRow]) -> bool:
    """Whether points lie at several heights: not in plane strain."""
    return len({row.height_mm for row in points}) > 1


def _over_flank(axes: Axes, points: Sequence[FatigueMapRow], scale: Normalize, error: float) -> None:
    """Dang Van's criterion, the largest below the surface, over face and diameter; over the diameter alone in plane
    strain. Where friction reverses the flank is hatched; in plane strain points are hollow. error: relative; NaN where
    it is not known."""
    columns = [(row.height_mm, row.diameter_mm, row.below) for row in points]
    height, diameter, values = np.array(columns).T
    doubtful = np.array([row.near_friction_reversal for row in points])
    axes.set_title(f"{DANG_VAN.words}: largest below {DEEP:g} half-widths", fontsize=10)
    axes.set_ylabel("diameter of the pinion [mm]")
    if _has_width(points):
        axes.tricontourf(height, diameter, values, _levels(scale), cmap=PRESSURE_MAP, norm=scale)
        if doubtful.any():
            axes.axhspan(diameter[doubtful].min(), diameter[doubtful].max(), **HATCHED)
        axes.set_xlabel("face [mm]")
    else:
        axes.plot(values, diameter, color=PINION, marker=".")
        axes.plot(values[doubtful], diameter[doubtful], "o", mfc="white", mec=PINION, ls="none", ms=6.0, zorder=3)
        _band(axes, values, diameter, error, PINION)
        axes.set_xlabel(f"{DANG_VAN.words} [MPa]")


def _band(axes: Axes, values: Floats, places: Floats, error: float, colour: Colour) -> None:
    """Band of a relative error around values (n,) at places (n,); none where the error is not known."""
    if np.isfinite(error):
        axes.fill_betweenx(places, values * (1.0 - error), values * (1.0 + error), color=colour, alpha=0.2, lw=0.0)


def _hatch_reversal(axes: Axes, points: Sequence[FatigueMapRow], diameters: Sequence[float]) -> None:
    """Hatches the section about the points near which friction reverses, half-way to the next ones. diameters: of all
    its points, ascending."""
    near = {row.diameter_mm for row in points if row.near_friction_reversal}
    middles = [0.5 * (one + other) for one, other in pairwise(diameters)]
    limits = [diameters[0], *middles, diameters[-1]]
    for diameter, (low, high) in zip(diameters, pairwise(limits)):
        if diameter in near:
            axes.axhspan(low, high, **HATCHED)


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


def _below(axes: Axes, rows: Sequence[FatigueDepthRow], error: float) -> None:
    """Criteria over the depth, a colour a friction coefficient. error: relative, at the first of them."""
    frictions = list(dict.fromkeys(row.friction for row in rows))
    for friction, colour in zip(frictions, friction_colours(frictions)):
        shown = [row for row in rows if row.friction == friction and row.depth_over_half_width <= SHOWN]
        for criterion, style in PROFILES.items():
            own = [row for row in shown if row.criterion == criterion.name]
            values, depths = np.array([(row.value, row.depth_um) for row in own]).T
            axes.plot(values, depths, style, color=colour)
            if friction == frictions[0]:
                _band(axes, values, depths, error, colour)
        axes.plot([], [], color=colour, label=f"μ = {friction:g}")
    for criterion, style in PROFILES.items():
        axes.plot([], [], style, color=FAINT, label=criterion.words)
    axes.set_ylim(axes.get_ylim()[1], 0.0)
    axes.set_xlabel("criterion [MPa]")
    axes.set_ylabel("depth [µm]")
    axes.set_xlim(left=0.0)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
