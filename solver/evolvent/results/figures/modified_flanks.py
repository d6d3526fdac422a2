"""Topography of the modified flanks: depth of the modifications of each, and the gap between them."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from evolvent.results.drawing.style import INK, foot, sheet
from evolvent.results.figures.flank import FACE, ROLL
from evolvent.results.run_data import RunData
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank, separation
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

DEPTH_MAP = LinearSegmentedColormap.from_list(
    "evolvent_depth", matplotlib.colormaps["YlGnBu"](np.linspace(0.0, 0.7, 64))
)
"""Sequential colours from no material removed to the most, light enough for dark words on them."""
LEAST = 1e-3
"""Smallest upper end of the colour scale [µm]."""
SHORTEST = 0.25
"""Length of a line that has a label, over that of the map along one axis."""
POINTS = 201
"""Grid points of a map along each axis; odd, so that mid-face is one."""


def has_modifications(run: RunData) -> bool:
    """Whether the flank of either gear is modified."""
    return not all(gear.modifications.is_empty for gear in run.pair.gears)


def modified_flanks(run: RunData) -> Figure:
    """Maps of both flanks and of the gap between them, over axial position and roll distance."""
    ξ, z, depths = topography(run.pair)
    figure = sheet("Flank modifications", _sentence(depths), (12.0, 5.4))
    axes = figure.subplots(1, len(depths), sharey=True)
    top = max(LEAST, *(float(depth.max()) for depth in depths.values()))
    for ax, (name, depth) in zip(axes, depths.items()):
        shown = ax.pcolormesh(z, ξ, depth, cmap=DEPTH_MAP, vmin=0.0, vmax=top, shading="gouraud", rasterized=True)
        _contours(ax, ξ, z, depth, top)
        ax.set_title(name, fontsize=10)
        ax.set(xlabel=FACE)
        ax.xaxis.set_major_locator(MaxNLocator(5, prune="both"))
        ax.grid(False)
    axes[0].set_ylabel(ROLL)
    bar = figure.colorbar(shown, ax=list(axes), location="right", aspect=30, pad=0.02)
    bar.set_label("material removed, gap [µm]")
    foot(
        figure,
        "Normal to the involute helicoid, over the path of contact: pinion's tip and wheel's root are at the top. "
        "Flank charts are left out.",
    )
    return figure


def topography(pair: GearPair) -> tuple[Floats, Floats, dict[str, Floats]]:
    """Roll distances ξ (n,) and heights z (m,) [mm], and maps (n, m) [µm] by what they show: the pinion's flank, the
    wheel's, and the gap between flanks without load, which just touch where it is least, misalignment included."""
    ξ, half = np.linspace(*pair.path_of_contact, POINTS), 0.5 * pair.face_width
    z = np.linspace(-half, half, POINTS)
    each = {
        f"{member.label}'s flank": Flank(gear).modification(ρ[:, None], z)
        for member, gear, ρ in zip(Member, pair.gears, pair.curvature_radii(ξ))
    }
    gap = separation(pair, ξ[:, None], z)
    return ξ, z, {name: 1e3 * depth for name, depth in (each | {"gap between both": gap - gap.min()}).items()}


def _contours(axes: Axes, ξ: Floats, z: Floats, depth: Floats, top: float) -> None:
    """Lines of equal depth, the long ones labelled in their middle; none where the depth is nearly even."""
    ticks = MaxNLocator(8, steps=(1, 2, 5, 10)).tick_values(0.0, top)
    levels = [level for level in ticks if depth.min() < level < depth.max()]
    if not levels or np.ptp(depth) < 0.01 * top:
        return
    lines = axes.contour(z, ξ, depth, levels=levels, colors=INK, linewidths=0.7)
    size = np.array([np.ptp(z), np.ptp(ξ)])
    long = [line for each in lines.allsegs for line in each if (np.ptp(line, axis=0) / size).max() > SHORTEST]
    axes.clabel(lines, fmt="%g", fontsize=8, manual=[tuple(line[len(line) // 2]) for line in long])


def _sentence(depths: dict[str, Floats]) -> str:
    """Sentence on the largest depth of each map."""
    pinion, wheel, gap = (f"{float(depth.max()):.1f} µm" for depth in depths.values())
    return (
        f"Up to {pinion} are taken off the pinion's flank, up to {wheel} off the wheel's; without load the flanks are "
        f"up to {gap} apart."
    )
