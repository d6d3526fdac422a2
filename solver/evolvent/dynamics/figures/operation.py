"""Picture of the mesh force under which contact is computed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from evolvent.dynamics.operation_figures import OperationFacts
from evolvent.dynamics.results.histories import HistoryRow
from evolvent.dynamics.results.tables import ExcitationRow
from evolvent.results.drawing.style import FAINT, INK, PINION, WHEEL, foot, sheet

FOOT = "Phase 0: a tooth pair touches at the pitch point."


def operation_figure(
    figures: OperationFacts, motion: Sequence[HistoryRow], excitation: Sequence[ExcitationRow],
    series_stiffness: float | None,
) -> Figure:
    """Mesh force and transmission error over the mesh periods after which the motion repeats. series_stiffness: of what
    gives way beside the mesh [N/µm]; None where nothing does."""
    load, count = figures.static_force_N, round(motion[-1].phase)
    figure = sheet(
        f"Mesh force and transmission error at {figures.speed_rpm:.5g} r/min",
        f"Natural speed {figures.natural_speed_rpm:.0f} r/min, {figures.bodies} gear bodies. "
        f"Largest force {1e-3 * figures.largest_force_N:.3g} kN, {figures.largest_force_N / load:.2f} times the static "
        f"one; out of contact for {100 * figures.separated_share:.2g} % of the time.",
        (9.6, 6.6),
    )
    force, error = figure.subplots(2, 1, sharex=True)
    phase = [row.phase for row in motion]
    force.plot(phase, [1e-3 * row.force_N for row in motion], color=PINION, label="vibrating")
    error.plot(phase, [row.transmission_error_um for row in motion], color=PINION, label="vibrating")
    force.axhline(1e-3 * load, color=WHEEL, ls="--", label="static")
    nearest = min((row.mesh_force_N for row in excitation), key=lambda force: abs(force - load))
    pitch = [row for row in excitation if row.mesh_force_N == nearest]
    still = np.array([row.transmission_error_um for row in pitch]) + load / (series_stiffness or np.inf)
    unloaded = np.array([row.unloaded_transmission_error_um for row in pitch])
    phases = np.arange(count * len(pitch) + 1) / len(pitch)
    for values, colour, style, name in ((still, WHEEL, "--", "static"), (unloaded, FAINT, "-", "unloaded")):
        error.plot(phases, np.append(np.tile(values, count), values[0]), style, color=colour, label=name)
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
