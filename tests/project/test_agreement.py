"""The comparison of two installations notices what it is for, at the size it is for."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from demos.two_blocks import Patch
from evolvent import Step, solve
from evolvent.results.archive.store import arrays_bytes, read_arrays
from evolvent_meshes.files import write_bytes
from tests.agreement import TOLERANCE, differences, keep, main

Change = Callable[[dict[str, Any], dict[str, Any]], None]


def write(folder: Path, change: Change | None = None) -> Path:
    """A run of two positions, changed."""
    teeth = [{"tooth": 0, "force_N": 2000.0, "max_pressure_MPa": 450.0, "contact_length_mm": 20.0}]
    rows = [{"torque_gear_Nm": t, "tip_edge": False, "seconds": t, "teeth": teeth} for t in (170.0, 1e-3)]
    table = {"versions": {"dolfinx": str(folder)}, "positions": rows, "frictions": [{"crossing_deg": None}]}
    arrays = {"0/contact/traction": np.array([[450.0, 1.0], [0.0, 0.0]]), "0/tooth": np.array([0, 0]), "seconds": 3.0}
    if change is not None:
        change(rows[1], arrays)
    (folder / "results").mkdir(parents=True)
    write_bytes(folder / "results" / "position_0000.npz", arrays_bytes(arrays))
    (folder / "summary.json").write_text(json.dumps(table), encoding="utf-8")
    return folder


def scaled(row: dict[str, Any], arrays: dict[str, Any], by: float) -> None:
    row["torque_gear_Nm"] *= by
    arrays["0/contact/traction"][0] *= by


@pytest.mark.parametrize("part", [0.0, 0.5])
def test_agreement(part: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exact: equal runs, and runs that differ by half the tolerance, status 0; the clock and versions do not count."""
    one = write(tmp_path / "one")
    other = write(tmp_path / "other", lambda row, arrays: scaled(row, arrays, 1.0 + part * TOLERANCE))
    assert main(["compare", str(one), str(other)]) == 0
    largest = {d.quantity: d.size for d in differences(one, other)}
    assert largest["positions/torque_gear_Nm"] == pytest.approx(part * TOLERANCE, rel=1e-3)
    assert largest["contact/traction"] == pytest.approx(part * TOLERANCE, rel=1e-3)
    assert not any("seconds" in name or "versions" in name for name in largest)
    assert "agree: the largest relative difference is" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "quantity"),
    [
        (lambda row, arrays: row.update(torque_gear_Nm=1e-3 * (1.0 + 2e-6)), "positions/torque_gear_Nm"),
        (lambda row, arrays: row.update(torque_gear_Nm=None), "positions/torque_gear_Nm"),
        (lambda row, arrays: row.update(tip_edge=True), "positions/tip_edge"),
        (lambda row, arrays: row.update(teeth=[]), "positions/teeth/force_N"),
        (lambda row, arrays: scaled(row, arrays, 1.0 + 2e-6), "contact/traction"),
        (lambda row, arrays: arrays.update({"0/contact/traction": np.zeros((3, 2))}), "contact/traction"),
        (lambda row, arrays: arrays.update({"0/tooth": np.array([0, 1])}), "tooth"),
        (lambda row, arrays: arrays.pop("0/tooth"), "tooth"),
    ],
)
def test_disagreement(change: Change, quantity: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exact: one changed figure, also a small one among large ones, an array, a flag, a shape, something missing:
    status 1, and the message names the quantity."""
    one, other = write(tmp_path / "one"), write(tmp_path / "other", change)
    for pair in ((one, other), (other, one)):
        assert main(["compare", *map(str, pair)]) == 1
        message = capsys.readouterr().err
        assert "disagree: wanted relative differences of at most 1e-06, found more in" in message
        assert f" {quantity}" in message


def test_nothing_to_compare(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder without results is bad input, not agreement: status 2 and what to do."""
    one = write(tmp_path / "one")
    with pytest.raises(SystemExit, match="2"):
        main(["compare", str(one), str(tmp_path / "nothing")])
    assert "found none; compute it first" in capsys.readouterr().err


def test_kept_solution(tmp_path: Path) -> None:
    """Exact: a block of 2 mm under 100 MPa presses with 200 N/mm; all is linear in the load, so one part in a hundred
    thousand more shows as 1e-5 in everything that is kept."""
    problem = Patch("quadrilateral", 1).problem()
    for name, load in (("one", 1.0), ("other", 1.0 + 1e-5)):
        keep(tmp_path / name / "patch.npz", solve(problem, Step(load=load)))
    np.testing.assert_allclose(np.abs(read_arrays(tmp_path / "one" / "patch.npz")["force"]), [0.0, 200.0], atol=1e-8)
    found = {d.quantity: d.size for d in differences(tmp_path / "one", tmp_path / "other")}
    kept = ("force", "point_traction", "displacement", "nodal_forces")
    assert found == pytest.approx(dict.fromkeys(kept, 1e-5), rel=1e-3)


def test_a_tolerance_is_asked_for(tmp_path: Path) -> None:
    """Results that differ by 1e-8 agree within the usual tolerance and not within 1e-12."""
    one, other = (tmp_path / name for name in ("one", "other"))
    for folder, value in ((one, 1.0), (other, 1.0 + 1e-8)):
        folder.mkdir()
        np.savez(folder / "contact.npz", force=np.array([value]))
    words = ["compare", str(one), str(other)]
    assert main(words) == 0
    assert main([*words, "--tolerance", "1e-12"]) == 1
