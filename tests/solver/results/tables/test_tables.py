"""The tables of a run."""

from __future__ import annotations

import csv
import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.run_data import RunData, read_run
from evolvent.results.tables.figure_rows import degrees, friction_rows, position_rows
from evolvent.results.tables.table import cell_text, csv_text
from evolvent.results.tables.tables import summary, write_tables
from tests.support.run_parts import FACTS, store
from tests.support.synthetic_run import PEAK_TO_PEAK, STIFFNESS, synthetic_run

KEYS = {"scene", "versions", "ranks", "dofs", "cells", "mesh", "skipped", "timings_s", "peak_memory_MB", "positions"}
POSITION_KEYS = {
    "pinion_angle_deg", "friction", "torque_pinion_Nm", "torque_gear_Nm", "transmission_error_um", "max_pressure_MPa",
    "teeth", "newton_iterations", "balance_error", "seconds",
}


@pytest.fixture(scope="module")
def run() -> RunData:
    return synthetic_run("contact.friction=[0.0, 0.1]")


def test_summary_has_the_promised_keys(run: RunData) -> None:
    """Every key that users and later tools rely on is there, for every position and friction coefficient."""
    found = json.loads(json.dumps(asdict(summary(run, FACTS))))
    assert set(found) >= KEYS
    assert set(found["timings_s"]) >= {"mesh", "assemble", "factor", "positions", "output", "total"}
    assert len(found["positions"]) == 2 * 6
    for row in found["positions"]:
        assert set(row) >= POSITION_KEYS
        assert all(set(t) >= {"force_N", "max_pressure_MPa", "contact_length_mm"} for t in row["teeth"])


def test_position_rows_have_units_and_balance(run: RunData) -> None:
    """Problem: 250 N·m held on the pinion, frictionless and μ = 0.1. Exact: T_1 = 250 N·m; T_2 = 250·60/17 N·m
    without friction and u(T_1 − loss) with it; transmission error 20 µm ± 0.8 µm as made up; the forces sum to
    T_1/(r_b1 cos β_b)."""
    for row in position_rows(run):
        assert row.torque_pinion_Nm == pytest.approx(250.0)
        kept = 1.0 - 0.01 * row.loss_percent
        assert row.torque_gear_Nm == pytest.approx(250.0 * 60 / 17 * kept, rel=1e-12)
        assert row.loss_percent == 0.0 or row.friction > 0.0
        assert 19.19 < row.transmission_error_um < 20.81
    smooth = [row for row in position_rows(run) if row.friction == 0.0]
    pinion = run.pair.pinion
    force = 250e3 / (pinion.base_radius * np.cos(pinion.base_helix_angle))
    assert force == pytest.approx(14685.0, abs=1.0)
    sums = [sum(t.force_N for t in row.teeth) for row in smooth]
    np.testing.assert_allclose(sums, force, rtol=0.04)  # four node intervals across the contact
    assert np.mean(sums) == pytest.approx(force, rel=0.01)


def test_contact_lengths_sum_to_the_contact_lines(run: RunData) -> None:
    """Exact: the teeth's contact lengths sum to the length of all contact lines, to a layer (1.06 mm) a line end."""
    for row in position_rows(run):
        exact = run.pair.contact_line_length(np.radians(row.pinion_angle_deg))
        assert sum(t.contact_length_mm for t in row.teeth) == pytest.approx(exact, abs=1.2 * len(row.teeth))


def test_friction_rows_have_the_figures_of_a_pitch(run: RunData) -> None:
    """Exact: peak to peak 1.6 µm as made up; loss 0 without friction; no crossing with the curve itself."""
    smooth, rough = friction_rows(run)
    assert smooth.transmission_error_peak_to_peak_um == pytest.approx(1e3 * PEAK_TO_PEAK, rel=1e-9)
    assert smooth.loss_percent == 0.0
    assert rough.loss_percent > 1.0
    assert np.isnan(smooth.crossing_deg)


def test_stiffness_is_per_face_width(run: RunData) -> None:
    """Exact: tangents of 3e5 N/mm as made up, over a face of 16.9 mm, in 2D per mm already; the secant T_1/(r_b1 b)
    over the mean of 1/error."""
    wanted = 1e-3 * STIFFNESS / 16.9
    assert friction_rows(run)[0].mesh_stiffness_N_per_mm_um == pytest.approx(wanted)
    assert position_rows(run)[0].mesh_stiffness_N_per_mm_um == pytest.approx(wanted)
    plane = synthetic_run(file="demos/he2022.toml")
    assert friction_rows(plane)[0].mesh_stiffness_N_per_mm_um == pytest.approx(1e-3 * STIFFNESS / 20.0)
    errors = [row.transmission_error_um for row in position_rows(plane)]
    wanted = 170e3 / plane.pair.pinion.base_radius / 20.0 * np.mean(1.0 / np.array(errors))
    assert friction_rows(plane)[0].secant_stiffness_N_per_mm_um == pytest.approx(wanted)


def test_missing_material_is_no_deflection(tmp_path: Path) -> None:
    """Problem: He's pair whose pinion lacks 2 µm everywhere by a chart, with transmission errors made up. Exact: the
    secant is the force over what is beyond these 2 µm, as in excitation.csv, in rows of positions and of the pitch."""
    chart = tmp_path / "worn.csv"
    chart.write_text("diameter_mm,depth_um\n" + "".join(f"{diameter},2.0\n" for diameter in (120.0, 150.0, 170.0)))
    charted = synthetic_run(f"pinion.flank_csv={chart}", file="demos/he2022.toml")
    rows, force = position_rows(charted), 170e3 / charted.pair.pinion.base_radius / 20.0
    wanted = [force / (row.transmission_error_um - 2.0) for row in rows]
    assert [row.secant_stiffness_N_per_mm_um for row in rows] == pytest.approx(wanted, rel=1e-9)
    assert friction_rows(charted)[0].secant_stiffness_N_per_mm_um == pytest.approx(np.mean(wanted))


def test_plane_run_is_reported_for_the_whole_width() -> None:
    """Problem: He's spur pair, solved in 2D per mm of width. Exact: 170 N·m on the pinion, F = T/r_b = 2412.1 N over
    all teeth, contact length 20 mm a tooth."""
    plane = synthetic_run(file="demos/he2022.toml")
    assert plane.plane
    rows = position_rows(plane)
    for row in rows:
        assert row.torque_pinion_Nm == pytest.approx(170.0)
        assert all(t.contact_length_mm == pytest.approx(20.0) for t in row.teeth)
    mean = np.mean([sum(t.force_N for t in row.teeth) for row in rows])
    assert mean == pytest.approx(2412.1, rel=0.03)  # four node intervals across the contact, no rows to average over


def test_written_tables_have_a_line_a_row_and_strict_json(run: RunData, tmp_path: Path) -> None:
    """One line a position and friction in positions.csv, one more level down in teeth.csv; strict JSON (no NaN); no
    half-written file stays behind."""
    write_tables(RunFolder(tmp_path), summary(run, FACTS))
    with open(tmp_path / "positions.csv", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    with open(tmp_path / "teeth.csv", encoding="utf-8") as stream:
        teeth = list(csv.DictReader(stream))
    assert len(rows) == 12
    assert len(teeth) == sum(int(row["teeth_in_contact"]) for row in rows)
    assert float(rows[0]["torque_pinion_Nm"]) == pytest.approx(250.0)

    def refuse(text: str) -> float:
        raise AssertionError(f"{text} is no JSON")

    text = (tmp_path / "summary.json").read_text(encoding="utf-8")
    assert json.loads(text, parse_constant=refuse)["frictions"][0]["crossing_deg"] is None
    assert not list(tmp_path.glob("*.tmp"))


def test_run_is_read_as_archived(run: RunData, tmp_path: Path) -> None:
    """Exact: what `read_run` reads equals what was archived, number by number."""
    store(run, tmp_path)
    again = read_run(tmp_path)
    assert repr(position_rows(again)) == repr(position_rows(run))  # repr is exact, and NaN equals NaN in it
    np.testing.assert_array_equal(again.flank.points, run.flank.points)


def test_angles_in_degrees_have_no_round_off(tmp_path: Path) -> None:
    """Problem: a pinion of 17 teeth at six positions, whose steps are 60/17°, in radians and back again. Exact: no
    angle has more than six decimals in summary.json, and each is within half of the last one; of a pinion of 24 teeth
    with 20 positions they are multiples of 0.75 as they stand."""
    run = synthetic_run("contact.friction=[0.0, 0.1]")
    write_tables(RunFolder(tmp_path), summary(run, FACTS))
    found = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    angles = [row["pinion_angle_deg"] for row in found["positions"]]
    angles += [row["max_pressure_angle_deg"] for row in found["frictions"]]
    assert all(len(repr(angle).partition(".")[2]) <= 6 for angle in angles)
    np.testing.assert_allclose(angles[:12:2], np.arange(6) * 60 / 17, atol=5.1e-7)
    assert [degrees(k * 2.0 * np.pi / 24 / 20) for k in range(-20, 20)] == [0.75 * k for k in range(-20, 20)]


@pytest.mark.parametrize(
    "text", ["=1+1", '=HYPERLINK("http://a.b","c, d")', "+A1", "-A1", "@SUM(A1)", "\tx", "'=quoted", "'", "''", "=a\nb"]
)
def test_texts_are_no_formulas(text: str) -> None:
    """A title or reason that begins as a spreadsheet's formula does: the cell begins with an apostrophe, so that
    nothing is computed from it, and reading it back gives the text."""
    [row] = csv.DictReader(csv_text([{"title": text, "value": 1.0}]).splitlines(keepends=True))
    assert row["title"].startswith("'") and cell_text(row["title"]) == text and row["value"] == "1"


@pytest.mark.parametrize("value", [-1.5, -2, "-1.5", "+3e5", "nan", "up", "[-1, 2]", "a=b", ""])
def test_numbers_and_plain_texts_are_written_as_they_are(value: object) -> None:
    """Negative numbers, and texts that are no formulas, are not touched."""
    [row] = csv.DictReader(csv_text([{"cell": value, "other": 1}]).splitlines())
    assert row["cell"] == str(value) == cell_text(row["cell"])
