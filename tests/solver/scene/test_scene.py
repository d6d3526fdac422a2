"""The scene file: what is accepted, what is derived, and that every error says key, found, allowed and remedy."""

from __future__ import annotations

import pickle
import re
from pathlib import Path

import pytest

from evolvent.gears.meshing.element_sizes import elements_per_contact_width, sector_resolutions
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, SceneError, load_scene, scene_from_text
from evolvent.scene.schema.errors import keys_of
from evolvent.scene.skips import skipped
from tests.support.checkout import ROOT
from tests.support.malformed.scenes import MALFORMED
from tests.support.scene_texts import DEMOS, FIRST, HE, YANG, without


@pytest.mark.parametrize("case", MALFORMED)
def test_malformed_scene_has_one_message(case: str) -> None:
    """One message has the key, what was found, what is allowed and the remedy."""
    text, overrides, key, found, remedy = MALFORMED[case]
    with pytest.raises(SceneError) as caught:
        scene_from_text(text, overrides)
    lines = [line for line in str(caught.value).splitlines() if line.startswith(f"{key}: ")]
    assert len(lines) == 1, f"no message for {key} in {caught.value}"
    message = re.fullmatch(r"(.*): found (.*); allowed: (.+); remedy: (.+)", lines[0])
    assert message is not None, lines[0]
    assert found in message[2]
    assert remedy in message[4]


def test_at_least_45_malformed_scenes() -> None:
    """At least 45 different ones."""
    assert len(MALFORMED) >= 45


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("pair.center_distance_mm", "pair.centre_distance_mm"), ("load.torque", "load.torque_Nm"),
        ("contact.mu", "contact.friction"), ("pinion.z", "pinion.teeth"), ("pinion.module", "pair.normal_module_mm"),
        ("wheel.width", "wheel.face_width_mm"), ("wheel.x", "wheel.profile_shift"), ("mesh.cells", "mesh.shape"),
        ("pair.beta", "pair.helix_angle_deg"), ("material.youngs_modulus", "material.E_GPa"),
        ("pinion.bore", "pinion.bore_diameter_mm"), ("material.e_gpa", "material.E_GPa"),
        ("pinion.TEETH", "pinion.teeth"), ("wheel.Profile_Shift", "wheel.profile_shift"),
        ("material.poissons_ratio", "material.nu"), ("pair.a", "pair.centre_distance_mm"),
        ("wheel.inner_diameter_mm", "wheel.bore_diameter_mm"), ("pinion.outer_diameter", "pinion.tip_diameter_mm"),
        ("transient.speed_rpm", "transient.speeds_rpm"), ("transient.speed", "transient.speeds_rpm"),
        ("fatigue.exponent", "fatigue.exponents"),
        ("dynamics.speeds_rpm", "dynamics.speed_rpm or dynamics.operating_rpm or transient.speeds_rpm"),
        ("load.speed_rpm", "dynamics.operating_rpm or transient.speeds_rpm"),
    ],
)
def test_unknown_key_suggests_the_key_that_was_meant(written: str, meant: str) -> None:
    """Found by its spelling, by its symbol, or by what it means; nearly the same spelling in the section goes
    before the same spelling in another one."""
    with pytest.raises(SceneError, match=re.escape(f"did you mean {meant}") + r"( \(.*\))?\?"):
        scene_from_text(YANG, [f"{written}=1"])


def test_independent_errors_are_reported_together() -> None:
    """Independent errors are all named, each in its own line, with the file's name."""
    with pytest.raises(SceneError) as caught:
        scene_from_text(YANG, ["load.torque_Nm=0", "mesh.order=3", "pinion.teeth=2"], source="mine.toml")
    keys = [problem.key for problem in caught.value.problems]
    assert sorted(keys) == ["load.torque_Nm", "mesh.order", "pinion.teeth"]
    assert all(line.startswith("mine.toml: ") for line in str(caught.value).splitlines())


def test_a_wrong_entry_of_a_list_is_one_error() -> None:
    """Of a list that has no other entries, too."""
    for settings in (["strength.editions=[2016]"], ["contact.friction=[-1]"]):
        with pytest.raises(SceneError) as caught:
            scene_from_text(YANG, settings)
        assert [problem.key for problem in caught.value.problems] == [f"{settings[0].split('=')[0]}[0]"]


def test_a_study_is_no_scene() -> None:
    """One line that names the command; so has a file that a study takes for its base scene."""
    with pytest.raises(SceneError, match=r"^scene file: found a study, with scene and compute; .*`evolvent study`"):
        scene_from_text('scene = "yang.toml"\ncompute = "check"\n[grid]\nload.torque_Nm = [1.0]\n')
    with pytest.raises(SceneError, match=r"^scene: found an unknown key"):
        scene_from_text(f'scene = "yang.toml"\n{YANG}')


@pytest.mark.parametrize(("heights", "wrong"), [([10.0, -10.0], ""), ([10.0, -10.1], "-10.1 of gauge 2, on the wheel")])
def test_gauges_lie_on_the_face_of_their_gear(heights: list[float], wrong: str) -> None:
    """He's pair has faces of 20 mm and is solved in plane strain, where a height does not count: beside the face it is
    refused all the same."""
    gauges = 'gear=["pinion", "wheel"], side=["back", "loaded"], angle_deg=[30, 30], length_mm=[0.5, 0.5]'
    settings = [f"strength.gauges={{{gauges}, height_mm={heights}}}"]
    if not wrong:
        assert scene_from_text(HE, settings).strength is not None
        return
    with pytest.raises(SceneError, match=r"strength\.gauges\.height_mm: found .* from -10 to 10 mm") as caught:
        scene_from_text(HE, settings)
    assert wrong in caught.value.problems[0].found


def test_misspelled_section_is_not_missing_too() -> None:
    """[laod] for [load], and a key that is near to a required one: one problem, the spelling."""
    section, name = YANG.replace("[load]", "[laod]"), YANG.replace("torque_Nm", "torque_Nmm")
    for text, key in (section, "laod"), (name, "load.torque_Nmm"):
        with pytest.raises(SceneError) as caught:
            scene_from_text(text)
        assert [problem.key for problem in caught.value.problems] == [key]


def test_lower_of_two_torque_limits_is_reported_at_once() -> None:
    """A torque beyond what contact and teeth allow: the limit in the message is allowed, twice of it is not."""
    with pytest.raises(SceneError, match=r"allowed: up to \d+ N·m") as caught:
        scene_from_text(YANG, ["load.torque_Nm=200000"])
    limit = float(caught.value.problems[0].allowed.split()[2])
    assert scene_from_text(YANG, [f"load.torque_Nm={limit}"]).load.torque_Nm == limit
    with pytest.raises(SceneError, match=f"up to {limit:g} N·m"):
        scene_from_text(YANG, [f"load.torque_Nm={1.1 * limit}"])


def test_tip_that_limits_a_relief_says_where_it_comes_from() -> None:
    """A relief from beyond the tip, whose diameter is derived: the message has it; a given one it leaves alone."""
    start, derived = "pinion.tip_relief_start_diameter_mm=70", "the tip diameter 67.12 follows from centre distance"
    for more, told in ([], True), (["pinion.tip_diameter_mm=67"], False):
        with pytest.raises(SceneError, match="to below 67") as caught:
            scene_from_text(FIRST, [start, *more])
        assert (derived in caught.value.problems[0].allowed) == told


def test_scene_error_is_pickled_whole() -> None:
    """SceneError is pickled whole: under mpirun rank 0 reads the scene and sends what it found."""
    with pytest.raises(SceneError) as caught:
        scene_from_text(YANG, ["load.torque_Nm=0"], source="mine.toml")
    copy = pickle.loads(pickle.dumps(caught.value))
    assert (str(copy), copy.problems, copy.exit_status) == (str(caught.value), caught.value.problems, 2)


def test_missing_scene_file_is_named(tmp_path: Path) -> None:
    """A file that cannot be read is named with its path."""
    with pytest.raises(SceneError, match=r"scene\.toml: scene file: found .*; remedy: check the path"):
        load_scene(tmp_path / "scene.toml")


@pytest.mark.parametrize("name", ["yang2022", "he2022", "zhang2023"])
def test_resolved_scene_is_the_same_scene(name: str) -> None:
    """The resolved TOML has every key, and reading it gives an equal scene."""
    scene = load_scene(DEMOS / f"{name}.toml")
    resolved = scene.resolved_toml()
    assert scene_from_text(resolved) == scene
    for key in keys_of(Scene):
        assert re.search(rf"^(# )?{key.rsplit('.', 1)[-1]}( = |: not given)", resolved, re.MULTILINE), key


def test_resolved_scene_keeps_odd_titles() -> None:
    """Quotes, backslashes, new lines and control characters survive."""
    title = 'a "b" \\ c\n\td \x7f β'
    scene = scene_from_text(HE).model_copy(update={"title": title})
    assert scene_from_text(scene.resolved_toml()).title == title


def test_overrides_are_toml_values() -> None:
    """Values are TOML; a bare word is a text, for the shell takes its quotes away; new sections are made."""
    overrides = ["load.torque_Nm=300", "mesh.level=fine", "contact.friction=[0, 0.1]", "material.wheel.E_GPa=105"]
    scene = scene_from_text(YANG, [*overrides, "output.fields = false", "load.on=gear", "title=my pair"])
    assert (scene.load.torque_Nm, scene.mesh.level, scene.contact.friction) == (300, "fine", (0, 0.1))
    assert [material.youngs_modulus for material in scene.materials()] == [210e3, 105e3]
    assert (scene.output.fields, scene.load.on, scene.title) == (False, "wheel", "my pair")


def test_scene_is_frozen() -> None:
    """Frozen."""
    scene = scene_from_text(HE)
    with pytest.raises(ValueError, match="frozen"):
        scene.load.torque_Nm = 3.0  # type: ignore[misc]


def test_default_centre_distance_has_no_backlash() -> None:
    """Zhang: 91.5002 mm (91.5 printed); Yang: 93.0001 mm (93 printed); backlash 0."""
    for name, printed in (("zhang2023", 91.5), ("yang2022", 93.0)):
        text = without((DEMOS / f"{name}.toml").read_text(encoding="utf-8"), "centre_distance_mm")
        pair = scene_from_text(text).gear_pair()
        assert pair.centre_distance == pytest.approx(printed, abs=3e-4)
        assert pair.circumferential_backlash == pytest.approx(0, abs=1e-12)


def test_coefficients_give_the_diameters() -> None:
    """Zhang: h_aP* = 1.25/1.32, h_fP* = 1.57/1.50 give the printed addenda 3.544/2.996 and height 6.465 mm."""
    text = (DEMOS / "zhang2023.toml").read_text(encoding="utf-8")
    for key, coefficients in (("tip_diameter_mm", (1.25, 1.32)), ("root_diameter_mm", (1.57, 1.50))):
        name = {"tip_diameter_mm": "addendum_coefficient", "root_diameter_mm": "dedendum_coefficient"}[key]
        for value in coefficients:
            text = re.sub(rf"^{key}.*$", f"{name} = {value}", text, count=1, flags=re.MULTILINE)
    pair = scene_from_text(text).gear_pair()
    addenda = [(gear.tip_diameter - gear.reference_diameter) / 2 for gear in pair.gears]
    heights = [(gear.tip_diameter - gear.root_diameter) / 2 for gear in pair.gears]
    assert addenda == pytest.approx([3.544, 2.996], abs=6e-4)
    assert heights == pytest.approx([6.465, 6.465], abs=6e-4)


@pytest.mark.parametrize(("level", "elements"), [("quick", 1.7), ("standard", 3), ("fine", 6)])
def test_resolution_follows_the_contact_width(level: str, elements: float) -> None:
    """Yang: as many elements as ∫ds/h wants with h = 2b/elements, whose torque is 2.4 % above that for which
    meshes are made; at twice the torque 1/√2 of them, but for half a step."""
    scene = scene_from_text(YANG, [f"mesh.level={level}"])
    assert elements_per_contact_width(gear_problem(scene)) == elements
    pinion, wheel = sector_resolutions(gear_problem(scene))
    assert 13.5 * elements <= pinion.profile_elements <= wheel.profile_elements <= 16.5 * elements
    double, _ = sector_resolutions(gear_problem(scene_from_text(YANG, [f"mesh.level={level}", "load.torque_Nm=500"])))
    assert double.profile_elements == pytest.approx(pinion.profile_elements / 2**0.5, rel=0.07, abs=3)


def test_elements_per_contact_width_replaces_that_of_the_level() -> None:
    """elements_per_contact_width replaces the level's."""
    coarse, _ = sector_resolutions(gear_problem(scene_from_text(YANG, ["mesh.elements_per_contact_width=1"])))
    assert coarse.profile_elements <= 18


def test_spur_pairs_are_plane_unless_the_lead_varies() -> None:
    """He: 2D, with modifications of the profile, too; with those of the lead, misalignment, a helix or unequal widths:
    3D."""
    assert gear_problem(scene_from_text(HE)).is_plane
    for amount in ("tip_relief_um=5", "root_relief_um=5", "profile_crowning_um=5", "profile_slope_um=-5"):
        assert gear_problem(scene_from_text(HE, [f"pinion.{amount}"])).is_plane
    for amount in ("helix_slope_um=-5", "end_relief_um=5", "twist_um=-5"):
        assert not gear_problem(scene_from_text(HE, [f"pinion.{amount}"])).is_plane
    for override in ("wheel.lead_crowning_um=5", "pair.misalignment_um=-5", "wheel.face_width_mm=19"):
        assert not gear_problem(scene_from_text(HE, [override])).is_plane
    assert not gear_problem(scene_from_text(YANG)).is_plane
    assert any("2D plane strain" in skip.sentence for skip in skipped(scene_from_text(HE)))
    assert not any(skip.name == "friction-terms" for skip in skipped(scene_from_text(YANG)))


def test_docs_list_every_key() -> None:
    """docs/scene.md has one row a key, with its meaning and what is allowed."""
    docs = (ROOT / "docs" / "scene.md").read_text(encoding="utf-8")
    for name, field in keys_of(Scene).items():
        row = re.search(rf"^\| `{re.escape(name)}` \|(.*)\|$", docs, re.MULTILINE)
        assert row is not None, f"docs/scene.md does not list {name}"
        words = field.json_schema_extra
        assert isinstance(words, dict)
        allowed = "a list of the names below" if name == "exact.parts" else words["allowed"]
        end = r"(; only with [^|]*)?"  # tests/solver/scene/schema/test_dependence.py
        said = re.search(re.escape(f" {field.description} | {allowed}") + end + r" \|", row[1])
        assert said is not None, f"docs/scene.md says something else of {name}"
