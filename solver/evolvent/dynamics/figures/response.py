"""Picture of a pair's vibration over the speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.body_sentences import body_bands
from evolvent.dynamics.results.response import BranchRow, DriveSummary, ResponseRow
from evolvent.results.drawing.style import FAINT, INK, PINION, WHEEL, foot, sheet
from evolvent_meshes.arrays import Floats

SUPERHARMONICS = (1, 2, 3, 4)
"""Divisors of the natural speed at which superharmonic resonances are marked."""
LEAST_SHARE, FAR_ABOVE = 5.0, 2.0
"""Least end of the axis of the time out of contact [%]; and largest amplitude of steady states, over that of the runs,
that the amplitude's axis shows."""
TITLE = "Vibration over the speed: running up, running down, and the steady states between"
ISO = "K_v of ISO 6336-1"
Panels = tuple[Axes, Axes, Axes]
"""Axes of amplitude, dynamic factor and time out of contact."""
MOST_FOLDS = 8
"""Speeds at which the branch turns back that the foot names."""
DOUBTED = 0.35
"""Opacity of curves where the bodies' own vibration makes motion and forces larger than computed."""
BODIES = "#d9a441"
"""Colour of speeds near the bodies' own vibration."""
NO_ISO = f"No {ISO}: it wants the deviations f_pb and f_fα of the gears."
BAND = (
    "Its error: estimated, of running up, by the mesh and by the spacing of positions; large beside a jump that moves "
    "with them."
)
"""Sentence at the foot of the picture where error bars are known."""


def response_figure(known: DriveSummary, rows: Sequence[ResponseRow], branch: Sequence[BranchRow]) -> Figure:
    """Equivalent amplitude, dynamic factor with that of ISO 6336-1, and separated share over the speed, up and down,
    and the unstable steady states between."""
    figure = sheet(
        TITLE,
        f"Natural speed {known.natural_speed_rpm:.0f} r/min, of {known.moving_mass_kg:.4g} kg on a mean "
        f"{_stiffness_name(known)} stiffness in motion of {known.moving_stiffness_N_per_um:.1f} N/µm, with "
        f"{known.bodies} gear bodies.",
        (11.0, 8.6),
    )
    panels = _panels(figure)
    _draw_runs(panels, rows, branch)
    up = [row for row in rows if row.way == "up"]
    if _has_iso(known):
        _draw_iso(panels[1], known, up)
    words = _finish(panels, known.natural_speed_rpm, rows, branch)
    limits = [*_draw_bodies(panels, known), *_draw_surface(panels[1], known, rows)]
    foot(
        figure,
        words,
        _folds(known, np.array([row.speed_rpm for row in up])),
        *limits,
        _iso_words(known),
        *([BAND] if any(np.isfinite(row.dynamic_factor_error) for row in up) else []),
    )
    return figure


def given_mesh_figure(
    natural_speed: float, words: str, rows: Sequence[ResponseRow], branch: Sequence[BranchRow]
) -> Figure:
    """Figure of an oscillator on a given mesh, as `response_figure`. natural_speed: [r/min]. words: subtitle."""
    figure = sheet(TITLE, words, (11.0, 8.6))
    panels = _panels(figure)
    _draw_runs(panels, rows, branch)
    foot(figure, _finish(panels, natural_speed, rows, branch))
    return figure


def _panels(figure: Figure) -> Panels:
    """Axes of amplitude, dynamic factor and time out of contact."""
    amplitude, factor, apart = figure.subplots(3, 1, sharex=True, height_ratios=(3.0, 2.0, 1.0))
    amplitude.set_ylabel("transmission error, equivalent\namplitude of 3 harmonics [µm]")
    factor.set_ylabel("largest mesh force\nover the static one")
    apart.set_ylabel("out of contact\n[% of the time]")
    apart.set_xlabel("speed of the pinion [r/min]")
    return amplitude, factor, apart


def _draw_runs(panels: Panels, rows: Sequence[ResponseRow], branch: Sequence[BranchRow]) -> None:
    """Draws the motions running up and down, with error bars where they are known, and all steady states."""
    for way, colour, style in (("up", PINION, "-"), ("down", WHEEL, "--")):
        runs = [row for row in rows if row.way == way]
        speeds = np.array([row.speed_rpm for row in runs])
        near = np.array([row.near_body_vibration for row in runs])
        columns = [(row.equivalent_amplitude_um, row.dynamic_factor, 100.0 * row.separated_share) for row in runs]
        for axes, values in zip(panels, np.array(columns).T):
            axes.plot(speeds, np.where(near, np.nan, values), style, color=colour, label=f"running {way}")
            if near.any():
                axes.plot(speeds, values, style, color=colour, alpha=DOUBTED, zorder=1.9)
            _mark_unrepeated(axes, speeds, values, runs)
        if way == "up":
            _draw_errors(panels[0], runs, "equivalent_amplitude_um")
            _draw_errors(panels[1], runs, "dynamic_factor")
    _draw_branch(panels[0], branch)


def _finish(
    panels: Panels, natural_speed: float, rows: Sequence[ResponseRow], branch: Sequence[BranchRow]
) -> str:
    """Marks the natural speed [r/min] and its parts, and sets the limits of the axes; returns the sentences on the
    marks."""
    amplitude, _, apart = panels
    first, last = (end(row.speed_rpm for row in rows) for end in (min, max))
    for axes in panels:
        for part in SUPERHARMONICS:
            axes.axvline(natural_speed / part, color=FAINT, lw=0.8, ls=":", zorder=0)
        axes.set_ylim(bottom=0.0)
    amplitude.set_xlim(first, last)
    beyond = _limit(amplitude, rows, [row for row in branch if first <= row.speed_rpm <= last])
    apart.set_ylim(top=max(LEAST_SHARE, apart.get_ylim()[1]))
    for part in SUPERHARMONICS:
        name = "natural" if part == 1 else f"1/{part}"
        amplitude.text(natural_speed / part, 0.995, f" {name}", va="top", color=INK, fontsize=8.0,
                       transform=amplitude.get_xaxis_transform(), clip_on=True)
    amplitude.legend(loc="upper right")
    alike = all(row.repeats == 1 for row in rows)
    hollow = "" if alike else " Hollow: a motion that does not repeat with every mesh."
    return "Dotted: the natural speed and its half, third and quarter." + hollow + beyond


def _stiffness_name(known: DriveSummary) -> str:
    """'secant' or 'tangent': the mesh stiffness whose mean the natural speed has."""
    return "secant" if known.mesh == "secant" else "tangent"


def _has_iso(known: DriveSummary) -> bool:
    """Whether K_v of ISO 6336-1 is known."""
    return None not in (known.iso_base_pitch_deviation_um, known.iso_profile_deviation_um)


def _limit(axes: Axes, rows: Sequence[ResponseRow], branch: Sequence[BranchRow]) -> str:
    """Keeps the axis to what is run up and down where steady states at other speeds, or at these, go on far above; a
    sentence where some of these do. branch: at the drawn speeds."""
    run = max(row.equivalent_amplitude_um for row in rows)
    highest = max((row.equivalent_amplitude_um for row in branch), default=0.0)
    if highest <= FAR_ABOVE * run:
        axes.set_ylim(top=min(axes.get_ylim()[1], 1.1 * max(run, highest)))
        return ""
    axes.set_ylim(top=1.2 * run)
    return f" Steady states that no run comes to go on to {highest:.3g} µm."


def _draw_errors(axes: Axes, rows: Sequence[ResponseRow], name: str) -> None:
    """Draws a band of the error around the values of running up; none where errors are not known. name: of the
    column."""
    speeds, values, errors = (np.array([getattr(row, each) for row in rows])
                              for each in ("speed_rpm", name, f"{name}_error"))
    if np.isfinite(errors).any():
        ends = values - errors, values + errors
        axes.fill_between(speeds, *ends, color=PINION, alpha=0.25, linewidth=0.0, zorder=1, label="its error")


def _draw_iso(axes: Axes, known: DriveSummary, rows: Sequence[ResponseRow]) -> None:
    """Draws K_v of ISO 6336-1, and the range of its main resonance."""
    speeds, factors = zip(*((row.speed_rpm, row.dynamic_factor_iso) for row in rows))
    axes.plot(speeds, factors, color=INK, lw=0.9, label=ISO)
    axes.axvspan(*known.iso_main_resonance_rpm, color=FAINT, alpha=0.12, lw=0.0, zorder=0)
    handles, labels = axes.get_legend_handles_labels()
    axes.legend([handles[labels.index(ISO)]], [ISO], loc="upper right")  # the panel above names the other curves


def _iso_words(known: DriveSummary) -> str:
    """Sentence on the deviations that the curve of ISO 6336-1 is for, or on the settings that it needs."""
    if not _has_iso(known):
        return NO_ISO
    return (
        f"{ISO}, Method B: for base pitch and profile deviations of {known.iso_base_pitch_deviation_um:.3g} and "
        f"{known.iso_profile_deviation_um:.3g} µm; shaded: its main resonance around "
        f"{known.iso_resonance_speed_rpm:.0f} r/min."
    )


def _folds(known: DriveSummary, speeds: Floats) -> str:
    """Sentence on the speeds (n,) drawn at which the branch of steady states turns back."""
    inside = sorted({f"{speed:.0f}" for speed in known.folds_rpm if speeds[0] <= speed <= speeds[-1]}, key=float)
    if not inside:
        return "No steady state turns back at these speeds."
    if len(inside) > MOST_FOLDS:
        return f"Steady states turn back at {len(inside)} of these speeds (folds_rpm)."
    return f"Steady states turn back at {', '.join(inside)} r/min."


def _draw_bodies(panels: Sequence[Axes], known: DriveSummary) -> list[str]:
    """Draws the speeds near the bodies' own vibration; returns a sentence where there are some."""
    first, last = panels[0].get_xlim()
    bands = [band for band in body_bands(known.first_body_speed_rpm) if band[1] < last and first < band[2]]
    for axes in panels:
        for _, low, high in bands:
            axes.axvspan(max(low, first), min(high, last), color=BODIES, alpha=0.18, lw=0.0, zorder=0)
    if not bands:
        return []
    return [
        "Ochre, and faint curves: mesh harmonics excite the bodies' own vibration, which is left out; motion and "
        "forces are larger there."
    ]


def _draw_surface(axes: Axes, known: DriveSummary, rows: Sequence[ResponseRow]) -> list[str]:
    """Draws the heaviest torque of the force surface where forces are beyond it; returns a sentence there."""
    share = known.heaviest_torque_share
    if share is None or share <= 1.0:
        return []
    heaviest = max(row.dynamic_factor for row in rows) / share
    axes.axhline(heaviest, color=INK, lw=0.9, ls="-.", zorder=1)
    axes.text(axes.get_xlim()[0], heaviest, " heaviest torque", va="bottom", color=INK, fontsize=8.0)
    return [
        f"Dash-dotted: a factor of {heaviest:.3g}, which the heaviest torque of the force surface has; beyond it the "
        "mesh force goes on straight. Heavier torques of the excitation reach further."
    ]


def _mark_unrepeated(axes: Axes, speeds: Floats, values: Floats, runs: Sequence[ResponseRow]) -> None:
    """Marks motions that do not repeat with every mesh."""
    other = [i for i, row in enumerate(runs) if row.repeats != 1]
    axes.plot(speeds[other], values[other], "o", markersize=4.0, markerfacecolor="white", color=INK)


def _draw_branch(axes: Axes, branch: Sequence[BranchRow]) -> None:
    """Draws all steady states, those that are not stable dotted; pieces that are not connected apart."""
    pieces = [i for i, row in enumerate(branch) if i and not row.connected]
    speed = np.insert([row.speed_rpm for row in branch], pieces, np.nan)
    size = np.insert([row.equivalent_amplitude_um for row in branch], pieces, np.nan)
    stable = np.insert([row.stable for row in branch], pieces, True)
    axes.plot(speed, np.where(stable, size, np.nan), color=FAINT, lw=3.0, alpha=0.5, zorder=1, label="all stable ones")
    if not stable.all():
        axes.plot(speed, np.where(stable, np.nan, size), ":", color=INK, lw=1.2, label="unstable ones")
