"""Old names of keys and values: read from everywhere as the new ones, with a warning, and archives stay valid."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest

from evolvent.commands.app import main
from evolvent.results.archive.archive import Archive, fingerprint
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.store import arrays_bytes
from evolvent.run.call import Options
from evolvent.run.folder_checks import check_folder
from evolvent.run.kinds.run import Run
from evolvent.run.study.plan.study_file import load_study
from evolvent.run.study.plan.study_scenes import study_scenes
from evolvent.scene.scene import Scene, SceneError, kept_scene, scene_from_text, scene_from_values
from evolvent.scene.schema.errors import keys_of
from evolvent.scene.schema.old_names import RENAMED, new_names, unsaid
from tests.support.running.study_cases import HEAD, VERSION, written

PAIR = """
[pair]
normal_module_mm = 3.0
[pinion]
teeth = 20
face_width_mm = 10.0
[wheel]
teeth = 40
face_width_mm = 10.0
[load]
torque_Nm = 100.0
"""
OLD = f"""{PAIR}
[dynamics]
damped_apart = true
operating_rpm = 3000.0
coming = "down"
[skip]
off = ["window", "plane"]
"""
NEW = f"""{PAIR}
[dynamics]
damping_in_separation = true
operating_rpm = 3000.0
approach = "run_down"
[exact]
parts = ["window", "plane"]
"""
WARNINGS = [
    "dynamics.damped_apart is the old name of dynamics.damping_in_separation.",
    'dynamics.coming = "down" is the old spelling of dynamics.approach = "run_down".',
    "skip.off is the old name of exact.parts.",
]
FINGERPRINTS = {
    PAIR: "0d586ec5e96e1525a73bdd11ef2686f3e17b928b676814653bf11ac22d98fe22",
    OLD: "dac772bc6c5060e9130e4834efd4a059c64969cc4f161a6c42fcca484dc165d0",
}
"""Scene -> its fingerprint by commit f9e3ddc9, the last one that had the old names alone."""


def said(text: str, *overrides: str) -> tuple[Scene, list[str]]:
    """A scene and the warnings on it."""
    warned: list[str] = []
    return scene_from_text(text, overrides, warn=warned.append), warned


def test_old_names_in_a_file_are_read_as_the_new_ones() -> None:
    """Old names make the scene of the new ones, each with a sentence that has the new one; new names make none."""
    assert said(OLD) == (scene_from_text(NEW), WARNINGS)
    assert said(NEW)[1] == []
    warned: list[str] = []
    with pytest.raises(SceneError, match="torque_Nm: found nan"):
        scene_from_text(PAIR, ["load.torque_Nm=nan"], warn=warned.append)
    assert warned == []  # NaN differs from itself
    assert said(f"{PAIR}[skip]\n")[0] == said(PAIR)[0]  # an empty section was allowed


def test_written_scenes_have_new_names() -> None:
    """Reading them again says nothing."""
    scene, warned = said(said(OLD)[0].resolved_toml())
    assert scene == scene_from_text(NEW) and warned == []


def test_overrides_with_old_names_override_either_name() -> None:
    """--set goes before the file, whichever name either of them has."""
    for text in (OLD, NEW):
        for override, warns in (("skip.off=fields", True), ("exact.parts=fields", False)):
            scene, warned = said(text, override)
            assert scene.exact.parts == ("fields",)
            assert warned == [*(WARNINGS if text == OLD else []), *(WARNINGS[2:] if warns else [])]
    scene, warned = said(NEW, "dynamics.approach=up")
    assert scene.dynamics is not None and scene.dynamics.approach == "run_up"
    assert warned == ['dynamics.approach = "up" is the old spelling of dynamics.approach = "run_up".']


def test_values_of_python_warn_at_the_line() -> None:
    """A FutureWarning, which Python shows on stderr by default."""
    dynamics = {"operating_rpm": 3000.0, "coming": "down", "damping_in_separation": True}
    values = {**scene_from_text(PAIR).model_dump(exclude_none=True), "dynamics": dynamics}
    del values["exact"]
    with pytest.warns(FutureWarning, match="dynamics.approach") as caught:
        scene = scene_from_values({**values, "skip": {"off": ("window", "plane")}})
    assert scene == scene_from_text(NEW) and [Path(each.filename).name for each in caught] == [Path(__file__).name] * 2
    assert "coming" in dynamics  # the caller's values are as they were


@pytest.mark.parametrize(("old", "new", "value"), [
    ("dynamics.damped_apart", "dynamics.damping_in_separation", "true"),
    ("dynamics.coming", "dynamics.approach", '"up"'), ("skip.off", "exact.parts", "[]"),
])
def test_both_names_of_one_key_are_refused(old: str, new: str, value: str, tmp_path: Path) -> None:
    """In a file, in overrides, in a part of a study; the message has both names and what to delete."""
    message = f"{old}: found {new}, the new name of the same key, beside it; allowed: .*; remedy: delete {old}"
    both = [f"{name} = {value}" for name in (old, new)]
    with pytest.raises(SceneError, match=message):
        scene_from_text("\n".join([*both, PAIR]), warn=unsaid)
    with pytest.raises(SceneError, match=message):
        scene_from_text(PAIR, both, warn=unsaid)
    with pytest.raises(SceneError, match=message):
        load_study(written(tmp_path, "\n".join([HEAD, "[set]", *both])), unsaid)


def test_study_parameters_with_old_names(tmp_path: Path) -> None:
    """In each part of a study file: the scenes, their names and the columns are those of the new names."""
    base = f'leave_out = ["skip.off"]\n{HEAD}'
    old = f"{base}[set]\ndynamics.damped_apart = true\ndynamics.operating_rpm = 3000.0\n[grid]\ndynamics.coming = "
    text = old + '["up", "down"]\n[list]\nskip.off = [["window"], ["plane"]]\n'
    new = text.replace("damped_apart", "damping_in_separation").replace("skip.off", "exact.parts")
    new = new.replace('coming = ["up", "down"]', 'approach = ["run_up", "run_down"]')
    warned: list[str] = []
    path = written(tmp_path, text)
    found = study_scenes(load_study(path, warned.append), path, ("skip.off=window",), VERSION, warned.append)
    path = written(tmp_path, new)
    assert found == study_scenes(load_study(path), path, ("exact.parts=window",), VERSION)
    assert [each.refusal for each in found] == [""] * 4
    assert found[-1].parameters == {"dynamics.approach": "run_down", "exact.parts": ["plane"]}
    assert len(warned) == 5 and all(each.old in "".join(warned) for each in RENAMED)


def test_archives_of_earlier_versions_are_accepted(tmp_path: Path) -> None:
    """The fingerprint is that of the version with the old names, whichever name the scene has; plot and resume read the
    kept scene without a warning."""
    for text, wanted in FINGERPRINTS.items():
        assert fingerprint(scene_from_text(text, warn=unsaid)) == wanted
    assert fingerprint(scene_from_text(NEW)) == FINGERPRINTS[OLD]
    kept = arrays_bytes({"fingerprint": FINGERPRINTS[OLD], "complete": 1})
    RunFolder(tmp_path).write("results/state.npz", kept)
    (tmp_path / "scene.toml").write_text(OLD, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert Archive(tmp_path, kept_scene(tmp_path / "scene.toml")).holds_scene()
    assert Archive(tmp_path, scene_from_text(NEW)).holds_scene()


def test_kept_scene_of_an_earlier_version_is_resumed_where_it_lies(tmp_path: Path) -> None:
    """`run OUT/scene.toml --out OUT --resume`: the file says the same, and may be written anew; not one of another
    scene, nor one that was changed since."""
    path, scene = tmp_path / "scene.toml", scene_from_text(NEW)
    RunFolder(tmp_path).write_text("scene.toml", OLD)
    again = Options(resume=True, source=path)
    check_folder(Run.of(scene), tmp_path, again)
    with pytest.raises(FolderError, match="own file"):
        check_folder(Run.of(scene_from_text(NEW, ["load.torque_Nm=90"])), tmp_path, again)
    path.write_text(f"{OLD}# mine", encoding="utf-8")
    with pytest.raises(FolderError, match="own file"):
        check_folder(Run.of(scene), tmp_path, again)


def test_commands_say_the_new_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`check` prints each warning once on stderr; those of keys and that of the option."""
    path = tmp_path / "scene.toml"
    path.write_text(OLD, encoding="utf-8")
    assert main(["check", str(path), "--no-skip=one-sector", "--no-skip", "window"]) == 0
    out, err = capsys.readouterr()
    option = "--no-skip is the old name of --exact."
    assert err.splitlines() == [f"evolvent: warning: {each}" for each in (option, *WARNINGS)]
    assert out.split("Computed without simplification\n")[1].split("\n\n")[0].split() == ["one-sector,", "window"]


def test_new_names_are_keys() -> None:
    """Each new name is a key of the scene, no old name is."""
    keys = keys_of(Scene)
    assert all(each.new in keys and each.old not in keys for each in RENAMED)


def test_nan_is_no_old_spelling() -> None:
    """NaN is not equal to itself: under its present name a key warns of nothing, and the value is refused later."""
    said: list[str] = []
    assert list(new_names({"exact.parts": float("nan")}, said.append)) == ["exact.parts"]
    assert said == []
