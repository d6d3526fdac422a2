"""Picture of motions at chosen speeds: mesh force over the phase, and phase portrait."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.results.histories import HistoryRow
from evolvent.dynamics.results.response import DriveSummary
from evolvent.results.drawing.style import FAINT, PINION, WHEEL, foot, note, sheet

ALIKE = 1e-4
"""Largest difference of two motions that are drawn as one, over their largest force."""


def histories_figure(known: DriveSummary, rows: Sequence[HistoryRow]) -> Figure:
    """Mesh force over the phase and phase portrait at chosen speeds. rows: running up and down at each speed."""
    load, speeds = known.static_force_N, list(dict.fromkeys(row.speed_rpm for row in rows))
    figure = sheet(
        "Motion at chosen speeds: mesh force over time, and phase portrait",
        f"Static force {1e-3 * load:.3g} kN. Up and down are drawn apart where they differ.",
        (11.0, 1.3 + 2.7 * len(speeds)),
    )
    grid = figure.subplots(len(speeds), 2, squeeze=False, width_ratios=(1.7, 1.0))
    for (force, portrait), speed in zip(grid, speeds):
        up, down = ([row for row in rows if (row.speed_rpm, row.way) == (speed, way)] for way in ("up", "down"))
        alike = _alike(up, down)
        for motion, colour, style in ((up, PINION, "-"), (down, WHEEL, "--"))[: 1 if alike else 2]:
            name = "up and down" if alike else f"running {motion[0].way}"
            phases, forces = [row.phase for row in motion], [1e-3 * row.force_N for row in motion]
            force.plot(phases, forces, style, color=colour, label=name)
            displacement, velocity = zip(*((row.displacement_um, row.velocity_mm_per_s) for row in motion))
            portrait.plot(displacement, velocity, style, color=colour)
        _finish(force, portrait, up, load)
    for axes, label in zip(grid[-1], ("phase [mesh periods]", "transmission error s [µm]")):
        axes.set_xlabel(label)
    foot(
        figure,
        "Grey: the static force. Force 0: no flanks touch. Force below 0: back flanks press, or the damper pulls at "
        "parting flanks.",
    )
    return figure


def _finish(force: Axes, portrait: Axes, motion: Sequence[HistoryRow], load: float) -> None:
    """Labels of the panels of a speed."""
    force.axhline(1e-3 * load, color=FAINT, lw=1.0, zorder=0)
    force.set_xlim(0.0, motion[-1].phase)
    force.set_ylabel("mesh force [kN]")
    low, high = force.get_ylim()
    force.set_ylim(low, high + 0.2 * (high - low))
    force.legend(loc="upper right", ncols=2)
    note(force, f"{motion[0].speed_rpm:.0f} r/min")
    portrait.set_ylabel("ds/dt [mm/s]")


def _alike(one: Sequence[HistoryRow], other: Sequence[HistoryRow]) -> bool:
    """Whether two motions are the same."""
    if len(one) != len(other):
        return False
    first, second = (np.array([row.force_N for row in motion]) for motion in (one, other))
    return bool(np.abs(first - second).max() <= ALIKE * np.abs(first).max())
