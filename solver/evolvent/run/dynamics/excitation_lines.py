"""Sentences of `evolvent excitation` on its figures: last lines, and a warning where error bars are large."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from evolvent.dynamics.results.curves import LOADED, TANGENT
from evolvent.dynamics.results.design_load import EXCITATION_FACTS
from evolvent.dynamics.results.tables import HARMONICS, HarmonicRow
from evolvent.results.archive.error_bar_data import plus_minus

LARGE_BAR = 0.25
"""Ratio of error bar and peak-to-peak value above which it is warned of."""
NAMES = {LOADED: ("transmission error", "µm"), TANGENT: ("tangent stiffness", "N/µm")}
"""Quantity of harmonics.csv -> its name and unit in words."""


def excitation_lines(folder: Path) -> Iterator[str]:
    """Peak-to-peak transmission error and mean tangent stiffness under the lightest and the heaviest torque; in line
    contact K_Hβ and p_0 under the heaviest one."""
    rows = [row for row in HARMONICS.read(folder) if row.harmonic == 1]
    torques = [row.torque_Nm for row in rows if row.quantity == LOADED]
    for torque in dict.fromkeys((min(torques), max(torques))):
        error, stiffness = (_row(rows, quantity, torque) for quantity in (LOADED, TANGENT))
        yield (
            f"{error.case}, {torque:.4g} N·m: transmission error {_peak_to_peak(error)} µm peak to peak, tangent "
            f"stiffness {plus_minus(stiffness.mean, stiffness.mean_error, 1)} N/µm in the mean"
        )
    facts = EXCITATION_FACTS.read(folder)
    figures = (
        ("face load factor {}", facts.face_load_factor, facts.face_load_factor_error, 2),
        ("p_0 {} MPa away from edges and kinks", facts.largest_pressure_MPa, facts.largest_pressure_MPa_error, 0),
    )
    known = [
        words.format(plus_minus(value, error or math.nan, digits))
        for words, value, error, digits in figures if value is not None
    ]
    if known:
        yield f"{error.case}, {torque:.4g} N·m, line contact: {', '.join(known)}"


def large_bars(rows: Sequence[HarmonicRow]) -> Iterator[str]:
    """Warning of peak-to-peak values with an error bar above `LARGE_BAR` of them, under the heaviest such torque."""
    found = {}
    for row in rows:
        if row.harmonic == 1 and row.quantity in NAMES and row.peak_to_peak_error > LARGE_BAR * row.peak_to_peak:
            found[row.quantity] = row
    if found:
        words = ", ".join(
            f"{NAMES[row.quantity][0]} {_peak_to_peak(row)} {NAMES[row.quantity][1]} under {row.torque_Nm:.4g} N·m"
            for row in found.values()
        )
        yield (
            f"Peak-to-peak values whose error bar exceeds a quarter of them: {words}; more positions (sweep.positions) "
            "or a finer mesh (mesh.level) reduce it."
        )


def _row(rows: Sequence[HarmonicRow], quantity: str, torque: float) -> HarmonicRow:
    return next(row for row in rows if row.quantity == quantity and row.torque_Nm == torque)


def _peak_to_peak(row: HarmonicRow) -> str:
    return plus_minus(row.peak_to_peak, row.peak_to_peak_error, 2)
