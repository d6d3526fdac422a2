"""Picture of a pitch from Python: transmission error, mesh stiffness and largest pressure over the rotation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from evolvent.results.drawing.style import INK, PINION, foot, sheet
from evolvent.results.solution.pitch_row import PitchRow

PANELS = (
    ("transmission_error_um", "transmission\nerror [µm]"), ("mesh_stiffness_N_per_um", "mesh stiffness\n[N/µm]"),
    ("max_pressure_MPa", "largest pressure\n[MPa]"),
)
"""Column of the rows, and label of its axis."""


def pitch_figure(rows: Sequence[PitchRow]) -> Figure:
    """Curves of a pitch, a panel each; the first position is repeated at the end. Positions at which a tooth bears on
    a tip edge are hollow."""
    angles = np.array([row.pinion_angle_deg for row in rows])
    closed = np.append(angles, angles[0] + len(angles) * (angles[1] - angles[0]))
    size = np.ptp([row.transmission_error_um for row in rows])
    figure = sheet(
        "A pitch of the gear pair",
        f"{len(rows)} positions at μ = {rows[0].friction:g}; transmission error {size:.3g} µm peak to peak.",
        (9.6, 7.0),
    )
    panels = figure.subplots(len(PANELS), 1, sharex=True)
    edges = np.array([row.tip_edge for row in rows])
    for axes, (name, label) in zip(panels, PANELS):
        values = np.array([getattr(row, name) for row in rows])
        axes.plot(closed, np.append(values, values[0]), color=PINION, marker=".")
        axes.plot(angles[edges], values[edges], "o", markersize=6.0, markerfacecolor="white", color=INK)
        axes.set_ylabel(label)
    panels[-1].set_xlabel("pinion rotation φ [°]")
    hollow = " Hollow: a tooth bears on a tip edge." if edges.any() else ""
    foot(figure, f"Pressure: between the tip-edge zones.{hollow}")
    return figure
