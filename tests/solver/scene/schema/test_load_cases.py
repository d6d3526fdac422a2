"""The sections [[load_case]]: what is refused, in words; what is written is read again."""

from __future__ import annotations

import re

import pytest

from evolvent.run.study.plan.study_file import StudyFile
from evolvent.scene.scene import Scene, SceneError, scene_from_text
from evolvent.scene.schema.errors import key_problem, problems_of
from tests.support.running.scene_effects import BARE

TWO = 'load_case=[{name = "a", torque_Nm = 50.0}, {name = "b", torque_Nm = 80.0}]'


def listed(*cases: str) -> Scene:
    """The bare scene with load cases, the keys of each in TOML."""
    return scene_from_text(BARE, [f"load_case=[{', '.join(f'{{{each}}}' for each in cases)}]"])


def said(*cases: str) -> list[str]:
    """What is said of load cases that are refused."""
    with pytest.raises(SceneError) as caught:
        listed(*cases)
    return [str(each) for each in caught.value.problems]


@pytest.mark.parametrize(("keys", "words"), [
    ("torque_Nm = 5.0", "load_case[0].name: found nothing; allowed: a text of up to 40 letters"),
    ('name = "a"', "load_case[0].torque_Nm: found nothing; allowed: a number above 0 up to 1e7, in N·m"),
    ('name = "a/b", torque_Nm = 5.0', 'load_case[0].name: found "a/b"; allowed: a text of up to 40 letters'),
    ('name = "..", torque_Nm = 5.0', 'load_case[0].name: found ".."'),
    ('name = "_", torque_Nm = 5.0', 'load_case[0].name: found "_"'),
    ('name = "", torque_Nm = 5.0', 'load_case[0].name: found ""'),
    (f'name = "{41 * "a"}", torque_Nm = 5.0', "load_case[0].name: found "),
    ('name = "a", torque_Nm = 0.0', "load_case[0].torque_Nm: found 0; allowed: a number above 0"),
    ('name = "a", torque_Nm = 5.0, speed_rpm = -1.0', "load_case[0].speed_rpm: found -1"),
    ('name = "a", torque_Nm = 5.0, share_of_life = 60.0', "load_case[0].share_of_life: found 60; allowed: a"),
    ('name = "a", torque_Nm = 5.0, misalignment_um = 2e3', "load_case[0].misalignment_um: found 2000"),
    ('name = "a", torque_Nm = 5.0, rpm = 100.0', "load_case[0].rpm: found an unknown key, 100"),
])
def test_a_wrong_load_case_is_named_with_its_number(keys: str, words: str) -> None:
    """A key that is missing, not allowed or unknown: its load case, counted from 0, and what is allowed."""
    (problem,) = said(keys)
    assert problem.startswith(words)


def test_names_are_different_folders() -> None:
    """Problem: two load cases of one name, also in capitals, as some disks have one folder of both."""
    for second in ("start", "START"):
        (problem,) = said('name = "start", torque_Nm = 5.0', f'name = "{second}", torque_Nm = 6.0')
        assert problem.startswith(f'load_case[1].name: found "{second}", which load_case[0] is called, too')


def test_shares_add_up_to_one() -> None:
    """Thirds to seven digits do; 0.5 and 0.4 have a sum of 0.9; a share in one of two load cases alone is refused."""
    third = [f'name = "{name}", torque_Nm = 5.0, share_of_life = 0.3333333' for name in "abc"]
    assert [each.share_of_life for each in listed(*third).load_case] == 3 * [0.3333333]
    (problem,) = said(*(f'name = "{share}", torque_Nm = 5.0, share_of_life = {share}' for share in (0.5, 0.4)))
    assert problem.startswith("load_case.share_of_life: found a sum of 0.9; allowed: shares with a sum of 1")
    (problem,) = said('name = "a", torque_Nm = 5.0, share_of_life = 1.0', 'name = "b", torque_Nm = 6.0')
    assert problem.startswith("load_case.share_of_life: found none in b, but one in others")


def test_there_is_one_list() -> None:
    """Beside load.percents; more load cases than torques of a list."""
    with pytest.raises(SceneError, match=r"load_case: found load cases, and load\.percents = \[50, 100\] beside them"):
        scene_from_text(BARE, [TWO, "load.percents=[50.0, 100.0]"])
    (problem,) = said(*(f'name = "n{number}", torque_Nm = {number}.0' for number in range(10, 41)))
    assert problem.startswith("load_case: found 31 load cases; allowed: up to 30, each of which costs a run")


@pytest.mark.parametrize("text", [
    "[[loads]]\ntorque_Nm = 5.0", "[[case]]\ntorque_Nm = 5.0", "[[load_cases]]\ntorque_Nm = 5.0",
    '["duty cycle"]\ntorque_Nm = 5.0', "[load_spectrum]\ntorque_Nm = 5.0",
])
def test_other_names_of_the_list_are_known(text: str) -> None:
    """Sections that are called otherwise; [loads], of one section, is [load]."""
    with pytest.raises(SceneError, match=re.escape("did you mean load_case (a section [[load_case]] for each load)?")):
        scene_from_text(f"{BARE}{text}\n")
    with pytest.raises(SceneError, match=r"did you mean load\?"):
        scene_from_text(f"{BARE}[loads]\ntorque_Nm = 5.0\n")


@pytest.mark.parametrize(("value", "remedy"), [
    ("{torque_Nm = 5.0}", "write [[load_case]] in place of [load_case]"), ("5.0", "write [[load_case]] in place of"),
    ("[5.0, 6.0]", "write [[load_case]] above its keys"),
])
def test_what_is_no_list_of_sections(value: str, remedy: str) -> None:
    """A section, a number, a list of torques."""
    with pytest.raises(SceneError, match=re.escape(remedy)):
        scene_from_text(BARE, [f"load_case={value}"])


def test_load_cases_are_written_and_read() -> None:
    """A list with all keys and with none but those required, behind each other: the same scene. Without load cases
    their keys are comments."""
    full = 'name = "a", torque_Nm = 5.0, speed_rpm = 1e3, share_of_life = 0.25, misalignment_um = -3.0'
    scene = listed(full, 'name = "b", torque_Nm = 6.0, share_of_life = 0.75')
    text = scene.resolved_toml()
    assert text.count("\n[[load_case]]\n") == 2 and scene_from_text(text) == scene
    assert "\n# [[load_case]]: not given\n# name: not given" in scene_from_text(BARE).resolved_toml()


def test_a_key_of_one_load_case_is_not_set_from_outside() -> None:
    """By --set, and by a study: neither says which load case is meant."""
    with pytest.raises(SceneError, match=r"a key below load_case, which has the value \[a section with keys"):
        scene_from_text(BARE, [TWO, "load_case.torque_Nm=60.0"])
    problem = key_problem("load_case.torque_Nm", [50.0, 60.0], Scene)
    assert problem is not None and problem.allowed == "keys of sections that there is one of"
    with pytest.raises(ValueError, match="scene") as caught:
        StudyFile.model_validate({"scene": "s.toml", "grid": {"load_case": {"torque_Nm": [50.0, 60.0]}}})
    (said,) = problems_of(caught.value, StudyFile)  # type: ignore[arg-type]
    assert said.key == "grid.load_case.torque_Nm"
