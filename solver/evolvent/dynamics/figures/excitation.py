"""Pictures of a pair's excitation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.results.curves import LOADED, UNLOADED
from evolvent.dynamics.results.design_load import ExcitationFacts
from evolvent.dynamics.results.tables import ExcitationRow, HarmonicRow
from evolvent.results.drawing.style import INK, foot, sheet, torque_colours
from evolvent_meshes.arrays import Floats

BARS = (
    "Bands: estimated error by the mesh; bars: of the peak-to-peak value, by the spacing of the "
    "positions, too."
)


@dataclass(frozen=True, eq=False)
class PitchColumns:
    """Columns of excitation.csv over n positions of a pitch, m torques."""

    phase: Floats
    """(n + 1,) phases from 0 to 1 [pitch]."""
    force: Floats
    """(m,) mesh forces [N]."""
    unloaded: Floats
    """(n,) unloaded transmission error [µm]."""
    error: Floats
    """(2, m, n) transmission error under each torque, and its error bar [µm]."""
    stiffness: Floats
    """(2, m, n) tangent stiffness, and its error bar [N/µm]."""

    @staticmethod
    def of(rows: Sequence[ExcitationRow]) -> PitchColumns:
        """Columns of rows that are ordered by torque and position."""
        torques = len({row.torque_Nm for row in rows})

        def over(name: str) -> Floats:
            return np.array([getattr(row, name) for row in rows]).reshape(torques, -1)

        def both(name: str) -> Floats:
            return np.array([over(name), over(f"{name}_error")])

        unloaded = over("unloaded_transmission_error_um")[0]
        return PitchColumns(
            phase=np.linspace(0.0, 1.0, len(unloaded) + 1),
            force=over("mesh_force_N")[:, 0],
            unloaded=unloaded,
            error=both("transmission_error_um"),
            stiffness=both("tangent_stiffness_N_per_um"),
        )


def excitation_figure(
    facts: ExcitationFacts, rows: Sequence[ExcitationRow], harmonics: Sequence[HarmonicRow]
) -> Figure:
    """Transmission error and stiffness over the pitch under each torque, the force over the deflection, and the
    peak-to-peak transmission error over the torque, with error bars where they are known."""
    pitch, torques = PitchColumns.of(rows), facts.torques_Nm
    solved = "Line contact" if facts.mesh_level == "line" else f"Mesh {facts.mesh_level}"
    figure = sheet(
        "Excitation by the mesh: transmission error and mesh stiffness over a pitch, without friction",
        f"{facts.title}. {solved}, {facts.positions} positions, {len(torques)} torques from "
        f"{torques[0]:.4g} to {torques[-1]:.4g} N·m.{_design(facts)}",
        (11.0, 7.6),
    )
    grid = figure.subplots(2, 2)
    colours = torque_colours(len(torques))
    _over_pitch(grid[0, 0], pitch.phase, pitch.error, colours, "transmission error [µm]")
    grid[0, 0].plot(pitch.phase, _closed(pitch.unloaded), "--", color=INK, label="unloaded")
    grid[0, 0].legend(loc="best")
    _over_pitch(grid[0, 1], pitch.phase, pitch.stiffness, colours, "tangent mesh stiffness [N/µm]")
    grid[0, 1].set_ylim(bottom=0.0)
    _draw_force(grid[1, 0], pitch)
    beside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "fontsize": 8.0, "title_fontsize": 8.0}
    grid[0, 1].legend(grid[0, 1].lines, [f"{torque:.4g}" for torque in torques], title="N·m", **beside)
    sizes = [row for row in harmonics if row.harmonic == 1 and row.quantity in (UNLOADED, LOADED)]
    _draw_harris(grid[1, 1], sizes, colours)
    said = "The secant stiffness and the mesh harmonics are in the tables."
    foot(figure, *([said, BARS] if np.isfinite(pitch.error[1]).all() else [said]))
    return figure


def _design(facts: ExcitationFacts) -> str:
    """Sentence on where the peak-to-peak transmission error is least, if at a torque between others; else empty."""
    if facts.design_torque_Nm is None:
        return ""
    bar = "" if facts.design_peak_to_peak_um_error is None else f" ± {facts.design_peak_to_peak_um_error:.2g}"
    known = ""
    if facts.design_from_Nm is not None:
        known = f" (within its error from {facts.design_from_Nm:.3g} to {facts.design_to_Nm:.3g} N·m)"
    least = f"{facts.design_peak_to_peak_um:.3g}{bar} µm"
    return f" Peak-to-peak transmission error least at {facts.design_torque_Nm:.3g} N·m{known}: {least}."


def _over_pitch(axes: Axes, phase: Floats, curves: Floats, colours: Sequence[object], label: str) -> None:
    """Values over the pitch, closed to its end, a curve for each torque, in a band of its error. curves: (2, m, n)
    values and errors."""
    for curve, error, colour in zip(*curves, colours):
        values, bars = _closed(curve), _closed(error)
        if np.isfinite(bars).all():
            axes.fill_between(phase, values - bars, values + bars, color=colour, alpha=0.25, linewidth=0.0)
        axes.plot(phase, values, color=colour, marker=".", markersize=3.0)
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("pinion rotation [pitch]")
    axes.set_ylabel(label)


def _draw_force(axes: Axes, pitch: PitchColumns) -> None:
    """Force over the deflection, at four positions."""
    for i in range(0, len(pitch.unloaded), max(1, len(pitch.unloaded) // 4)):
        x, force = np.append(0.0, pitch.error[0, :, i] - pitch.unloaded[i]), np.append(0.0, 1e-3 * pitch.force)
        axes.plot(x, force, marker=".", label=f"{pitch.phase[i]:.2g} pitch")
    axes.set_xlabel("deflection beyond first contact [µm]")
    axes.set_ylabel("mesh force [kN]")
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="best")


def _draw_harris(axes: Axes, rows: Sequence[HarmonicRow], colours: Sequence[object]) -> None:
    """Peak-to-peak transmission error over the torque. rows: unloaded, then under each torque."""
    columns = [(row.torque_Nm, row.peak_to_peak, row.peak_to_peak_error) for row in rows]
    torques, size, bars = np.array(columns).T
    axes.plot(torques, size, color=INK, lw=1.0, zorder=1)
    if np.isfinite(bars).all():
        axes.errorbar(torques[1:], size[1:], bars[1:], linestyle="", color=INK, elinewidth=1.0, capsize=3.0, zorder=2)
    axes.scatter(torques[1:], size[1:], 36.0, color=colours, zorder=3)
    axes.set_xlim(0.0, 1.05 * torques[-1])
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("torque [N·m]")
    axes.set_ylabel("peak-to-peak transmission error [µm]")


def _closed(values: Floats) -> Floats:
    """(n + 1,) values with the first one repeated at the end."""
    return np.append(values, values[0])
