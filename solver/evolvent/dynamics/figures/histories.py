"""Picture of motions at chosen speeds: mesh force over the phase, and phase portrait."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.results.histories import Motion
from evolvent.results.drawing.style import FAINT, PINION, WHEEL, foot, note, png, sheet, styled

ALIKE = 1e-4
"""Largest difference of two motions that are drawn as one, over their size."""


def histories_picture(found: Sequence[Motion], load: float) -> bytes:
    """PNG of `histories_figure`."""
    with styled():
        return png(histories_figure(found, load))


def histories_figure(found: Sequence[Motion], load: float) -> Figure:
    """found: up and down at each speed. load: static force [N]."""
    pairs = list(zip(found[::2], found[1::2]))
    figure = sheet(
        "Motion at chosen speeds: mesh force over time, and phase portrait",
        f"Static force {1e-3 * load:.3g} kN. Up and down are drawn apart where they differ.",
        (11.0, 1.3 + 2.7 * len(pairs)),
    )
    grid = figure.subplots(len(pairs), 2, squeeze=False, width_ratios=(1.7, 1.0))
    for (force, portrait), (up, down) in zip(grid, pairs):
        alike = _alike(up, down)
        for motion, colour, style in ((up, PINION, "-"), (down, WHEEL, "--"))[: 1 if alike else 2]:
            name = "up and down" if alike else f"running {motion.way}"
            force.plot(motion.phases, 1e-3 * motion.over("force"), style, color=colour, label=name)
            portrait.plot(1e3 * motion.over("displacement"), motion.over("velocity"), style, color=colour)
        _finish(force, portrait, up, load)
    for axes, label in zip(grid[-1], ("phase [mesh periods]", "transmission error s [µm]")):
        axes.set_xlabel(label)
    foot(
        figure,
        "Grey: the static force. Force 0: no flanks touch. Force below 0: back flanks press, or the damper pulls at "
        "parting flanks.",
    )
    return figure


def _finish(force: Axes, portrait: Axes, motion: Motion, load: float) -> None:
    """Labels of the panels of a speed."""
    force.axhline(1e-3 * load, color=FAINT, lw=1.0, zorder=0)
    force.set_xlim(0.0, len(motion.paths))
    force.set_ylabel("mesh force [kN]")
    low, high = force.get_ylim()
    force.set_ylim(low, high + 0.2 * (high - low))
    force.legend(loc="upper right", ncols=2)
    note(force, f"{motion.speed:.0f} r/min")
    portrait.set_ylabel("ds/dt [mm/s]")


def _alike(one: Motion, other: Motion) -> bool:
    """Whether two motions are one."""
    if one.repeats != other.repeats or one.repeats == 0:
        return False
    first, second = one.over("force"), other.over("force")
    return bool(np.abs(first - second).max() <= ALIKE * np.abs(first).max())
