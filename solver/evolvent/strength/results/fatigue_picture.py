"""Picture of contact fatigue: over the flank of the pinion, over the depth below it, and what friction changes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from evolvent.results.drawing.style import FAINT, PINION, PRESSURE_MAP, foot, friction_colours, png, sheet, styled
from evolvent.strength.fatigue.criterion import BELOW, DANG_VAN, DEEP, ORTHOGONAL_SHEAR, VON_MISES
from evolvent.strength.fatigue.flank_fatigue import FlankFatigue
from evolvent.strength.results.fatigue_tables import diameters
from evolvent.strength.results.friction_fatigue import FrictionFatigue
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

PROFILES = {VON_MISES: "-", ORTHOGONAL_SHEAR: "--", DANG_VAN: ":"}
"""Criteria over the depth, and the style of their lines."""
LEVELS, DEPTHS, SHOWN = 24, 201, 2.5
"""Colours, depths at which they are drawn, and the deepest in half-widths of the contact."""


def fatigue_picture(title: str, pair: GearPair, found: Sequence[FrictionFatigue]) -> bytes:
    """PNG of `fatigue_figure`."""
    with styled():
        return png(fatigue_figure(title, pair, found))


def fatigue_figure(title: str, pair: GearPair, found: Sequence[FrictionFatigue]) -> Figure:
    """The criterion of Dang Van over the pinion's flank and over the depth below mid-face, at the last friction
    coefficient; three criteria below the most loaded point, at all.

    title: of the scene.
    """
    own, last = found[-1].gears[Member.PINION], found[-1].friction
    figure = sheet(f"{title}: contact fatigue", f"Dang Van's equivalent shear stress on the pinion, μ = {last:g}; "
                   "right: criteria below the point with the largest contact pressure", (13.5, 5.0))
    over, section, below = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 0.9))
    if len(own.loads.peak):
        scale = Normalize(0.0, float(own.values[DANG_VAN].max()))
        _over_flank(over, pair, own, scale)
        _section(section, pair, own, scale)
        figure.colorbar(ScalarMappable(scale, PRESSURE_MAP), ax=section, label=f"{DANG_VAN.words} [MPa]")
        _below(below, found)
    foot(
        figure,
        "Elastic half-plane under the pressures and friction of the contact solution, one passage. Points in the zones "
        "of tip edges, where pressure is singular, are left out. Dashed line: pitch circle.",
    )
    return figure


def _over_flank(axes: Axes, pair: GearPair, own: FlankFatigue, scale: Normalize) -> None:
    """Largest below the surface, over face and diameter; over the diameter alone in plane strain."""
    diameter = diameters(pair, Member.PINION, own.loads.roll_distance)
    values = own.values[DANG_VAN][:, own.at(BELOW)].max(axis=1)
    axes.set_title(f"{DANG_VAN.words}: largest below {DEEP:g} half-widths", fontsize=10)
    axes.set_ylabel("diameter of the pinion [mm]")
    if len(np.unique(own.loads.height)) > 1:
        axes.tricontourf(own.loads.height, diameter, values, _levels(scale), cmap=PRESSURE_MAP, norm=scale)
        axes.set_xlabel("face [mm]")
    else:
        order = np.argsort(diameter)
        axes.plot(values[order], diameter[order], color=PINION, marker=".")
        axes.set_xlabel(f"{DANG_VAN.words} [MPa]")
    _pitch_line(axes, pair)


def _section(axes: Axes, pair: GearPair, own: FlankFatigue, scale: Normalize) -> None:
    """Over depth and diameter at mid-face."""
    heights = np.unique(own.loads.height)
    middle = np.flatnonzero(own.loads.height == heights[np.argmin(np.abs(heights))])
    middle = middle[np.argsort(own.loads.roll_distance[middle])]
    diameter = diameters(pair, Member.PINION, own.loads.roll_distance[middle])
    known = own.depths_mm[middle]
    depths = np.linspace(0.0, float(np.median(own.loads.half_width)) * SHOWN, DEPTHS)
    values = [np.interp(depths, *each) for each in zip(known, own.values[DANG_VAN][middle])]
    axes.contourf(1e3 * depths, diameter, values, _levels(scale), cmap=PRESSURE_MAP, norm=scale)
    axes.set_title(f"{DANG_VAN.words}: below {'mid-face' if len(heights) > 1 else 'the flank'}", fontsize=10)
    axes.set_xlabel("depth [µm]")
    _pitch_line(axes, pair)


def _levels(scale: Normalize) -> Floats:
    """Limits of the colours, none above the scale."""
    return np.linspace(0.0, float(scale.vmax or 1.0), LEVELS + 1)


def _pitch_line(axes: Axes, pair: GearPair) -> None:
    axes.axhline(pair.working_pitch_diameters[0], color=FAINT, lw=0.8, ls="--")


def _below(axes: Axes, found: Sequence[FrictionFatigue]) -> None:
    for each, colour in zip(found, friction_colours([each.friction for each in found])):
        own = each.gears[Member.PINION]
        top = int(np.argmax(own.loads.peak))
        for criterion, style in PROFILES.items():
            here = own.depths <= SHOWN
            axes.plot(own.values[criterion][top, here], 1e3 * own.depths_mm[top, here], style, color=colour)
        axes.plot([], [], color=colour, label=f"μ = {each.friction:g}")
    for criterion, style in PROFILES.items():
        axes.plot([], [], style, color=FAINT, label=criterion.words)
    axes.set_ylim(axes.get_ylim()[1], 0.0)
    axes.set_xlabel("criterion [MPa]")
    axes.set_ylabel("depth [µm]")
    axes.set_xlim(left=0.0)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
