"""Picture of the mesh force under which contact is computed."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from evolvent.dynamics.operating_point import Operation
from evolvent.dynamics.operation_figures import OperationFigures
from evolvent.results.drawing.style import FAINT, INK, PINION, WHEEL, foot, png, sheet, styled

FOOT = "Phase 0: a tooth pair touches at the pitch point."


def operation_picture(operation: Operation) -> bytes:
    """PNG of `operation_figure`."""
    with styled():
        return png(operation_figure(operation))


def operation_figure(operation: Operation) -> Figure:
    """Mesh force and transmission error over the mesh periods after which the motion repeats."""
    figures, count = OperationFigures.of(operation), len(operation.paths)
    figure = sheet(
        f"Mesh force and transmission error at {figures.speed_rpm:.5g} r/min",
        f"Natural speed {figures.natural_speed_rpm:.0f} r/min. Largest force {1e-3 * figures.largest_force_N:.3g} kN, "
        f"{figures.largest_force_N / figures.static_force_N:.2f} times the static one; out of contact for "
        f"{100 * figures.separated_share:.2g} % of the time.",
        (9.6, 6.6),
    )
    force, error = figure.subplots(2, 1, sharex=True)
    for ahead, path in enumerate(operation.paths):
        phase = path.phases + ahead
        force.plot(phase, 1e-3 * path.force, color=PINION, label="" if ahead else "vibrating")
        error.plot(phase, 1e3 * path.transmission_error, color=PINION, label="" if ahead else "vibrating")
    force.axhline(1e-3 * figures.static_force_N, color=WHEEL, ls="--", label="static")
    loaded, e = operation.excitation.loaded, operation.excitation.unloaded_error
    load = operation.drive.model.load
    number = int(np.argmin(np.abs(loaded.forces - load)))
    static = loaded.errors[:, number] + load / operation.drive.settings.series_stiffness
    phase = np.arange(count * len(e) + 1) / len(e)
    for values, colour, style, name in (
        (static, WHEEL, "--", "static"), (e, FAINT, "-", "unloaded"),
    ):
        error.plot(phase, 1e3 * np.append(np.tile(values, count), values[0]), style, color=colour, label=name)
    force.set_ylabel("mesh force [kN]")
    force.axhline(0.0, color=INK, lw=0.8, zorder=0)
    error.set_ylabel("transmission error [µm]")
    error.set_xlabel("phase [mesh periods]")
    error.set_xlim(0.0, count)
    for axes in (force, error):
        axes.legend(loc="best", ncols=3)
    lifted = (
        f" For {100 * figures.lifted_share:.2g} % of it contact is computed under a thousandth of the static force."
    )
    several = " The motion repeats after several meshes: operation.json, repeats." if count > 1 else ""
    foot(figure, FOOT + (lifted if figures.lifted_share else "") + several)
    return figure
