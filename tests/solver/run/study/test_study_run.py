"""A study from start to finish, in this process: `evolvent check` of scenes of Zhang's pair, which takes no time."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import nullcontext
from pathlib import Path

import pytest

from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.run.study import study_run
from evolvent.run.study.results.scene_record import SceneRecord
from evolvent.run.study.scene_task import SceneTask, solve
from evolvent.run.study.study_run import NothingComputed, run_study
from evolvent_meshes.errors import InputError
from tests.support.running.study_cases import HEAD, TORQUES, study_of, table

FAILING = f"{HEAD}[grid]\nload.torque_Nm = [-1.0, 100.0]\n"


class Here:
    """In place of worker processes."""

    def __init__(self) -> None:
        self.names: list[str] = []

    def finished(self, tasks: Mapping[SceneTask, str]) -> Iterator[SceneRecord]:
        """Computes scenes in this process, and notes their names."""
        for task in tasks:
            self.names.append(task.name)
            yield solve(task)


HERE = Here()


@pytest.fixture
def computed() -> list[str]:
    """Names of the scenes that are computed, in this process."""
    HERE.names = []
    return HERE.names


@pytest.fixture
def not_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """No pictures, which take most of the time."""
    monkeypatch.setattr(study_run, "study_pictures", lambda values: [])


def run(folder: Path, text: str = TORQUES, overwrite: bool = False) -> list[str]:
    """A study into folder/out, what it says but for the count of scenes with warnings, which coarse meshes have."""
    said = run_study(study_of(folder, text), folder / "out", lambda: nullcontext(HERE), 1, overwrite, quiet=True)
    return [each for each in said if "scenes have warnings" not in each]


def test_scenes_with_warnings_are_counted(tmp_path: Path, computed: list[str], not_drawn: None) -> None:
    """The study ends with how many scenes have warnings, as coarse meshes do, and study.csv has the number of each."""
    said = run_study(study_of(tmp_path, TORQUES), tmp_path / "out", lambda: nullcontext(HERE), 1, False, quiet=True)
    assert [each for each in said if "3 of 3 scenes have warnings" in each]
    assert all(int(row["warnings"]) > 0 for row in table(tmp_path / "out"))


def test_table_has_a_row_a_scene(tmp_path: Path, computed: list[str]) -> None:
    """Three torques: Hertz pressure grows with their root, the contact ratio stays; a folder and a picture each."""
    assert run(tmp_path) == []
    rows = table(tmp_path / "out")
    assert [float(row["load.torque_Nm"]) for row in rows] == [100.0, 200.0, 300.0]
    pressures = [float(row["pitch_point_pressure_MPa"]) for row in rows]
    assert pressures[1:] == pytest.approx([pressures[0] * 2**0.5, pressures[0] * 3**0.5], rel=1e-8)
    assert len({row["transverse_contact_ratio"] for row in rows}) == 1
    assert {row["status"] for row in rows} == {"done"}
    assert all((tmp_path / "out" / row["folder"] / "check.txt").is_file() for row in rows)
    assert {path.name for path in (tmp_path / "out/pictures").iterdir()} == {
        "curves.png", "curves_MPa.png", "curves_mm.png"
    }


def test_scenes_that_are_there_are_not_computed_again(tmp_path: Path, computed: list[str]) -> None:
    """The same study: nothing. With one more value, and --overwrite for the other table: that one alone. The first
    study again: nothing, and its table is the same to the byte."""
    run(tmp_path)
    before, first = (tmp_path / "out/study.csv").read_bytes(), list(computed)
    run(tmp_path)
    assert computed == first and len(first) == 3
    run(tmp_path, TORQUES.replace("300.0", "300.0, 400.0"), overwrite=True)
    assert len(computed) == 4 and len(table(tmp_path / "out")) == 4
    run(tmp_path, overwrite=True)
    assert len(computed) == 4 and (tmp_path / "out/study.csv").read_bytes() == before


def test_the_table_is_there_from_the_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Before the first scene is done: all of them wait, one that is refused says so."""

    def stopped(*_: object) -> Iterator[SceneRecord]:
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(Here, "finished", stopped)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, FAILING)
    assert [row["status"] for row in table(tmp_path / "out")] == ["refused", "waiting"]


def test_a_folder_with_results_of_one_scene_is_refused(tmp_path: Path, computed: list[str]) -> None:
    """A table that another command has written there: refused, and nothing is written."""
    out = tmp_path / "out"
    RunFolder(out).write_text("strength.csv", "gear")
    with pytest.raises(FolderError, match=r"found strength\.csv, which a command for a single scene has written"):
        run(tmp_path, overwrite=True)
    assert computed == [] and sorted(path.name for path in out.iterdir()) == ["results", "strength.csv"]


def test_another_study_does_not_replace_the_table(tmp_path: Path, computed: list[str]) -> None:
    """Refused with what to do; files are as they were. Other figures of the same scenes are no other study."""
    run(tmp_path)
    before = (tmp_path / "out/study.csv").read_bytes()
    with pytest.raises(FolderError, match=r"found the table of another study.*--overwrite replaces"):
        run(tmp_path, TORQUES.replace("300.0", "400.0"))
    assert (tmp_path / "out/study.csv").read_bytes() == before
    run(tmp_path, f'figures = ["overlap_ratio"]\n{TORQUES}')
    assert list(table(tmp_path / "out")[0])[:3] == ["load.torque_Nm", "overlap_ratio", "status"]


def test_a_changed_table_is_not_replaced(tmp_path: Path, computed: list[str]) -> None:
    """Notes that a reader has written into the table stay, also with --overwrite."""
    run(tmp_path)
    path = tmp_path / "out/study.csv"
    path.write_text("my notes")
    with pytest.raises(FolderError, match=r"study\.csv"):
        run(tmp_path, overwrite=True)
    assert path.read_text() == "my notes"


def test_two_studies_at_once(tmp_path: Path, computed: list[str]) -> None:
    """A study into the folder of one that is going on is refused."""
    with locked(tmp_path / "out"), pytest.raises(FolderError, match="wanted a folder that no other run computes into"):
        run(tmp_path)
    assert computed == []


def test_what_fails_stands_in_the_table(tmp_path: Path, computed: list[str]) -> None:
    """A refused scene: its reason in the table and in a sentence; the other one is done."""
    (said,) = run(tmp_path, FAILING)
    assert said.startswith("1 of 2 scenes are not done (study.csv says why), the first one: load.torque_Nm: found -1")
    refused, done = table(tmp_path / "out")
    assert refused["status"] == "refused" and "a number above 0" in refused["reason"]
    assert done["status"] == "done" and done["reason"] == ""


def test_nothing_computed(tmp_path: Path, computed: list[str]) -> None:
    """Where the values of all scenes are refused the study ends with an error of its input, and nothing is written;
    where all scenes fail, with one of its results."""
    with pytest.raises(InputError, match=r"all of its 2 scenes are refused.*load\.torque_Nm: found -1"):
        run(tmp_path, FAILING.replace(", 100.0", ", -2.0"))
    assert not (tmp_path / "out").exists()
    one = TORQUES.replace(", 200.0, 300.0", "")
    folder = tmp_path / "other/out/scenes" / study_of(tmp_path, one).scenes[0].name
    folder.mkdir(parents=True)
    (folder / "check.txt").write_text("mine")
    with pytest.raises(NothingComputed, match="1 of 1 scenes are not done"):
        run(tmp_path / "other", one)


def test_a_failure_that_would_come_again_is_kept(tmp_path: Path, computed: list[str]) -> None:
    """A check of a scene whose folder holds a foreign file fails, and is tried again once that is gone; an input error
    of the computation itself is not tried again."""
    study = study_of(tmp_path)
    folder = tmp_path / "out/scenes" / study.scenes[0].name
    folder.mkdir(parents=True)
    (folder / "check.txt").write_text("mine")
    (said,) = run(tmp_path)
    assert said.startswith("1 of 3 scenes are not done") and (folder / "check.txt").read_text() == "mine"
    (folder / "check.txt").unlink()
    assert run(tmp_path) == [] and len(computed) == 4


def test_an_unknown_figure_is_named(tmp_path: Path) -> None:
    """With the nearest one."""
    with pytest.raises(ValueError, match="did you mean overlap_ratio"):
        study_of(tmp_path, f'figures = ["overlap_ratios"]\n{TORQUES}')
    with pytest.raises(ValueError, match="'overlap_ratio' twice"):
        study_of(tmp_path, f'figures = ["overlap_ratio", "overlap_ratio"]\n{TORQUES}')


def test_own_figures(tmp_path: Path, computed: list[str]) -> None:
    """A figure that the study itself describes is gathered after the others."""
    own = '[[figure]]\nname = "backlash_um"\nfile = "check.json"\ncolumn = "normal_backlash_um"\n'
    run(tmp_path, TORQUES + own)
    row = table(tmp_path / "out")[0]
    found = json.loads((tmp_path / "out" / row["folder"] / "check.json").read_text())
    assert float(row["backlash_um"]) == pytest.approx(found["normal_backlash_um"], rel=1e-8)


@pytest.mark.parametrize("name", ["status", "reason", "folder", "seconds", "transmission_error_peak_to_peak_um_error"])
def test_a_figure_does_not_replace_a_column(tmp_path: Path, name: str) -> None:
    """A figure of one's own with the name of a column that the table has: refused, with the figure's number."""
    own = f'[[figure]]\nname = "{name}"\nfile = "check.json"\ncolumn = "normal_backlash_um"\n'
    with pytest.raises(ValueError, match=rf"figure\[0\]\.name: found '{name}', another column of the table"):
        study_of(tmp_path, TORQUES.replace('"check"', '"excitation"') + own)


def test_a_figure_that_no_scene_has_is_said(tmp_path: Path, computed: list[str], not_drawn: None) -> None:
    """A column that does not exist: empty cells, and a sentence with the reason."""
    own = '[[figure]]\nname = "typo"\nfile = "check.json"\ncolumn = "no_such_column"\n'
    (said,) = run(tmp_path, TORQUES + own)
    assert said.startswith("figure typo: no number in 3 of 3 scenes, in scenes/")
    assert said.endswith(": check.json has no 'no_such_column'")
    assert {row["typo"] for row in table(tmp_path / "out")} == {"nan"}


def test_a_table_that_was_cut_off_is_said(tmp_path: Path, computed: list[str], not_drawn: None) -> None:
    """The table of a scene that is done was damaged: its cells are empty, and a sentence names the file for each figure
    by default."""
    run(tmp_path)
    path = tmp_path / "out" / table(tmp_path / "out")[1]["folder"] / "check.json"
    path.write_text(path.read_text()[:-20])
    said = run(tmp_path)
    assert len(said) == 5 and all("check.json is not there, or has no rows" in each for each in said)
    assert f"no number in 1 of 3 scenes, in scenes/{path.parent.name}" in said[0]


def test_pictures_of_others_stay(tmp_path: Path, computed: list[str]) -> None:
    """A picture of the user's beside those of the study is left alone; one in the place of the study's own, too, which
    is then not drawn, and said."""
    folder = tmp_path / "out/pictures"
    folder.mkdir(parents=True)
    for name in ("mine.png", "curves.png"):
        (folder / name).write_text("mine")
    (said,) = run(tmp_path)
    assert said.startswith("picture curves.png: not drawn")
    assert [(folder / name).read_text() for name in ("mine.png", "curves.png")] == ["mine", "mine"]
    assert (folder / "curves_MPa.png").stat().st_size > 1000


def forged() -> list[bytes]:
    """Contents that no study writes."""
    values = {"name": "?", "compute": 5, "status": "done", "reason": {}, "warnings": "abc", "seconds": "x"}
    return [b"", b"\0" * 50, bytes(range(256)), b"[]", b"5", b"null", b"NaN", b"[" * 100_000, b'{"a":' * 100_000,
            b"1" * 5000, json.dumps(values).encode(), b'{"names": 5}']


@pytest.mark.parametrize("content", forged())
def test_forged_records_are_computed_again(
    tmp_path: Path, computed: list[str], not_drawn: None, content: bytes
) -> None:
    """A record of a scene that a run seems to have written, but cannot be read: the scene is computed again, or has
    failed with the file's name; the study ends, and its other scenes are done."""
    run(tmp_path)
    folder = tmp_path / "out" / table(tmp_path / "out")[0]["folder"]
    RunFolder(folder).write("study_scene.json", content.replace(b"?", folder.name.encode()))
    before = table(tmp_path / "out")
    assert run(tmp_path) == [] and len(computed) == 4
    assert [{**row, "seconds": ""} for row in table(tmp_path / "out")] == [{**row, "seconds": ""} for row in before]


@pytest.mark.parametrize("content", forged())
def test_a_forged_note_of_the_table_is_another_study(
    tmp_path: Path, computed: list[str], not_drawn: None, content: bytes
) -> None:
    """study.json that cannot be read: refused with its name, and replaced by --overwrite."""
    run(tmp_path)
    RunFolder(tmp_path / "out").write("study.json", content)
    with pytest.raises(FolderError, match=r"another study, or of other values \(study\.json\)"):
        run(tmp_path)
    assert run(tmp_path, overwrite=True) == []


def test_a_directory_in_place_of_a_record(tmp_path: Path, computed: list[str], not_drawn: None) -> None:
    """The scene has failed with the path; the others are done."""
    run(tmp_path)
    row = table(tmp_path / "out")[0]
    record = tmp_path / "out" / row["folder"] / "study_scene.json"
    record.unlink()
    record.mkdir()
    with pytest.raises(FolderError, match=r"study_scene\.json"):
        run(tmp_path)
