"""Folders that a run must not write to: those with the results of other commands."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.results.archive.run_cost import Cost, write_cost
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.run.call import Options
from evolvent.run.folder_checks import begun_command, check_folder
from evolvent.run.kinds.all import KINDS, Kind
from evolvent.run.kinds.run import Run
from evolvent.run.kinds.strength import Strength
from tests.support.gear_cases import spur_scene


@pytest.mark.parametrize("name", ["strength.csv", "excitation.json", "results/transient_1500rpm_0.npz", "loads.csv"])
@pytest.mark.parametrize(("resume", "overwrite"), [(False, False), (True, False), (False, True)])
def test_results_of_other_commands_are_kept(tmp_path: Path, name: str, resume: bool, overwrite: bool) -> None:
    """A folder has the results of one command: with a file of another one it is refused, whatever the options, and that
    command is named. By these files folders of earlier versions are recognised."""
    RunFolder(tmp_path).write_text(name, "results")
    command = name.removeprefix("results/").partition(".")[0].partition("_")[0]
    with pytest.raises(FolderError, match=rf"found results of `evolvent {command}`"):
        check_folder(Run.of(spur_scene()), tmp_path, Options(resume, overwrite))
    assert (tmp_path / name).read_text(encoding="utf-8") == "results"


def test_run_beside_other_results_is_resumed(tmp_path: Path) -> None:
    """Results of `evolvent strength` in the folder of a run, as earlier versions took both: its cost is that of a run,
    so that `--resume` goes on, and removes nothing."""
    folder = RunFolder(tmp_path)
    folder.write_text("strength.csv", "results")
    folder.write_text("results/state.npz", "state")
    write_cost(folder, Cost())
    check_folder(Run.of(spur_scene()), tmp_path, Options(resume=True))


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_command_of_a_folder_is_written_down(tmp_path: Path, kind: Kind) -> None:
    """From the first file on, whichever command it is: other commands are refused."""
    write_cost(RunFolder(tmp_path), Cost(command=kind.command))
    assert begun_command(tmp_path) == kind.command
    other = Strength if kind.command == "run" else Run
    with pytest.raises(FolderError, match=rf"found results of `evolvent {kind.command}`"):
        check_folder(other.of(spur_scene()), tmp_path, Options(overwrite=True))
