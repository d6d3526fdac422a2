"""The loads that a scene lists, and the scene under each of them and under a part of its torque."""

from __future__ import annotations

import re

import pytest

from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.load_cases import LoadCase, in_space_sentence, load_cases, under_cases, under_torque, with_list
from evolvent.scene.scene import SceneError
from tests.support.gear_cases import spur_scene


def cases(*keys: str) -> str:
    """Override with load cases of the names a, b, ..., the other keys of each in TOML."""
    sections = (f'{{name = "{name}", {each}}}' for name, each in zip("abc", keys))
    return f"load_case=[{', '.join(sections)}]"


def test_torque_and_meshes_are_replaced() -> None:
    """The torque, and the range of torques for the meshes, which is left out where it is not given; nothing else."""
    scene = spur_scene("load.mesh_torques_Nm=[10, 400]")
    half = under_torque(scene, 0.5 * scene.load.torque_Nm, (1.0, 500.0))
    assert (half.load.torque_Nm, half.load.mesh_torques_Nm) == (0.5 * scene.load.torque_Nm, (1.0, 500.0))
    alone = under_torque(scene, scene.load.torque_Nm)
    assert alone == scene.model_copy(update={"load": scene.load.model_copy(update={"mesh_torques_Nm": None})})


@pytest.mark.parametrize("percent", [1e-7, 1e6])
def test_refused_part_names_the_torque_of_the_scene(percent: float) -> None:
    """Too small or too large a part: the message has the torque that stands in the scene, and what part is refused."""
    scene = spur_scene()
    with pytest.raises(SceneError, match=re.escape(f"load.torque_Nm: found 170, at {percent:g} % of it")):
        under_torque(scene, scene.load.torque_Nm * percent / 100.0)


def test_percents_are_load_cases() -> None:
    """He's 170 N·m: names and folders by the part, the lightest first, without speed and share; those given before
    those of the scene, which come before the default."""
    scene = spur_scene("load.percents=[100.0, 12.5]", "pair.misalignment_um=4.0")
    assert load_cases(with_list(scene)) == (
        LoadCase("12.5 %", "012.5_percent", 21.25, 4.0), LoadCase("100 %", "100.0_percent", 170.0, 4.0),
    )
    assert [each.name for each in load_cases(with_list(scene, [50.0]))] == ["50 %"]
    assert [each.name for each in load_cases(with_list(spur_scene(), (), [5.0, 75.0]))] == ["5 %", "75 %"]
    assert [each.name for each in load_cases(with_list(spur_scene()))] == ["100 %"]


def test_load_cases_have_their_own_misalignment_or_the_pairs() -> None:
    """Sorted by torque; the pair is open by 4 µm."""
    scene = spur_scene("pair.misalignment_um=4.0", cases("torque_Nm = 90.0, misalignment_um = 0.0", "torque_Nm = 80.0"))
    found = [(each.name, each.label, each.torque_Nm, each.misalignment_um) for each in load_cases(with_list(scene))]
    assert found == [("b", "b", 80.0, 4.0), ("a", "a", 90.0, 0.0)]


def test_percents_beside_load_cases_are_refused() -> None:
    """The option is named, with its remedy."""
    with pytest.raises(SceneError, match=r"--percent: found \[50\] beside the .*; remedy: leave --percent out"):
        with_list(spur_scene(cases("torque_Nm = 90.0")), [50.0])


def test_scenes_are_those_of_the_percents() -> None:
    """85 and 170 N·m are 50 and 100 %: equal scenes, on meshes from 85 to 170 N·m, without their list."""
    parts = under_cases(with_list(spur_scene(), [100.0, 50.0]))
    named = under_cases(spur_scene(cases("torque_Nm = 170.0, speed_rpm = 900.0", "torque_Nm = 85.0")))
    assert list(parts.values()) == list(named.values())
    assert [each.load.mesh_torques_Nm for each in named.values()] == 2 * [(85.0, 170.0)]
    assert [each.load.torque_Nm for each in named.values()] == [85.0, 170.0]
    assert not any(each.load_case or each.load.percents for each in (*named.values(), *parts.values()))


def test_misaligned_load_case_is_the_misaligned_scene() -> None:
    """Equal to what a list of a scene with this misalignment has; the others are in space with it, as all share gears,
    which a sentence says. In the plane, without a misaligned one, there is none."""
    one = spur_scene(cases("torque_Nm = 90.0", "torque_Nm = 90.0, misalignment_um = 6.0"))
    other = spur_scene(cases("torque_Nm = 90.0", "torque_Nm = 90.0"), "pair.misalignment_um=6.0")
    plain, tilted = under_cases(one).values()
    assert [tilted, tilted] == list(under_cases(other).values())
    assert plain.exact.parts == ("plane",) and plain.pair.misalignment_um == 0.0
    assert not gear_problem(plain).is_plane and not gear_problem(tilted).is_plane
    (said,) = in_space_sentence(one, [plain, tilted])
    assert said.startswith("In space under all loads, as the pair is misaligned under some")
    flat = spur_scene(cases("torque_Nm = 90.0", "torque_Nm = 80.0"))
    assert all(gear_problem(each).is_plane for each in under_cases(flat).values())
    assert not list(in_space_sentence(flat, under_cases(flat).values()))
    assert not list(in_space_sentence(other, under_cases(other).values()))


@pytest.mark.parametrize(("torque", "why"), [("1e-9", "Hertz half-width"), ("9e5", "teeth bend by about")])
def test_a_torque_of_a_load_case_is_one_of_the_scene(torque: str, why: str) -> None:
    """Too small for a contact with a width, too large for small strains: its load case is named, before any command
    begins."""
    with pytest.raises(SceneError, match=rf": load_case\[1\]\.torque_Nm: found [^;]*\({why}.* for these gears"):
        spur_scene(cases("torque_Nm = 90.0", f"torque_Nm = {torque}"))
