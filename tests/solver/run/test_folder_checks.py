"""Folders that a run must not write to: those with the results of other commands."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.run.folder_checks import check_folder
from tests.support.gear_cases import spur_scene


@pytest.mark.parametrize("name", ["strength.csv", "excitation.json", "results/transient_static.npz", "loads.csv"])
@pytest.mark.parametrize(("resume", "overwrite"), [(False, False), (True, False), (False, True)])
def test_results_of_other_commands_are_kept(tmp_path: Path, name: str, resume: bool, overwrite: bool) -> None:
    """A run that begins anew removes all that is listed in its folder: with a file of another command it is refused,
    whatever its options, and the file is named."""
    RunFolder(tmp_path).write_text(name, "results")
    with pytest.raises(FolderError, match=rf"found {name}, of another command"):
        check_folder(spur_scene(), tmp_path, resume, overwrite, None)
    assert (tmp_path / name).read_text(encoding="utf-8") == "results"


def test_run_beside_other_results_is_resumed(tmp_path: Path) -> None:
    """Results of `evolvent strength` in the folder of a run: `--resume` removes nothing and goes on."""
    folder = RunFolder(tmp_path)
    folder.write_text("strength.csv", "results")
    folder.write_text("results/state.npz", "state")
    check_folder(spur_scene(), tmp_path, True, False, None)
