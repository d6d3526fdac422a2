"""Picture of a pair's vibration over the speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.oscillator.response import Response
from evolvent.dynamics.oscillator.speed_sweep import Running, SpeedSweep
from evolvent.dynamics.pair_model import Drive
from evolvent.dynamics.results.response import BranchRow, speed_of
from evolvent.results.drawing.style import FAINT, INK, PINION, WHEEL, foot, png, sheet, styled
from evolvent_meshes.arrays import Floats

FAR_ABOVE = 2.5
"""Over the largest amplitude of a run, where the picture ends."""
SUPERHARMONICS = (1, 2, 3, 4)
"""Parts of the natural speed that are marked."""


def response_picture(
    drive: Drive, swept: SpeedSweep, found: dict[str, list[Response]], branch: Sequence[BranchRow]
) -> bytes:
    """PNG of `response_figure`."""
    with styled():
        return png(response_figure(drive, swept, found, branch))


def response_figure(
    drive: Drive, swept: SpeedSweep, found: dict[str, list[Response]], branch: Sequence[BranchRow]
) -> Figure:
    """Equivalent amplitude, dynamic factor and separated share over the speed, up and down, and the unstable steady
    states between."""
    speeds = np.array([speed_of(drive, float(period)) for period in swept.periods])
    figure = sheet(
        "Vibration over the speed: running up, running down, and the steady states between",
        f"Natural speed {drive.natural_speed:.0f} r/min at the mean tangent stiffness of "
        f"{1e-3 * drive.mean_stiffness:.1f} N/µm{_folds(drive, swept)}.",
        (11.0, 8.6),
    )
    amplitude, factor, apart = figure.subplots(3, 1, sharex=True, height_ratios=(3.0, 2.0, 1.0))
    for way, colour, style in (("up", PINION, "-"), ("down", WHEEL, "--")):
        runs = swept.up if way == "up" else swept.down
        figures = (
            [1e3 * each.equivalent_amplitude for each in found[way]],
            [each.largest_force / drive.model.load for each in found[way]],
            [100.0 * each.apart for each in found[way]],
        )
        for axes, values in zip((amplitude, factor, apart), figures):
            axes.plot(speeds, values, style, color=colour, label=f"running {way}")
            _mark_unrepeated(axes, speeds, values, runs)
    _draw_branch(amplitude, branch)
    for axes in (amplitude, factor, apart):
        for part in SUPERHARMONICS:
            axes.axvline(drive.natural_speed / part, color=FAINT, lw=0.8, ls=":", zorder=0)
        axes.set_ylim(bottom=0.0)
    beyond = _keep_to_runs(amplitude, swept, found, branch)
    amplitude.set_xlim(speeds[0], speeds[-1])
    amplitude.set_ylabel("transmission error, equivalent\namplitude of 3 harmonics [µm]")
    factor.set_ylabel("largest mesh force over\nthe static one (not K_v)")
    apart.set_ylabel("out of contact\n[% of the time]")
    apart.set_xlabel("speed of the pinion [r/min]")
    amplitude.legend(loc="upper left")
    foot(
        figure,
        "Dotted: the natural speed and its half, third and quarter. Hollow: a motion that does not repeat with every "
        f"mesh.{beyond}",
    )
    return figure


def _keep_to_runs(
    axes: Axes, swept: SpeedSweep, found: dict[str, list[Response]], branch: Sequence[BranchRow]
) -> str:  # fmt: skip
    """Leaves out steady states far beyond all motions that runs come to. Returns a sentence on them."""
    largest = max(
        (each.equivalent_amplitude for way, runs in (("up", swept.up), ("down", swept.down))
         for run, each in zip(runs, found[way]) if not run.escaped),
        default=0.0,
    )  # fmt: skip
    highest = max(row.equivalent_amplitude_um for row in branch)
    if highest < FAR_ABOVE * 1e3 * largest or not largest:
        return ""
    axes.set_ylim(top=FAR_ABOVE * 1e3 * largest)
    return f" Steady states go on to {highest:.3g} µm."


def _folds(drive: Drive, swept: SpeedSweep) -> str:
    """Where the branch turns back."""
    speeds = sorted({f"{speed_of(drive, swept.branch.points[i].period):.0f}" for i in swept.branch.folds}, key=float)
    return f"; steady states turn back at {', '.join(speeds)} r/min" if speeds else "; no steady state turns back"


def _mark_unrepeated(axes: Axes, speeds: Floats, values: Sequence[float], runs: Sequence[Running]) -> None:
    """Motions that do not repeat with every mesh."""
    other = [i for i, run in enumerate(runs) if run.repeats != 1]
    axes.plot(speeds[other], np.asarray(values)[other], "o", markersize=4.0, markerfacecolor="white", color=INK)


def _draw_branch(axes: Axes, branch: Sequence[BranchRow]) -> None:
    """All steady states, those that are not stable dotted; pieces that are not connected apart."""
    pieces = [i for i, row in enumerate(branch) if i and not row.connected]
    speed = np.insert([row.speed_rpm for row in branch], pieces, np.nan)
    size = np.insert([row.equivalent_amplitude_um for row in branch], pieces, np.nan)
    stable = np.insert([row.stable for row in branch], pieces, True)
    axes.plot(speed, np.where(stable, size, np.nan), color=FAINT, lw=3.0, alpha=0.5, zorder=1, label="all stable ones")
    if not stable.all():
        axes.plot(speed, np.where(stable, np.nan, size), ":", color=INK, lw=1.2, label="unstable ones")
