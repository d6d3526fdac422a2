"""Runs that are kept for a page, and read again."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from evidence.pages.papers.kept_runs.runs import Runs
from evidence.processes import RunFailed

WRITES = (
    "import pathlib, sys; folder = pathlib.Path(sys.argv[-1]); folder.mkdir(exist_ok=True); "
    "file = folder / 'end.txt'; file.write_text((file.read_text() if file.exists() else '') + sys.argv[1])"
)


def ended(out: Path, setting: str) -> str:
    """What runs with a setting have left in the folder so far."""
    folder, cost = Runs(out).ended("case", "end.txt", sys.executable, "-c", WRITES, setting)
    assert cost.wall > 0.0
    return (folder / "end.txt").read_text(encoding="utf-8")


def test_a_run_that_has_ended_is_read_again(tmp_path: Path) -> None:
    """Twice the same command: it ran once."""
    assert [ended(tmp_path, "a"), ended(tmp_path, "a")] == ["a", "a"]


def test_a_run_of_another_command_is_not(tmp_path: Path) -> None:
    """Another setting, and a folder of which nobody knows the command: refused, and what is there stays."""
    assert ended(tmp_path, "a") == "a"
    with pytest.raises(RunFailed, match="wanted a run of"):
        ended(tmp_path, "b")
    (tmp_path / "case.command.txt").unlink()
    with pytest.raises(RunFailed, match="unknown command"):
        ended(tmp_path, "a")
    assert (tmp_path / "case/end.txt").read_text(encoding="utf-8") == "a"


def test_a_run_goes_on_from_another_one(tmp_path: Path) -> None:
    """On a copy of the folder of a run that has ended, which stays as it is."""
    assert ended(tmp_path, "a") == "a"
    folder, _ = Runs(tmp_path).ended("next", "end.txt", sys.executable, "-c", WRITES, "b", after="case")
    assert (folder / "end.txt").read_text(encoding="utf-8") == "ab"
    assert (tmp_path / "case/end.txt").read_text(encoding="utf-8") == "a"
