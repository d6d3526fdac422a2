"""Files written atomically, folders that do not outlive their use, paths that are not files."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from evolvent_meshes.errors import InputError
from evolvent_meshes.files import NoFile, WriteError, folder_for, open_file, require_writable, write_text


def test_file_is_written_completely_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No room on the disk: WriteError with file, size and remedy; the previous content is there, and no other file."""
    path = write_text(tmp_path / "table.csv", "before")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("evolvent_meshes.files.os.fsync", full)
    with pytest.raises(WriteError, match=r"table\.csv: wanted to write 2e-06 MB, found No space left .*; make room"):
        write_text(path, "ab")
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_text() == "before"


def test_named_pipe_is_refused(tmp_path: Path) -> None:
    """NoFile; the pipe has a writer here, so that a failure does not block (without one: tests/solver/test_malformed).
    """
    os.mkfifo(tmp_path / "pipe")
    writer = os.open(tmp_path / "pipe", os.O_RDWR)
    with pytest.raises(NoFile, match="a named pipe"), open_file(tmp_path / "pipe"):
        pass
    os.close(writer)


def test_empty_folder_is_removed_again(tmp_path: Path) -> None:
    """Folders made for a file that is not written are gone after the block; one with a file stays."""
    with folder_for(tmp_path / "a/b"):
        assert (tmp_path / "a/b").is_dir()
    assert not (tmp_path / "a").exists()
    with folder_for(tmp_path / "a/b"):
        write_text(tmp_path / "a/b/c", "x")
    assert (tmp_path / "a/b/c").read_text() == "x"


def test_path_below_a_file_is_refused(tmp_path: Path) -> None:
    """A file in place of a folder: InputError that names the option; a writable path leaves nothing behind."""
    write_text(tmp_path / "file", "x")
    with pytest.raises(InputError, match=r"--out: found .*allowed: a directory"):
        require_writable(tmp_path / "file/table.csv")
    require_writable(tmp_path / "folder/table.csv")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file"]
