"""Charts of flanks: read back as written, laid on a gear, and refused where they are wrong."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evolvent.commands.app import Exit, main
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.csv_tables import TableError
from tests.support.checkout import ROOT
from tests.support.gear_cases import model_of, spur_scene
from tests.support.gears_api_curve import he_problem

DIAMETERS = np.linspace(144.0, 156.0, 25)
PAIR = spur_scene().gear_pair()
ACTIVE = PAIR.active_start_diameters[0], PAIR.pinion.tip_diameter


def chart(over_face: float = 0.0) -> FlankChart:
    """10 µm all over, and more towards z > 0."""
    heights = np.array([-10.0, 0.0, 10.0]) if over_face else np.zeros(1)
    return FlankChart(DIAMETERS, heights, 1e-2 + over_face * heights * np.ones((len(DIAMETERS), 1)))


def test_chart_is_written_and_read_back(tmp_path: Path) -> None:
    """A chart of 25 diameters and 3 heights: the same within what nine decimals leave; in any order of lines."""
    rng = np.random.default_rng(0)
    made = FlankChart(DIAMETERS, np.array([-9.0, 1.0, 10.0]), 1e-2 * rng.random((25, 3)))
    path = tmp_path / "a.csv"
    header, *lines = made.text().splitlines()
    path.write_text("\n".join([header, *rng.permutation(lines)]))
    read = FlankChart.read(path)
    assert read.diameters == pytest.approx(made.diameters, abs=1e-9)
    assert read.heights == pytest.approx(made.heights, abs=1e-9)
    assert read.depth == pytest.approx(made.depth, abs=1e-9)
    assert read.text() == made.text()


def test_chart_depth_is_linear_in_the_arc() -> None:
    """Linear in the involute's arc, constant beyond the rim: exact for a depth that is linear in d²."""
    gear = PAIR.pinion
    made = FlankChart(DIAMETERS, np.zeros(1), (1e-5 * DIAMETERS**2)[:, None])
    d = np.array([142.0, 144.7, 150.1, 156.0, 157.0])
    roll = np.sqrt(d**2 / 4.0 - gear.base_radius**2)
    assert made.at(gear, roll, np.zeros(5)) == pytest.approx(1e-5 * np.clip(d, 144.0, 156.0) ** 2, rel=1e-12)


def test_chart_has_no_depth_where_there_is_no_involute() -> None:
    """Points inside the base cylinder have the roll length NaN (`Flank.project`): so is their depth, on charts over the
    profile alone and over the face; other points keep theirs, 10 µm."""
    roll, z = np.array([np.nan, PAIR.pinion.roll_length(150.0)]), np.zeros(2)
    for made in (chart(), chart(over_face=1e-4)):
        assert made.at(PAIR.pinion, roll, z) == pytest.approx([np.nan, 1e-2], nan_ok=True)


def test_missing_material_moves_the_transmission_error(tmp_path: Path) -> None:
    """The pinion's flank charted 10 µm low all over: a parallel involute, so the transmission error is 10 µm larger at
    every position within 0.1 %."""
    path = tmp_path / "low.csv"
    path.write_text(chart().text())
    found = []
    for settings in ((), (f'pinion.flank_csv="{path}"',)):
        model = model_of(spur_scene("mesh.level=quick", *settings))
        pitch = uniform_pitch(50, 3)
        results = [p.results[0] for p in sweep_pitch(model, pitch, [0.0], initial_state([0.0]))]
        found.append(np.array([result.transmission_error for result in results]))
    assert found[1] - found[0] == pytest.approx(1e-2, rel=1e-3)


def test_only_charts_that_vary_over_the_face_need_3d(tmp_path: Path) -> None:
    """A spur pair stays plane with a profile, and does not with a lead."""
    for over_face in (0.0, 1e-4):
        path = tmp_path / f"{over_face}.csv"
        path.write_text(chart(over_face).text())
        assert gear_problem(spur_scene(f'wheel.flank_csv="{path}"')).is_plane == (over_face == 0.0)


def test_chart_is_found_from_the_folder_of_its_scene(tmp_path: Path) -> None:
    """A scene names its chart as it lies beside it, wherever the program runs; --set names it from there."""
    (tmp_path / "low.csv").write_text(chart().text())
    text = (ROOT / "demos/he2022.toml").read_text(encoding="utf-8").replace("[wheel]", 'flank_csv = "low.csv"\n[wheel]')
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    assert main(["check", str(tmp_path / "scene.toml")]) == Exit.DONE
    assert main(["check", str(ROOT / "demos/he2022.toml"), "--set", "pinion.flank_csv=low.csv"]) == Exit.BAD_INPUT


def changed(old: str, new: str) -> str:
    """The text of a chart with a lead, changed."""
    return chart(1e-4).text().replace(old, new)


FIRST = chart(1e-4).text().splitlines()[1]
WRONG = {
    "gap": (changed(FIRST + "\n", ""), "0 lines for diameter 144 mm, z -10 mm"),
    "repeated": (changed(FIRST, f"{FIRST}\n{FIRST}"), "2 lines for diameter 144 mm"),
    "no number": (changed(FIRST, FIRST.replace(".000000000,", "x,", 1)), "a number of at most"),
    "NaN": (changed(FIRST, "144,-10,nan"), "'nan'; allowed: a number"),
    "short line": (changed(FIRST, "144,-10"), "2 cells; allowed: 3 cells"),
    "no depth": (changed("depth_um", "depth"), "one column named depth_um or depth_mm"),
    "µm called mm": (changed("depth_um", "depth_mm"), "is the column's unit right?"),
    "radius": (FlankChart(DIAMETERS / 2, np.zeros(1), np.zeros((25, 1))).text(), "not radius"),
    "half the flank": (FlankChart(DIAMETERS[:12], np.zeros(1), np.zeros((12, 1))).text(), "over the whole active"),
    "z in µm": (FlankChart(DIAMETERS, np.array([-1e4, 1e4]), np.zeros((25, 2))).text(), "mind that z is in mm"),
    "one side": (FlankChart(DIAMETERS, np.array([8.0, 9.0]), np.zeros((25, 2))).text(), "measure further"),
    "empty": ("", "a header and lines of numbers"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_chart_is_refused(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A clear message that names the scene's key, status 2, nothing written."""
    text, message = WRONG[name]
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises(TableError, match=message.split("(")[0].replace("?", r"\?")):
        FlankChart.read(tmp_path / "bad.csv").checked(tmp_path / "bad.csv", PAIR.pinion, ACTIVE)
    out = tmp_path / "out"
    scene = [str(ROOT / "demos/he2022.toml"), "--set", f"pinion.flank_csv={tmp_path / 'bad.csv'}"]
    status = main(["run", *scene, "--out", str(out)])
    said = capsys.readouterr().err
    assert status == Exit.BAD_INPUT and "pinion.flank_csv" in said and message in said and not out.exists()


def test_a_chart_given_to_a_problem_may_begin_below_the_base_circle() -> None:
    """Below the base circle there is no involute. Problem: a chart of arrays from the root on that grows
    by 1 µm/mm of diameter from there. Exact: its depth at the tip."""
    d = np.linspace(132.0, 156.0, 13)
    chart = FlankChart(d, np.array([-10.0, 10.0]), 1e-3 * np.column_stack([d - 132.0, d - 132.0]))
    given = replace(he_problem(), flanks=(chart, None)).flanks[0]
    assert given is not None
    gear = he_problem().pair.pinion
    assert given.at(gear, np.array([gear.roll_length(156.0)]), np.zeros(1)) == pytest.approx(24e-3, rel=1e-9)
