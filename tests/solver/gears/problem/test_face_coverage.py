"""Heights of flank charts beside the face of their gear: used, extended with a word, or refused."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from evolvent.gears import FlankChart, GearProblem, Member
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import write_scene
from evolvent.scene.chart_warnings import chart_warnings
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, SceneError, load_scene
from evolvent.wear.results.archive import write_worn
from evolvent_meshes.csv_tables import TableError
from tests.support.gear_cases import helical_scene, spur_scene
from tests.support.gear_wear_cases import smooth_wear, wearing_gears
from tests.support.gears_api_curve import he_problem

FACES = {"pinion": 20.0, "wheel": 24.0}
"""Face widths of an unequal pair [mm]."""


@dataclass(frozen=True)
class Heights:
    """Heights of a chart, in face widths from mid-face, and what becomes of it."""

    low: float
    high: float
    said: str = ""
    """Of a chart that is used; empty: nothing."""
    refused: str = ""
    """What the message says; empty: the chart is used."""


FROM_END, LEFT_OF_END = "counted from one end of the face, 0 to", "counted from one end of the face, -"
CASES = {
    "whole": Heights(-0.5, 0.5),
    "0.95": Heights(-0.475, 0.475, "cover 95 % of the face"),
    "exactly 0.8": Heights(-0.4, 0.4, "cover 80 % of the face"),
    "just below 0.8": Heights(-0.3999, 0.3999, refused="measure further"),
    "0.7": Heights(-0.35, 0.35, refused="70 % of the face"),
    "half about the middle": Heights(-0.25, 0.25, refused="measure further"),
    "upper half": Heights(0.0, 0.5, refused="measure further"),
    "from 0 to b": Heights(0.0, 1.0, refused=FROM_END),
    "from -b to 0": Heights(-1.0, 0.0, refused=LEFT_OF_END),
    "0.8 of b, from an end": Heights(0.1, 0.9, refused=FROM_END),
    "0.9 of b, from the other end": Heights(-0.95, -0.05, refused=LEFT_OF_END),
    "exactly 5 % off": Heights(-0.45, 0.55, "cover 95 % of the face"),
    "exactly 5 % off and 0.8": Heights(-0.45, 0.35, "cover 80 % of the face"),
    "just over 5 % off": Heights(-0.4499, 0.5501, refused="where mid-face is"),
    "10 % off": Heights(-0.4, 0.6, refused="where mid-face is"),
    "another origin": Heights(2.5, 3.5, refused="0 % of the face"),
    "longer": Heights(-0.55, 0.55, "what lies beyond the face is left out"),
    "much longer": Heights(-1.1, 1.1, refused="which gear the chart is of"),
    "one height": Heights(0.3, 0.3),
    "one height off the face": Heights(1.3, 1.3, refused="leave z_mm out"),
}


def chart_of(low: float, high: float) -> FlankChart:
    """A slope of 1 µm/mm over these heights [mm], on diameters that cover both gears of He's pair."""
    z = np.unique(np.array([low, high]))
    return FlankChart(np.array([140.0, 156.0]), z, 1e-3 * np.vstack([z, z]))


def unequal(*settings: str) -> Scene:
    """He's pair with the faces of FACES."""
    return spur_scene(*(f"{gear}.face_width_mm={width}" for gear, width in FACES.items()), *settings)


def problem_with(member: Member, chart: FlankChart) -> GearProblem:
    """The unequal pair from Python."""
    bare = gear_problem(unequal())
    return replace(bare, flanks=(chart, None) if member is Member.PINION else (None, chart))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("member", Member, ids=lambda member: member.label)
def test_heights_are_held_to_the_face(name: str, member: Member, tmp_path: Path) -> None:
    """Problem: heights of 0 to b, −b to 0, half of the face and others passed in silence, with K_Hβ 1.5 for 2.5. Right:
    80 % of the gear's own face and more, centred within 5 %, is used and said; else a refusal that tells where z counts
    from. Scenes and the Python API alike, pinion and wheel, on unequal faces; limits hold to rounding."""
    case, b = CASES[name], FACES[member.label]
    chart, path = chart_of(case.low * b, case.high * b), tmp_path / "lead.csv"
    rows = [f"{d:g},{z:.9g},{z:.9g}" for d in chart.diameters for z in chart.heights]
    path.write_text("\n".join(["diameter_mm,z_mm,depth_um", *rows]), encoding="utf-8")
    key = f"{member.label}.flank_csv"
    if case.refused:
        with pytest.raises(SceneError, match=f"{key}: found .*lead.csv: ") as by_scene:
            unequal(f'{key}="{path}"')
        with pytest.raises(TableError, match=f"flanks, {member.label}: found ") as by_api:
            problem_with(member, chart)
        for error in (by_scene, by_api):
            assert case.refused in str(error.value) and f"0 at mid-face, {-b / 2:g} to {b / 2:g} mm" in str(error.value)
        return
    said = chart_warnings(unequal(f'{key}="{path}"'))
    assert len(said) == bool(case.said) and all(s.startswith(f"{key}, lead.csv: ") and case.said in s for s in said)
    words = list(problem_with(member, chart).extended_charts.items())
    assert [gear for gear, _ in words] == [member] * bool(case.said) and all(case.said in each for _, each in words)


@pytest.mark.parametrize("end", [1.0, -1.0])
def test_remedy_names_what_to_subtract(end: float) -> None:
    """Heights from one end of a face of 20 mm: 10 mm, or −10 mm, are to be subtracted; what is left is refused no more.
    """
    chart, gear = chart_of(min(0.0, 20.0 * end), max(0.0, 20.0 * end)), he_problem().pair.pinion
    problem = chart.coverage(gear).problem
    assert problem is not None and problem[2].endswith(f"subtract {10.0 * end:g} mm from it")
    assert replace(chart, heights=chart.heights - 10.0 * end).coverage(gear).problem is None


def test_chart_is_extended_by_the_depths_at_its_ends() -> None:
    """A slope of 1 µm/mm from −8 to 9 mm on a face of ±10 mm. Exact: −8 and 9 µm at its ends, the slope in between. A
    longer chart keeps its own depth at the ends of the face."""
    problem = replace(he_problem(), flanks=(chart_of(-8.0, 9.0), chart_of(-12.0, 11.0)))
    gear, z = problem.pair.pinion, np.array([-10.0, -9.0, 0.5, 9.5, 10.0])
    roll = np.full(len(z), gear.roll_length(150.0))
    shorter, longer = problem.flanks
    assert shorter is not None and longer is not None
    assert shorter.at(gear, roll, z) == pytest.approx(1e-3 * np.clip(z, -8.0, 9.0), abs=1e-12)
    assert longer.at(gear, roll, z) == pytest.approx(1e-3 * z, abs=1e-12)
    assert problem.extended_charts[Member.PINION].startswith("heights z = -8 to 9 mm cover 85 % of the face, -10 to 10")


def test_worn_charts_cover_each_gears_own_face(tmp_path: Path) -> None:
    """Problem: the charts that a wear run writes, of gears with faces of 8 and 10 mm. Right: read back as they are,
    without a word; once their heights are counted from an end of the face, refused as any other chart."""
    scene = helical_scene("contact.friction=0", "wheel.face_width_mm=10")
    study = wearing_gears(scene, positions=2)
    write_worn(scene, tmp_path, study, smooth_wear(study, 2e-3))
    worn = load_scene(tmp_path / "scene.toml")
    assert chart_warnings(worn) == []
    for name, width in (("pinion", 8.0), ("wheel", 10.0)):
        path = tmp_path / f"flank_{name}.csv"
        text, chart = path.read_text(encoding="utf-8"), FlankChart.read(path)
        assert np.ptp(chart.heights) == pytest.approx(width, rel=1e-9)
        path.write_text(replace(chart, heights=chart.heights + width / 2).text(), encoding="utf-8")
        with pytest.raises(ValueError, match=rf"{name}\.flank_csv: .*{FROM_END}"):
            load_scene(tmp_path / "scene.toml")
        path.write_text(text, encoding="utf-8")


def test_written_chart_is_the_measured_one(tmp_path: Path) -> None:
    """A run writes the chart as it was measured: what is read from its folder says again that it is short."""
    (tmp_path / "a.csv").write_text(chart_of(-8.0, 8.0).text(), encoding="utf-8")
    scene = spur_scene(f'pinion.flank_csv="{tmp_path / "a.csv"}"')
    write_scene(scene, RunFolder(tmp_path / "out"))
    (said,) = chart_warnings(load_scene(tmp_path / "out/scene.toml"))
    assert said == chart_warnings(scene)[0].replace("a.csv", "flank_pinion.csv")
