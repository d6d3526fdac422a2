"""Scenes of a study: their values, their names by content, and which of them share gears."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.run.study.plan.shared_gears import own_torque
from evolvent.run.study.plan.study_file import load_study
from evolvent.run.study.plan.study_scenes import study_scenes
from evolvent.run.study.results.figures import gathered_figures
from evolvent.scene.scene import SceneError
from tests.support.checkout import ROOT
from tests.support.running.study_cases import HEAD, TORQUES, VERSION, scenes_of

MAP = (
    HEAD.replace('"check"', '"excitation"').replace("zhang2023", "yang2022")
    + "[grid]\npair.misalignment_um = [0.0, 5.0]\nload.torque_Nm = [100.0, 200.0]\n"
)


def test_names_are_of_the_content(tmp_path: Path) -> None:
    """Another title leaves the names, another value, computation or version gives others; the same scene in another
    study has the same name."""
    one = [each.name for each in scenes_of(tmp_path, TORQUES)]
    assert len(set(one)) == 3
    assert [each.name for each in scenes_of(tmp_path, TORQUES.replace("a study", "another"))] == one
    assert [each.name for each in scenes_of(tmp_path, TORQUES.replace("100.0, 200.0", "200.0, 100.0"))] == [
        one[1], one[0], one[2]
    ]
    for other in (TORQUES.replace('"check"', '"wear"'), f"{TORQUES}[set]\nsweep.positions = 7\n"):
        assert not set(one) & {each.name for each in scenes_of(tmp_path, other)}
    assert not set(one) & {each.name for each in scenes_of(tmp_path, TORQUES, version="2.0")}


def test_names_are_of_the_loads_that_are_computed(tmp_path: Path) -> None:
    """Losses under other parts of the torque, or under load cases, have other names; a run, which has no list of loads,
    has the same one."""
    for compute, count in (("losses", 3), ("run", 1)):
        head, alone = HEAD.replace('"check"', f'"{compute}"'), "[grid]\nload.torque_Nm = [100.0]\n"
        lists = "", "[set]\nload.percents = [50.0, 100.0]\n", "[set]\nload.percents = [50.0]\n"
        names = [each.name for text in lists for each in scenes_of(tmp_path, f"{head}{alone}{text}")]
        assert len(set(names)) == count


def test_values_that_are_no_scene_are_refused_alone(tmp_path: Path) -> None:
    """A negative torque among two: its scene is refused with the reason, the other one stands."""
    refused, fine = scenes_of(tmp_path, f"{HEAD}[grid]\nload.torque_Nm = [-1.0, 100.0]\n")
    assert refused.scene is None and "load.torque_Nm: found -1; allowed: a number above 0" in refused.refusal
    assert fine.scene is not None and not fine.refusal


def test_keys_are_left_out_and_set(tmp_path: Path) -> None:
    """The base scene has tip diameters: without them addendum coefficients may vary, with them all are refused,
    which is said before anything is written."""
    text = f"{HEAD}[set]\nsweep.positions = 7\n[grid]\npinion.addendum_coefficient = [1.2]\n"
    with pytest.raises(SceneError, match=r"its scene: .*delete tip_diameter_mm or addendum_coefficient"):
        scenes_of(tmp_path, text)
    (scene,) = scenes_of(tmp_path, f'leave_out = ["pinion.tip_diameter_mm"]\n{text}')
    assert scene.scene is not None
    assert scene.scene.pinion.addendum_coefficient == 1.2 and scene.scene.sweep.positions == 7
    assert not scene.scene.output.pictures


def test_base_scene_that_cannot_be_read(tmp_path: Path) -> None:
    """The message names the study, the scene and what is wrong with it."""
    with pytest.raises(SceneError, match=r"study\.toml: scene .*none\.toml: scene file: found No such file"):
        scenes_of(tmp_path, TORQUES.replace("zhang2023.toml", "none.toml"))


def test_torque_and_misalignment_share_gears(tmp_path: Path) -> None:
    """All four scenes of Yang's helical pair have the same gears, on meshes that serve both torques."""
    scenes = scenes_of(tmp_path, MAP.replace('"excitation"', '"run"'))
    assert len({each.gears for each in scenes}) == 1 and scenes[0].gears
    assert all(each.scene is not None and each.scene.load.mesh_torques_Nm == (100.0, 200.0) for each in scenes)


def test_excitations_share_meshes_of_the_heaviest_torque(tmp_path: Path) -> None:
    """Both torques have the elements of 200 N·m, which are twice as long as those of 50 N·m; a range that the base
    scene names stays."""
    scenes = scenes_of(tmp_path, MAP.replace("100.0, 200.0", "50.0, 200.0"))
    assert len({each.gears for each in scenes}) == 1 and scenes[0].gears
    for each in scenes:
        assert each.scene is not None
        assert own_torque(each.scene).problem.lightest.torque == pytest.approx(200e3)
        assert own_torque(each.scene).torques == pytest.approx((1e3 * each.scene.load.torque_Nm,))
    named = scenes_of(tmp_path, f"{MAP}[set]\nload.mesh_torques_Nm = [50.0, 250.0]\n")
    assert all(each.scene is not None and each.scene.load.mesh_torques_Nm == (50.0, 250.0) for each in named)


def test_gears_of_ones_own(tmp_path: Path) -> None:
    """Without sharing, names are others and no meshes serve other torques."""
    scenes = scenes_of(tmp_path, MAP)
    alone = scenes_of(tmp_path, f"share_gears = false\n{MAP}")
    assert not {each.name for each in scenes} & {each.name for each in alone}
    assert all(each.gears == "" and each.scene is not None and not each.scene.load.mesh_torques_Nm for each in alone)


def test_other_teeth_are_other_gears(tmp_path: Path) -> None:
    """Two face widths under two torques are two pairs of gears; a spur pair with misalignment is solved in space, and
    has not the gears of the plane one."""
    widths = MAP.replace("pair.misalignment_um = [0.0, 5.0]", "pinion.bore_diameter_mm = [17.0, 18.0]")
    names = [each.gears for each in scenes_of(tmp_path, widths)]
    assert names[0] == names[1] != names[2] == names[3] and all(names)
    spur = MAP.replace("yang2022", "he2022")
    names = [each.gears for each in scenes_of(tmp_path, spur)]
    assert names[0] == names[1] != names[2] == names[3] and all(names)


@pytest.mark.parametrize("path", sorted((ROOT / "demos/studies").glob("*.toml")), ids=lambda path: path.stem)
def test_demo_studies_have_valid_scenes(path: Path) -> None:
    """No scene of a study that a user may start from is refused, and its figures have names."""
    study = load_study(path)
    assert gathered_figures(study, str(path))
    assert [each.refusal for each in study_scenes(study, path, (), VERSION) if each.refusal] == []
