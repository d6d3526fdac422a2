"""A coarse companion that fails: what costs the error bars, and what ends the command."""

from __future__ import annotations

import pytest

from evolvent.contact.newton.snes import NotConverged
from evolvent.results.archive.archive import ArchiveError
from evolvent.results.archive.run_folder import FolderError
from evolvent.run.companion import attempted
from evolvent_meshes.files import WriteError
from evolvent_meshes.mesh.mesh_data import MeshError


def failing(error: Exception) -> None:
    raise error


def test_solved_companion_has_its_value_and_no_reason() -> None:
    """The value as it is, with its wall time."""
    found = attempted(lambda: 3)
    assert (found.value, found.reason) == (3, "") and found.seconds >= 0.0


@pytest.mark.parametrize("kind", [NotConverged, MeshError])
def test_companion_that_cannot_be_solved_has_a_reason(kind: type[Exception]) -> None:
    """No value, and a sentence with the error's words."""
    found = attempted(lambda: failing(kind("no equilibrium")))
    assert (found.value, found.reason) == (
        None, "Error bars: their coarse companion could not be solved: no equilibrium")


@pytest.mark.parametrize("kind", [ArchiveError, FolderError, WriteError, KeyError, TypeError])
def test_files_and_bugs_end_the_command(kind: type[Exception]) -> None:
    """A folder that cannot be used, or a bug, is raised as what it is."""
    with pytest.raises(kind, match="as it is"):
        attempted(lambda: failing(kind("as it is")))
