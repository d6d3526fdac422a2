"""Picture of the effect of wear on the vibration of a pair, over its cycles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.dynamics.operation_figures import VibrationRow
from evolvent.results.drawing.style import FAINT, PINION, WHEEL, foot, sheet
from evolvent.scene.plain_text import cycles_label
from evolvent_meshes.arrays import Floats


def vibration_over_cycles(rows: Sequence[VibrationRow], speed: float, torque: str) -> Figure:
    """Transmission errors, mesh force and natural speed after each block. speed: of the pinion [r/min]; torque: the
    static one, in words."""
    first, last = rows[0], rows[-1]
    figure = sheet(
        f"Vibration at {speed:.4g} r/min under {torque}, as the pair wears",
        f"Largest mesh force {1e-3 * first.largest_force_N:.2f} kN unworn, {1e-3 * last.largest_force_N:.2f} kN after "
        f"{cycles_label(last.cycles)} cycles, {1e-3 * min(row.largest_force_N for row in rows):.2f} kN at the least.",
        (10.0, 8.4),
    )
    error, force, natural = figure.subplots(3, 1, sharex=True, height_ratios=(3.0, 3.0, 1.6))
    for name, label, style in (
        ("unloaded_peak_to_peak_um", "unloaded, peak to peak", {"color": FAINT, "linestyle": "--"}),
        ("static_peak_to_peak_um", "under the static torque, peak to peak", {"color": WHEEL}),
        ("equivalent_amplitude_um", "vibrating, equivalent amplitude of 3 harmonics", {"color": PINION}),
    ):
        _over_cycles(error, rows, name, label, style)
    error.set_ylabel("transmission error [µm]")
    for name, label in (("largest_force_N", "largest"), ("smallest_force_N", "smallest")):
        _over_cycles(force, rows, name, label, {"color": PINION if label == "largest" else WHEEL}, 1e-3)
    _mark_separation(force, rows)
    force.set_ylabel("mesh force [kN]")
    _over_cycles(natural, rows, "natural_speed_rpm", "natural speed", {"color": PINION})
    natural.set_ylabel("natural speed\n[r/min]")
    natural.set_xlabel("revolutions of the pinion")
    natural.xaxis.set_major_formatter(lambda cycles, _: cycles_label(cycles))
    for axes in (error, force):
        axes.set_ylim(bottom=0.0)
        axes.legend(loc="best")
    natural.set_xlim(0.0, last.cycles)
    foot(
        figure,
        "A dot a block of cycles. Hollow: flanks part for some time. Natural speed: at the mean tangent stiffness",
        "of the positions, which falls in steps, where a tooth pair does not reach a position any more.",
    )
    return figure


def _over_cycles(
    axes: Axes, rows: Sequence[VibrationRow], name: str, label: str, style: dict[str, str], unit: float = 1.0
) -> None:
    cycles, values = _column(rows, "cycles"), unit * _column(rows, name)
    axes.plot(cycles, values, marker=".", label=label, **style)  # type: ignore[arg-type]  # the stubs have no kwargs


def _mark_separation(axes: Axes, rows: Sequence[VibrationRow]) -> None:
    apart = [row for row in rows if row.separated_share > 0.0]
    cycles, values = _column(apart, "cycles"), 1e-3 * _column(apart, "largest_force_N")
    axes.plot(cycles, values, "o", markerfacecolor="white", color=PINION, markersize=5.0)


def _column(rows: Sequence[VibrationRow], name: str) -> Floats:
    return np.array([getattr(row, name) for row in rows], dtype=float)
