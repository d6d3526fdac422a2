"""A scene of a study, computed in this process."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from evolvent.results.archive.run_lock import locked
from evolvent.run.study import scene_task
from evolvent.run.study.results.scene_record import RECORD, read_record, scene_folder
from evolvent.run.study.scene_task import SceneTask, solve
from evolvent_meshes.errors import EvolventError, ResultError
from tests.support.running.study_cases import TORQUES, scenes_of


@pytest.fixture
def task(tmp_path: Path) -> SceneTask:
    """A check of Zhang's pair."""
    first = scenes_of(tmp_path, TORQUES)[0]
    assert first.scene is not None
    return SceneTask(first.name, scene_folder(tmp_path, first.name), "check", first.scene)


def test_record_is_kept(task: SceneTask) -> None:
    """Computed once: the second call reads the record. One that is cut off, or of another name, is none."""
    record = solve(task)
    assert record.status == "done" and read_record(task.folder) == record == solve(task)
    path = task.folder / RECORD.name
    text = path.read_text()
    path.write_text(text[:-20])
    assert read_record(task.folder) is None
    path.write_text(text.replace(task.name, "0" * 16))
    assert read_record(task.folder) is None


@pytest.mark.parametrize(
    ("error", "kept"),
    [(ResultError("does not converge"), True), (EvolventError("out of memory"), False), (OSError(28, "full"), False)],
)
def test_failures(task: SceneTask, monkeypatch: pytest.MonkeyPatch, error: Exception, kept: bool) -> None:
    """What would be found again is kept; what is of the machine is tried again the next time."""

    def fails(*_: object) -> list[str]:
        raise error

    monkeypatch.setattr(scene_task, "run_check", fails)
    record = solve(task)
    assert record.status == "failed" and record.reason == str(error)
    assert (read_record(task.folder) == record) is kept


def test_too_little_memory(task: SceneTask) -> None:
    """A million scenes at once do not fit into any machine: the scene fails by its input. A share of 0 is not
    checked."""
    many = replace(task, compute="run", share_of_memory=1_000_000)
    with pytest.raises(ValueError, match="degrees of freedom that want about"):
        scene_task._require_room(many)
    scene_task._require_room(replace(many, share_of_memory=0))


def test_a_folder_in_use_is_waited_for(task: SceneTask, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another process writes to the folder for half a second: then the scene is computed."""
    monkeypatch.setattr(scene_task, "GLANCE", 0.05)
    free_at: list[float] = []
    entered = threading.Event()

    def other() -> None:
        with locked(task.folder):
            entered.set()
            time.sleep(0.5)
            free_at.append(time.monotonic())

    thread = threading.Thread(target=other)
    thread.start()
    entered.wait()
    assert solve(task).status == "done" and time.monotonic() > free_at[0]
    thread.join()
