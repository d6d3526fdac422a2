"""Picture of a gear pair's start from rest: mesh force, transmission error and largest pressure over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.figures.transient import BAND, BANDS, STATIC, Colour
from evolvent.dynamics.results.transient.beginning import StartRow
from evolvent.results.drawing.style import foot, friction_colours, note, sheet

LONG = 5
"""Number of friction coefficients from which on the legend has two columns."""
UNKNOWN = float("nan")
ROOM = 0.15
"""Free height above the curves, over the height of a panel."""
SUBTITLE = (
    "The flanks touch at t = 0: one gear at its speed at once, the other one at rest under its torque. Dashed: without "
    "inertia."
)


def start_figure(title: str, rows: Sequence[StartRow]) -> Figure:
    """Mesh force, transmission error and largest pressure over time from rest, a line of panels for each speed."""
    speeds = sorted({row.speed_rpm for row in rows})
    frictions = sorted({row.friction for row in rows})
    figure = sheet(f"{title}: start from rest", SUBTITLE, (12.0, 1.4 + 2.8 * len(speeds)))
    grid = figure.subplots(len(speeds), 3, squeeze=False)
    banded = len(frictions) <= BANDS and any(np.isfinite(row.mesh_force_N_error) for row in rows)
    for panels, speed in zip(grid, speeds):
        for friction, colour in zip(frictions, friction_colours(frictions)):
            own = [row for row in rows if (row.speed_rpm, row.friction) == (speed, friction)]
            _draw(panels, own, colour, f"μ = {friction:g}", banded)
        for axes, name in zip(panels, ("mesh force over the load", "transmission error [µm]", "peak pressure [MPa]")):
            axes.set_ylabel(name)
            note(axes, f"{speed:g} r/min")
            low, high = axes.get_ylim()
            axes.set_ylim(low if axes is panels[1] else 0.0, high + ROOM * (high - low))
    for axes in grid[-1]:
        axes.set_xlabel("time [ms]")
    grid[0][0].legend(loc="upper right", ncols=1 if len(frictions) < LONG else 2)
    foot(
        figure,
        "Pressure: largest of the fitted half-ellipses along the contact line, between the tip-edge zones; gaps where "
        "flanks are apart." + (" Bands: error bars." if banded else ""),
    )
    return figure


def _draw(panels: Sequence[Axes], rows: Sequence[StartRow], colour: Colour, label: str, banded: bool) -> None:
    """Draws the curves of a case."""
    time = 1e3 * np.array([0.0, *(row.time_s for row in rows)])
    curves = (
        (0.0, [(row.mesh_force_N / row.load_N, row.mesh_force_N_error / row.load_N, 1.0) for row in rows]),
        (UNKNOWN, [
            (row.transmission_error_um, row.transmission_error_um_error, row.static_transmission_error_um)
            for row in rows
        ]),
        (UNKNOWN, [(row.max_pressure_MPa, row.max_pressure_MPa_error, row.static_max_pressure_MPa) for row in rows]),
    )
    for axes, (begin, columns) in zip(panels, curves):
        value, bar, still = np.array([(begin, UNKNOWN, UNKNOWN), *columns]).T
        if banded:
            axes.fill_between(time, value - bar, value + bar, color=colour, alpha=BAND, lw=0.0)
        axes.plot(time, value, color=colour, label=label)
        axes.plot(time, still, color=colour, **STATIC)
        axes.set_xlim(0.0, time[-1])
