"""Pictures of a pair's excitation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.results.curves import (
    LOADED,
    NO_COMPANION,
    TANGENT,
    CoarseExcitation,
    PitchCurve,
    pitch_curves,
    unloaded_curve,
)
from evolvent.dynamics.results.design_load import ExcitationFacts
from evolvent.results.drawing.style import INK, foot, png, sheet, styled, torque_colours
from evolvent_meshes.arrays import Floats

BARS = (
    "Bands: estimated error by the mesh, see excitation.csv; bars: of the peak-to-peak value, by the spacing of the "
    "positions, too."
)


def excitation_picture(
    excitation: MeshExcitation, facts: ExcitationFacts, companion: CoarseExcitation = NO_COMPANION
) -> bytes:
    """PNG of `excitation_figure`."""
    with styled():
        return png(excitation_figure(excitation, facts, companion))


def excitation_figure(
    excitation: MeshExcitation, facts: ExcitationFacts, companion: CoarseExcitation = NO_COMPANION
) -> Figure:
    """Transmission error and stiffness over the pitch under each torque, the force over the deflection, and the
    peak-to-peak transmission error over the torque, with error bars from the companion."""
    loaded, curves, torques = excitation.loaded, list(pitch_curves(excitation, companion)), facts.torques_Nm
    figure = sheet(
        "Excitation by the mesh: transmission error and mesh stiffness over a pitch, without friction",
        f"{facts.title}. Mesh {facts.mesh_level}, {facts.positions} positions, {len(torques)} torques from "
        f"{torques[0]:.4g} to {torques[-1]:.4g} N·m.{_design(facts)}",
        (11.0, 7.6),
    )
    grid = figure.subplots(2, 2)
    colours = torque_colours(len(torques))
    phase = np.linspace(0.0, 1.0, len(loaded.angles) + 1)
    _over_pitch(grid[0, 0], phase, [each[LOADED] for each in curves], colours, "transmission error [µm]")
    grid[0, 0].plot(phase, _closed(unloaded_curve(excitation).values), "--", color=INK, label="unloaded")
    grid[0, 0].legend(loc="best")
    _over_pitch(grid[0, 1], phase, [each[TANGENT] for each in curves], colours, "tangent mesh stiffness [N/µm]")
    grid[0, 1].set_ylim(bottom=0.0)
    _draw_force(grid[1, 0], excitation, phase)
    beside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "fontsize": 8.0, "title_fontsize": 8.0}
    grid[0, 1].legend(grid[0, 1].lines, [f"{torque:.4g}" for torque in torques], title="N·m", **beside)
    _draw_harris(grid[1, 1], [unloaded_curve(excitation), *(each[LOADED] for each in curves)], torques, colours)
    said = "Secant stiffness: excitation.csv; harmonics.csv."
    foot(figure, *([said] if companion.excitation is None else [said, BARS]))
    return figure


def _design(facts: ExcitationFacts) -> str:
    """Where the peak-to-peak transmission error is least, if at a torque between others."""
    if facts.design_torque_Nm is None:
        return ""
    bar = "" if facts.design_peak_to_peak_um_error is None else f" ± {facts.design_peak_to_peak_um_error:.2g}"
    known = ""
    if facts.design_from_Nm is not None:
        known = f" (within its error from {facts.design_from_Nm:.3g} to {facts.design_to_Nm:.3g} N·m)"
    least = f"{facts.design_peak_to_peak_um:.3g}{bar} µm"
    return f" Peak-to-peak transmission error least at {facts.design_torque_Nm:.3g} N·m{known}: {least}."


def _over_pitch(
    axes: Axes, phase: Floats, curves: Sequence[PitchCurve], colours: Sequence[object], label: str
) -> None:
    """Values over the pitch, closed to its end, a curve for each torque, in a band of its error."""
    for curve, colour in zip(curves, colours):
        values = _closed(curve.values)
        if curve.coarse is not None:
            bars = _closed(curve.bars)
            axes.fill_between(phase, values - bars, values + bars, color=colour, alpha=0.25, linewidth=0.0)
        axes.plot(phase, values, color=colour, marker=".", markersize=3.0)
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("pinion rotation [pitch]")
    axes.set_ylabel(label)


def _draw_force(axes: Axes, excitation: MeshExcitation, phase: Floats) -> None:
    """Force over the deflection, at four positions."""
    loaded = excitation.loaded
    for i in range(0, len(loaded.angles), max(1, len(loaded.angles) // 4)):
        x, force = np.append(0.0, 1e3 * excitation.depths[i]), np.append(0.0, 1e-3 * loaded.forces)
        axes.plot(x, force, marker=".", label=f"{phase[i]:.2g} pitch")
    axes.set_xlabel("deflection beyond first contact [µm]")
    axes.set_ylabel("mesh force [kN]")
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="best")


def _draw_harris(
    axes: Axes, curves: Sequence[PitchCurve], torques: Sequence[float], colours: Sequence[object]
) -> None:
    """Peak-to-peak transmission error over the torque. curves: unloaded, then under each torque."""
    size, bars = (np.array(each) for each in zip(*((np.ptp(c.values), c.peak_to_peak_error) for c in curves)))
    axes.plot([0.0, *torques], size, color=INK, lw=1.0, zorder=1)
    if np.isfinite(bars).all():
        axes.errorbar(torques, size[1:], bars[1:], linestyle="", color=INK, elinewidth=1.0, capsize=3.0, zorder=2)
    axes.scatter(torques, size[1:], 36.0, color=colours, zorder=3)
    axes.set_xlim(0.0, 1.05 * torques[-1])
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("torque [N·m]")
    axes.set_ylabel("peak-to-peak transmission error [µm]")


def _closed(values: Floats) -> Floats:
    """(n + 1,): the first value at the end again."""
    return np.append(values, values[0])
