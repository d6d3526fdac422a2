"""Pictures of a pair's excitation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.results.drawing.style import INK, foot, png, sheet, styled, torque_colours
from evolvent_meshes.arrays import Floats


def excitation_picture(excitation: MeshExcitation, torques: Sequence[float]) -> bytes:
    """PNG of `excitation_figure`."""
    with styled():
        return png(excitation_figure(excitation, torques))


def excitation_figure(excitation: MeshExcitation, torques: Sequence[float]) -> Figure:
    """Transmission error and stiffness over the pitch under each torque, the force over the deflection, and the
    peak-to-peak transmission error over the torque. torques: (m,) [N·m], ascending."""
    loaded = excitation.loaded
    figure = sheet(
        "Excitation by the mesh: transmission error and mesh stiffness over a pitch, without friction",
        f"{len(torques)} torques from {torques[0]:.4g} to {torques[-1]:.4g} N·m{_least(excitation, torques)}.",
        (11.0, 7.6),
    )
    grid = figure.subplots(2, 2)
    colours = torque_colours(len(torques))
    phase = np.linspace(0.0, 1.0, len(loaded.angles) + 1)
    _over_pitch(grid[0, 0], phase, 1e3 * loaded.errors, colours, "transmission error [µm]")
    grid[0, 0].plot(phase, _closed(1e3 * excitation.unloaded_error), "--", color=INK, label="unloaded")
    grid[0, 0].legend(loc="best")
    _over_pitch(grid[0, 1], phase, 1e-3 * loaded.stiffness, colours, "tangent mesh stiffness [N/µm]")
    grid[0, 1].set_ylim(bottom=0.0)
    for i in range(0, len(loaded.angles), max(1, len(loaded.angles) // 4)):
        x, force = np.append(0.0, 1e3 * excitation.depths[i]), np.append(0.0, 1e-3 * loaded.forces)
        grid[1, 0].plot(x, force, marker=".", label=f"{phase[i]:.2g} pitch")
    grid[1, 0].set_xlabel("deflection beyond first contact [µm]")
    grid[1, 0].set_ylabel("mesh force [kN]")
    grid[1, 0].set_xlim(left=0.0)
    grid[1, 0].set_ylim(bottom=0.0)
    grid[1, 0].legend(loc="best")
    _draw_harris(grid[1, 1], excitation, torques, colours)
    foot(figure, "Colours of curves: the torques at lower right. Secant stiffness: excitation.csv; harmonics.csv.")
    return figure


def _least(excitation: MeshExcitation, torques: Sequence[float]) -> str:
    """Where the peak-to-peak transmission error is least, if at a torque between others."""
    size = 1e3 * np.ptp(excitation.loaded.errors, axis=0)
    least = int(np.argmin(size))
    if least in (0, len(size) - 1):
        return ""
    return f"; of these the peak-to-peak transmission error is least at {torques[least]:.4g} N·m, {size[least]:.3g} µm"


def _over_pitch(axes: Axes, phase: Floats, values: Floats, colours: Sequence[object], label: str) -> None:
    """Values (n, m) over the pitch, closed to its end, a curve for each torque."""
    for column, colour in zip(values.T, colours):
        axes.plot(phase, _closed(column), color=colour, marker=".", markersize=3.0)
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("pinion rotation [pitch]")
    axes.set_ylabel(label)


def _draw_harris(axes: Axes, excitation: MeshExcitation, torques: Sequence[float], colours: Sequence[object]) -> None:
    """Peak-to-peak transmission error over the torque, the unloaded one at 0."""
    size = 1e3 * np.ptp(excitation.loaded.errors, axis=0)
    axes.plot([0.0, *torques], [1e3 * np.ptp(excitation.unloaded_error), *size], color=INK, lw=1.0, zorder=1)
    axes.scatter(torques, size, 36.0, color=colours, zorder=3)
    axes.set_xlim(0.0, 1.05 * torques[-1])
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("torque [N·m]")
    axes.set_ylabel("peak-to-peak transmission error [µm]")


def _closed(values: Floats) -> Floats:
    """(n + 1,): the first value at the end again."""
    return np.append(values, values[0])
