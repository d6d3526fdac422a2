"""Picture of a pair's vibration over speed and torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection, QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from evolvent.dynamics.results.torque_map import MapRow
from evolvent.results.drawing.style import FAINT, INK, PINION, PRESSURE_MAP, foot, sheet
from evolvent_meshes.arrays import Bools, Floats

WAYS = "running up", "running down"
OTHER = 0.02
"""Least relative difference of the dynamic factor of running down to that of running up at which cells are hatched."""
MARGIN = 0.1
"""Half the height of the cells of a single torque, or half the width of those of a single speed, over that value."""
TICKS = 1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0
"""Ticks of the colour scale of the dynamic factor. It is logarithmic, as factors of running down may be far above those
of running up."""
HALO = withStroke(linewidth=3.0, foreground="white")
"""White outline of lines on the colours of the map."""


@dataclass(frozen=True, eq=False)
class MapGrid:
    """The rows of a map as arrays."""

    torques: Floats
    """(m,) torques, ascending [N·m]."""
    natural_speeds: Floats
    """(m,) natural speed under each torque [r/min]."""
    speeds: Floats
    """(n,) speeds of the pinion, ascending [r/min]."""
    factor: Floats
    """(2, m, n) dynamic factor running up, and down."""
    separated_share: Floats
    """(2, m, n) share of the time out of contact."""

    @staticmethod
    def of(rows: Sequence[MapRow]) -> MapGrid:
        """Arrays of rows that are ordered by torque, way and speed."""
        torques = np.array(sorted({row.torque_Nm for row in rows}))

        def over(name: str) -> Floats:
            values = np.array([getattr(row, name) for row in rows])
            return values.reshape(len(torques), 2, -1).transpose(1, 0, 2)

        speeds, natural = over("speed_rpm")[0, 0], over("natural_speed_rpm")[0, :, 0]
        return MapGrid(torques, natural, speeds, over("dynamic_factor"), over("separated_share"))


def torque_map_figure(rows: Sequence[MapRow]) -> Figure:
    """Dynamic factor over speed and torque, running up and down, with the natural speed under each torque and the
    region in which flanks part."""
    grid = MapGrid.of(rows)
    figure = sheet("Dynamic factor over speed and torque", _largest(grid), (11.0, 8.4))
    panels, norm = figure.subplots(2, 1, sharex=True, sharey=True), LogNorm(1.0, float(grid.factor.max()))
    for axes, way, factor, separated in zip(panels, WAYS, grid.factor, grid.separated_share):
        drawn = _draw_cells(axes, grid, factor, norm)
        if grid.separated_share.any():
            _draw_region(axes, grid, separated > 0.0)
        _draw_natural(axes, grid)
        axes.set_title(way, loc="left", fontsize=10, color=INK)
        axes.set_ylabel("torque [N·m]")
        axes.grid(visible=False)
    different = np.abs(grid.factor[1] / grid.factor[0] - 1.0) > OTHER
    _hatch(panels[1], grid, different)
    panels[0].set_xlim(*_edges(grid.speeds)[[0, -1]])
    panels[0].set_yticks(grid.torques, [f"{torque:.4g}" for torque in grid.torques])
    panels[1].set_xlabel("speed of the pinion [r/min]")
    panels[0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.1)
    ticks = [tick for tick in TICKS if tick <= norm.vmax]
    bar = figure.colorbar(drawn, ax=panels, pad=0.015, label="largest mesh force over the static one")
    bar.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    bar.minorticks_off()
    foot(figure, *_feet(different, rows[0].bodies))
    return figure


def _largest(grid: MapGrid) -> str:
    """Sentence on the largest dynamic factors, and on whether flanks part."""
    found = []
    for way, factor in zip(WAYS, grid.factor):
        i, j = np.unravel_index(int(np.argmax(factor)), factor.shape)
        found.append(f"{factor[i, j]:.3g} {way} ({grid.speeds[j]:.0f} r/min, {grid.torques[i]:.4g} N·m)")
    return f"Largest: {', '.join(found)}; flanks {'part' if grid.separated_share.any() else 'never part'}."


def _feet(different: Bools, bodies: str) -> list[str]:
    """Sentences at the foot of the picture: gear bodies (elastic or rigid), cells, and differences between running up
    and down."""
    of, said = f"Of {bodies} gear bodies.", "Each cell is a speed under a torque that was computed, torque_map.csv."
    if not different.any():
        return [of, f"{said} Running up and down the factors are the same within {100.0 * OTHER:.0f} %."]
    return [of, f"{said} Hatched: the factor differs by more than {100.0 * OTHER:.0f} % from that of running up."]


def _draw_cells(axes: Axes, grid: MapGrid, factor: Floats, norm: LogNorm) -> QuadMesh:
    """Draws the colours of the dynamic factor (m, n)."""
    edges = _edges(grid.speeds), _edges(grid.torques)
    return axes.pcolormesh(*edges, factor, cmap=PRESSURE_MAP, norm=norm)


def _hatch(axes: Axes, grid: MapGrid, where: Bools) -> None:
    """Hatches the cells at which `where` (m, n) is true."""
    x, y = _edges(grid.speeds), _edges(grid.torques)
    cells = [[(x[j], y[i]), (x[j + 1], y[i]), (x[j + 1], y[i + 1]), (x[j], y[i + 1])] for i, j in np.argwhere(where)]
    axes.add_collection(PolyCollection(cells, hatch="///", facecolor="none", edgecolor=FAINT, linewidth=0.0))


def _draw_region(axes: Axes, grid: MapGrid, inside: Bools) -> None:
    """Draws the outline of a region: the sides of cells between those inside (m, n) and those outside."""
    x, y, padded = _edges(grid.speeds), _edges(grid.torques), np.pad(inside, 1)
    upright = np.argwhere(padded[1:-1, 1:] != padded[1:-1, :-1])
    level = np.argwhere(padded[1:, 1:-1] != padded[:-1, 1:-1])
    sides = [((x[j], y[i]), (x[j], y[i + 1])) for i, j in upright]
    sides += [((x[j], y[i]), (x[j + 1], y[i])) for i, j in level]
    for colour, width, label in (("white", 3.0, None), (PINION, 1.6, "flanks part inside")):
        axes.add_collection(LineCollection(sides, colors=colour, linewidths=width, capstyle="projecting", label=label))


def _draw_natural(axes: Axes, grid: MapGrid) -> None:
    """Draws the natural speed under each torque, its half and its third."""
    for part, style, label in ((1, "--", "natural speed"), (2, ":", "its half and third"), (3, ":", None)):
        speeds = grid.natural_speeds / part
        axes.plot(speeds, grid.torques, style, color=INK, lw=1.4, path_effects=[HALO], label=label)


def _edges(values: Floats) -> Floats:
    """(n + 1,) ends of cells around values (n,) above 0, halfway between them."""
    if len(values) == 1:
        return values * np.array([1.0 - MARGIN, 1.0 + MARGIN])
    ends = max(1.5 * values[0] - 0.5 * values[1], 0.0), 1.5 * values[-1] - 0.5 * values[-2]
    return np.concatenate([ends[:1], 0.5 * (values[1:] + values[:-1]), ends[1:]])
