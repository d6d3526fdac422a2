"""The figures of a run in a line per friction coefficient."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from evolvent.results.tables.headlines import headlines


def test_figures_stand_with_their_error_bars_and_unknown_ones_are_left_out(tmp_path: Path) -> None:
    """Two coefficients: one with error bars, which are rounded up, one without; what is null is not printed, nor is the
    face load factor of an even load."""
    figures = {"max_pressure_MPa": 1318.4, "transmission_error_peak_to_peak_um": 3.352, "loss_percent": 0.834,
               "face_load_factor": 1.2}
    bars = {"max_pressure_MPa": 88.2, "transmission_error_peak_to_peak_um": 0.104, "loss_percent": 0.0}
    rows = [
        {"friction": 0.1, **figures, "mesh_stiffness_N_per_mm_um": 12.61, "estimated_error": bars},
        {"friction": 0.0, **figures, "mesh_stiffness_N_per_mm_um": None, "estimated_error": None},
    ]
    (tmp_path / "summary.json").write_text(json.dumps({"frictions": rows}), encoding="utf-8")
    assert headlines(tmp_path / "summary.json") == [
        "μ = 0.1: largest pressure 1318 ± 89 MPa, transmission error 3.35 ± 0.11 µm peak to peak, "
        "mesh stiffness 12.6 N/(mm·µm), loss 0.83 %",
        "μ = 0: largest pressure 1318 MPa, transmission error 3.35 µm peak to peak, loss 0.83 %",
    ]


def test_pressure_over_the_start_of_a_relief_is_named_apart(tmp_path: Path) -> None:
    """A relieved spur pair: both pressures with their names, the one over the ideal kink as about so much."""
    figures = {"max_pressure_MPa": 1310.4, "kink_pressure_MPa": 1499.3, "loss_percent": 0.0}
    row = {"friction": 0.0, **figures, "estimated_error": {"max_pressure_MPa": 67.2}}
    (tmp_path / "summary.json").write_text(json.dumps({"frictions": [row]}), encoding="utf-8")
    assert headlines(tmp_path / "summary.json") == [
        "μ = 0: largest pressure away from relief starts 1310 ± 68 MPa, over the sharp start of a linear relief about "
        "1499 MPa, loss 0.00 %"
    ]


@pytest.mark.parametrize(("factor", "said"), [(1.31, True), (1.201, True), (1.2, False), (1.0, False), (None, False)])
def test_uneven_load_over_the_face_is_said(factor: float | None, said: bool, tmp_path: Path) -> None:
    """Above 1.2, which is 10 % more pressure than of an even load; not of a run of before the figure was there."""
    row = {"friction": 0.0, "loss_percent": 0.0, "estimated_error": {"face_load_factor": 0.014}}
    row |= {} if factor is None else {"face_load_factor": factor}
    (tmp_path / "summary.json").write_text(json.dumps({"frictions": [row]}), encoding="utf-8")
    (line,) = headlines(tmp_path / "summary.json")
    assert line == "μ = 0: loss 0.00 %" + (f", face load factor K_Hβ {factor:.2f} ± 0.02" if said else "")
