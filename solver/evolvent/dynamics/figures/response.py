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
from evolvent.dynamics.results.response_errors import VibrationErrors
from evolvent.gears.problem.iso_dynamic_factor import MethodB
from evolvent.results.drawing.style import FAINT, INK, PINION, WHEEL, foot, png, sheet, styled
from evolvent_meshes.arrays import Floats

SUPERHARMONICS = (1, 2, 3, 4)
"""Parts of the natural speed that are marked."""
LEAST_SHARE, FAR_ABOVE = 5.0, 2.0
"""End of the axis of time out of contact at the least [%]; steady states above the runs from which on the amplitude's
axis leaves them out, over the largest amplitude of the runs."""
ISO = "K_v of ISO 6336-1"
NO_ISO = f"No {ISO}: it wants dynamics.base_pitch_deviation_um and dynamics.profile_deviation_um."
BAND = (
    "Its error: estimated, of running up, by the mesh and by the spacing of positions; large beside a jump that moves "
    "with them."
)
"""Where error bars are known."""


def response_picture(
    drive: Drive, swept: SpeedSweep, found: dict[str, list[Response]], branch: Sequence[BranchRow], iso: MethodB,
    errors: VibrationErrors,
) -> bytes:
    """PNG of `response_figure`."""
    with styled():
        return png(response_figure(drive, swept, found, branch, iso, errors))


def response_figure(
    drive: Drive, swept: SpeedSweep, found: dict[str, list[Response]], branch: Sequence[BranchRow], iso: MethodB,
    errors: VibrationErrors,
) -> Figure:
    """Equivalent amplitude, dynamic factor with that of ISO 6336-1, and separated share over the speed, up and down,
    and the unstable steady states between."""
    speeds = np.array([speed_of(drive, float(period)) for period in swept.periods])
    figure = sheet(
        "Vibration over the speed: running up, running down, and the steady states between",
        f"Natural speed {drive.natural_speed:.0f} r/min at the mean {_kind(drive)} stiffness of "
        f"{1e-3 * drive.mean_stiffness:.1f} N/µm, with {_bodies(drive)} gear bodies{_folds(drive, swept)}.",
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
        if way == "up":
            _draw_errors(amplitude, speeds, figures[0], 1e3 * errors.amplitude[way])
            _draw_errors(factor, speeds, figures[1], errors.dynamic_factor[way])
    alike = all(run.repeats == 1 for run in (*swept.up, *swept.down))
    hollow = "" if alike else " Hollow: a motion that does not repeat with every mesh."
    _draw_branch(amplitude, branch)
    if iso.has_factor:
        _draw_iso(factor, speeds, iso)
    for axes in (amplitude, factor, apart):
        for part in SUPERHARMONICS:
            axes.axvline(drive.natural_speed / part, color=FAINT, lw=0.8, ls=":", zorder=0)
        axes.set_ylim(bottom=0.0)
    beyond = _limit(amplitude, found, branch)
    apart.set_ylim(top=max(LEAST_SHARE, apart.get_ylim()[1]))
    for part in SUPERHARMONICS:
        name = "natural" if part == 1 else f"1/{part}"
        amplitude.text(drive.natural_speed / part, 0.995, f" {name}", va="top", color=INK, fontsize=8.0,
                       transform=amplitude.get_xaxis_transform(), clip_on=True)
    amplitude.set_xlim(speeds[0], speeds[-1])
    amplitude.set_ylabel("transmission error, equivalent\namplitude of 3 harmonics [µm]")
    factor.set_ylabel("largest mesh force\nover the static one")
    apart.set_ylabel("out of contact\n[% of the time]")
    apart.set_xlabel("speed of the pinion [r/min]")
    amplitude.legend(loc="upper right")
    foot(
        figure,
        "Dotted: the natural speed and its half, third and quarter." + hollow + beyond,
        _iso_words(iso),
        *([BAND] if np.isfinite(errors.dynamic_factor["up"]).any() else []),
    )
    return figure


def _bodies(drive: Drive) -> str:
    return "rigid" if drive.settings.bodies is None else "elastic"


def _kind(drive: Drive) -> str:
    """Of the mean stiffness."""
    return "secant" if drive.settings.mesh == "secant" else "tangent"


def _limit(axes: Axes, found: dict[str, list[Response]], branch: Sequence[BranchRow]) -> str:
    """Keeps the axis to what is run up and down where steady states go on far above; a sentence where it does."""
    run = 1e3 * max(each.equivalent_amplitude for runs in found.values() for each in runs)
    highest = max(row.equivalent_amplitude_um for row in branch)
    if highest <= FAR_ABOVE * run:
        return ""
    axes.set_ylim(top=1.2 * run)
    return f" Steady states that no run comes to go on to {highest:.3g} µm: branch.csv."


def _draw_errors(axes: Axes, speeds: Floats, values: Sequence[float], errors: Floats) -> None:
    """A band around the values of running up (n,); none where the errors (n,) are not known."""
    if np.isfinite(errors).any():
        ends = np.asarray(values) - errors, np.asarray(values) + errors
        axes.fill_between(speeds, *ends, color=PINION, alpha=0.25, linewidth=0.0, zorder=1, label="its error")


def _draw_iso(axes: Axes, speeds: Floats, iso: MethodB) -> None:
    """K_v, and the range of its main resonance."""
    begin, end = (iso.resonance_speed * ratio for ratio in iso.main_resonance)
    fine = np.linspace(speeds[0], speeds[-1], 1000)
    axes.plot(fine, [iso.factor(float(speed)) for speed in fine], color=INK, lw=0.9, label=ISO)
    axes.axvspan(begin, end, color=FAINT, alpha=0.12, lw=0.0, zorder=0)
    handles, labels = axes.get_legend_handles_labels()
    axes.legend([handles[labels.index(ISO)]], [ISO], loc="upper right")  # the panel above names the other curves


def _iso_words(iso: MethodB) -> str:
    """What the curve of ISO 6336-1 is for, or what it wants."""
    if not iso.has_factor:
        return NO_ISO
    return (
        f"{ISO}, Method B: for base pitch and profile deviations of {iso.accuracy.base_pitch_deviation:.3g} and "
        f"{iso.accuracy.profile_deviation:.3g} µm; shaded: its main resonance around {iso.resonance_speed:.0f} r/min."
    )


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
