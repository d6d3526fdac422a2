"""Study files: what is read, and what is refused with key, found, allowed and remedy."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.run.study.plan.study_file import MOST_SCENES, load_study
from evolvent.scene.scene import SceneError
from tests.support.checkout import ROOT
from tests.support.running.study_cases import HEAD, TORQUES, written

HYPERCUBE = "[latin_hypercube]\nsamples = 5\n[latin_hypercube.ranges]\n"


def test_sections_are_dotted_keys(tmp_path: Path) -> None:
    """Nested tables, dotted keys and keys in quotes name the same key of the scene."""
    forms = ("[grid.load]\ntorque_Nm = [1, 2]", "[grid]\nload.torque_Nm = [1, 2]", '[grid]\n"load.torque_Nm" = [1, 2]')
    found = [load_study(written(tmp_path, f"{HEAD}{form}\n")).grid for form in forms]
    assert found == [{"load.torque_Nm": (1, 2)}] * 3


def test_count_of_scenes(tmp_path: Path) -> None:
    """2 of a grid, times 3 side by side, times 5 samples."""
    lists = "[list]\npinion.addendum_coefficient = [1.0, 1.1, 1.2]\nwheel.addendum_coefficient = [1.0, 1.1, 1.2]\n"
    ranges = f"{HYPERCUBE}pair.normal_pressure_angle_deg = [16.0, 20.0]\n"
    text = f"{HEAD}[grid]\nload.torque_Nm = [1.0, 2.0]\n{lists}{ranges}"
    assert load_study(written(tmp_path, text)).count == 30


@pytest.mark.parametrize(
    ("text", "key", "said"),
    [
        (HEAD, "grid", "found no parameter"),
        (TORQUES.replace("title", "titel"), "titel", "did you mean title?"),
        (TORQUES.replace('"check"', '"chek"'), "compute", '"check", "run"'),
        (TORQUES.replace("[grid]", "[gird]"), "gird", "did you mean grid?"),
        (TORQUES.replace("load.torque_Nm", "load.torque"), "grid.load.torque", "did you mean load.torque_Nm?"),
        (TORQUES.replace("load.torque_Nm", "loads.torque_Nm"), "grid.loads", "did you mean load?"),
        (TORQUES.replace("load.torque_Nm", "load"), "grid.load", "a section with the keys torque_Nm"),
        (TORQUES.replace("[100.0, 200.0, 300.0]", "[]"), "grid.load.torque_Nm", "found an empty list"),
        (TORQUES.replace("[100.0, 200.0, 300.0]", "100.0"), "grid.load.torque_Nm", "each with a list"),
        (TORQUES.replace("200.0", "100.0"), "grid.load.torque_Nm", "100.0 more than once"),
        (f"{TORQUES}[set]\nload.torque_Nm = 5.0\n", "grid.load.torque_Nm", "a key that [set] has, too"),
        (f"{HEAD}[list]\nload.torque_Nm = [1.0]\npair.misalignment_um = [1.0, 2.0]\n", "list", "equally long"),
        (f"{HEAD}{HYPERCUBE}load.torque_Nm = [2.0, 1.0]\n", "latin_hypercube.ranges.load.torque_Nm", "lower one first"),
        (f"{HEAD}{HYPERCUBE}load.torque_Nm = [1.0]\n", "latin_hypercube.ranges.load.torque_Nm[1]", "two different"),
        (f"{HEAD}{HYPERCUBE.replace('5', '0')}load.torque_Nm = [1.0, 2.0]\n", "latin_hypercube.samples", "1 to"),
        (HEAD.replace("title", 'leave_out = ["pinion.tip_mm"]\ntitle') + "[grid]\nload.torque_Nm = [1.0]\n",
         "leave_out.pinion.tip_mm", "allowed: a key of [pinion]"),
        (f'{TORQUES}[[figure]]\nname = "a b"\nfile = "a.csv"\ncolumn = "c"\n', "figure[0].name", "letters, digits"),
        (f'{TORQUES}[[figure]]\nname = "a"\nfile = "a.txt"\ncolumn = "c"\n', "figure[0].file", "CSV or JSON"),
        (f'{TORQUES}[[figure]]\nname = "a"\nfile = "../a.csv"\ncolumn = "c"\n', "figure[0].file", "in it"),
        (f'{TORQUES}[[figure]]\nname = "a"\nfile = "/a.csv"\ncolumn = "c"\n', "figure[0].file", "in it"),
        (f'{TORQUES}[[figure]]\nname = "a"\nfile = "b/../a.json"\ncolumn = "c"\n', "figure[0].file", "CSV or JSON"),
        (f"{TORQUES}[[figure]]\nnam = 1\n", "figure[0].nam", "docs/studies.md"),
    ],
)
def test_wrong_keys_are_named(tmp_path: Path, text: str, key: str, said: str) -> None:
    """One line that begins with the file and the key."""
    path = written(tmp_path, text)
    with pytest.raises(SceneError) as caught:
        load_study(path)
    assert any(line.startswith(f"{path}: {key}: found ") and said in line for line in str(caught.value).splitlines()), (
        str(caught.value)
    )


def test_a_million_scenes_are_the_most(tmp_path: Path) -> None:
    """1001 × 1000 combinations are refused at once, 1000 × 1000 are not."""
    for more in (0, 1):
        torques, angles = [float(i + 1) for i in range(1000 + more)], [10.0 + 0.01 * i for i in range(1000)]
        grid = f"[grid]\nload.torque_Nm = {torques}\npair.normal_pressure_angle_deg = {angles}\n"
        path = written(tmp_path, HEAD + grid)
        if not more:
            assert load_study(path).count == MOST_SCENES
            continue
        with pytest.raises(SceneError, match="found 1,001,000 scenes; allowed: up to 1,000,000 scenes"):
            load_study(path)


def test_a_scene_is_no_study(tmp_path: Path) -> None:
    """One line that names the commands for it."""
    text = (ROOT / "demos/zhang2023.toml").read_text(encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load_study(written(tmp_path, text))
    (problem,) = caught.value.problems
    assert problem.found == "a scene, with a section [pair]" and "`evolvent check`" in problem.remedy


def test_no_toml(tmp_path: Path) -> None:
    """A line that is no TOML, and a file that is not there: the message speaks of a study file."""
    with pytest.raises(SceneError, match="study file: found no TOML"):
        load_study(written(tmp_path, "title = [\n"))
    with pytest.raises(SceneError, match=r"none\.toml: study file: found No such file"):
        load_study(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("text", "key", "remedy"),
    [
        ("[figure]\nname = 'x_mm'\n", "figure", "write [[figure]] in place of [figure]"),
        ("[figures]\nname = 'x_mm'\n", "figures", "a figure of your own is a section [[figure]]"),
        ("[[figures]]\nname = 'x_mm'\n", "figures[0]", "a figure of your own is a section [[figure]]"),
        ("[[latin_hypercube]]\nsamples = 5\n", "latin_hypercube", "write [latin_hypercube] in place of [[latin_"),
        ("[parameters]\nload.torque_Nm = [1, 2]\n", "parameters", "did you mean grid?"),
        ("[lhs]\nsamples = 5\n", "lhs", "did you mean latin_hypercube?"),
    ],
)
def test_lists_of_sections_and_sections_are_told_apart(tmp_path: Path, text: str, key: str, remedy: str) -> None:
    """One pair of brackets too few or too many, and other words for sections: the remedy is what has to be written."""
    with pytest.raises(SceneError) as caught:
        load_study(written(tmp_path, f"{TORQUES}{text}"))
    assert [remedy in each.remedy for each in caught.value.problems if each.key == key] == [True], caught.value
