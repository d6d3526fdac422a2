"""A run removes and replaces only unchanged files written by runs; the lock of its folder."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

from evolvent.results.archive.run_folder import MANIFEST, FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent_meshes.errors import InputError
from evolvent_meshes.files import PART, WriteError, part_of, write_text
from tests.support.checkout import ROOT
from tests.support.run_parts import hashes

THEIRS = ("photo.png", "pictures/photo.png", "results/measured.npz", "fields/contact_mine.vtp", "worn_1000/a.txt")


@pytest.fixture
def folder(tmp_path: Path) -> RunFolder:
    """Files written by a run, with foreign files in the same folders."""
    made = RunFolder(tmp_path)
    for name in ("scene.toml", "results/state.npz", "pictures/02_flank_pressure.png", "fields/flanks_0007.vtp"):
        made.write_text(name, f"our {name}")
    worn = RunFolder(tmp_path / "worn_1000")
    worn.write_text("results/state.npz", "ours, worn")
    for name in THEIRS:
        write_text(tmp_path / name, f"their {name}")
    return made


def test_clear_removes_written_files_only(folder: RunFolder) -> None:
    """Files of worn pairs and fields of a longer run are removed; a photo among the pictures and measured data stay."""
    before = hashes(folder.out)
    folder.clear()
    assert hashes(folder.out) == {name: before[name] for name in THEIRS}
    assert not (folder.out / MANIFEST).exists()


def test_clear_removes_empty_folders(tmp_path: Path) -> None:
    """OUT/results and other folders of a run are removed with their last file."""
    made = RunFolder(tmp_path)
    made.write_text("results/state.npz", "a")
    made.clear()
    assert not list(tmp_path.iterdir())


def test_clear_keeps_the_files_named(folder: RunFolder) -> None:
    """The scene stays, and still counts as written by a run."""
    scene = folder.out / "scene.toml"
    folder.clear(keep=[scene])
    assert scene.read_text() == "our scene.toml"
    assert folder.is_written(scene)


def test_changed_file_is_foreign(folder: RunFolder) -> None:
    """A picture that was edited after the run is neither replaced nor removed."""
    path = folder.out / "pictures/02_flank_pressure.png"
    path.write_text("painted over", encoding="utf-8")
    with pytest.raises(FolderError, match=r"02_flank_pressure\.png, found a file of this name that no run has written"):
        folder.write_text("pictures/02_flank_pressure.png", "new")
    folder.clear()
    assert path.read_text(encoding="utf-8") == "painted over"


def test_link_is_foreign(folder: RunFolder, tmp_path: Path) -> None:
    """A link in place of a written file, even to the same content: its target is not written, the link not removed."""
    target = tmp_path / "elsewhere.toml"
    (folder.out / "scene.toml").rename(target)
    (folder.out / "scene.toml").symlink_to(target)
    with pytest.raises(FolderError):
        folder.write_text("scene.toml", "new")
    folder.clear()
    assert target.read_text() == "our scene.toml"
    assert (folder.out / "scene.toml").is_symlink()


def test_linked_folder_is_refused(folder: RunFolder, tmp_path: Path) -> None:
    """A link named results to the results of another run: neither removed, nor written over, nor added to."""
    other = RunFolder(tmp_path / "other")
    (other.out).mkdir()
    (other.out / "results").symlink_to(folder.out / "results")
    before, listed = hashes(folder.out), (folder.out / MANIFEST).read_bytes()
    with pytest.raises(FolderError, match="the link results to"):
        other.require_free(["results/*.npz"])
    for name in ("results/state.npz", "results/new.npz"):
        with pytest.raises(FolderError):
            other.write_text(name, "new")
    other.clear()
    assert hashes(folder.out) == before
    assert (folder.out / MANIFEST).read_bytes() == listed


def test_file_with_the_same_content_is_not_written_again(folder: RunFolder) -> None:
    """A written file with the same content keeps its modification time."""
    path = folder.out / "scene.toml"
    os.utime(path, (1.0, 1.0))
    folder.write_text("scene.toml", "our scene.toml")
    assert path.stat().st_mtime == 1.0


def test_foreign_files_are_found_in_all_folders_of_a_run(folder: RunFolder) -> None:
    """They are found in the folders where runs write, those of worn pairs among them; temporary files do not count."""
    write_text(folder.out / "deep/in/there.txt", "x")
    part_of(folder.out / "results/state.npz").write_text("half", encoding="utf-8")
    names = {path.relative_to(folder.out).as_posix() for path in folder.foreign_files()}
    assert names == set(THEIRS)


def test_temporary_files_of_a_killed_run_are_removed(folder: RunFolder) -> None:
    """A temporary file of a killed run is removed."""
    part_of(folder.out / "results/state.npz").write_text("half", encoding="utf-8")
    folder.remove_parts()
    assert not [path for path in folder.out.rglob("*") if PART in path.name]


@pytest.mark.parametrize("cut", [1, 20, 60])
def test_incomplete_line_of_the_manifest_is_skipped(cut: int, folder: RunFolder) -> None:
    """A run killed while it lists a file: entries before and after the incomplete line are read."""
    path = folder.out / MANIFEST
    folder.write_text("results/gears.npz", "last")
    path.write_bytes(path.read_bytes()[:-cut])
    folder.write_text("summary.json", "next")
    assert folder.is_written(folder.out / "summary.json")
    assert folder.is_written(folder.out / "fields/flanks_0007.vtp")


def test_manifest_names_no_file_outside_its_folder(tmp_path: Path) -> None:
    """A file outside the folder does not count as written, even if the manifest lists it as ../mine."""
    (tmp_path / "mine").write_text("x", encoding="utf-8")
    out = tmp_path / "out"
    made = RunFolder(out)
    made.write_text("results/a", "x")
    digest = hashlib.sha256(b"x").hexdigest()
    with open(out / MANIFEST, "a", encoding="utf-8") as stream:
        stream.write(f'\n{{"path": "../mine", "sha256": "{digest}"}}\n')
    made.clear()
    assert (tmp_path / "mine").exists()


@pytest.mark.parametrize(
    "line",
    ['{"path": "/etc/passwd", "sha256": "DIGEST"}', '{"path": "' + "x" * 5000 + '", "sha256": "a"}',
     '{"path": "a\\u0000b", "sha256": "a"}', '{"path": 5, "sha256": []}', '{"path": "a", "sha256": []}', "[]", "5",
     "[" * 100_000, '{"a":' * 100_000],
)
def test_forged_lines_of_the_manifest_are_skipped(line: str, folder: RunFolder) -> None:
    """Absolute paths with the digest of their file, paths that no file can have, other types, nested without end."""
    before = folder.written_files()
    digest = hashlib.sha256(Path("/etc/passwd").read_bytes()).hexdigest()
    with open(folder.out / MANIFEST, "a") as manifest:
        manifest.write(f"\n{line.replace('DIGEST', digest)}\n")
    assert folder.written_files() == before
    folder.clear()
    assert not (folder.out / "scene.toml").exists() and Path("/etc/passwd").exists()


def test_a_manifest_that_is_a_link_is_not_written_to(tmp_path: Path) -> None:
    """A link that leads nowhere, in place of the manifest: refused, and nothing is made where it leads."""
    (tmp_path / "out/results").mkdir(parents=True)
    (tmp_path / "out" / MANIFEST).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(FolderError, match="found a link to"):
        RunFolder(tmp_path / "out").write_text("scene.toml", "ours")
    assert not (tmp_path / "elsewhere").exists() and not (tmp_path / "out/scene.toml").exists()


def test_full_disk_leaves_the_manifest_as_it_was(folder: RunFolder, monkeypatch: pytest.MonkeyPatch) -> None:
    """No space for a file's line: WriteError; neither the line nor the file is written, and earlier lines stay."""
    before = (folder.out / MANIFEST).read_bytes()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("evolvent.results.archive.run_folder.os.fsync", full)
    with pytest.raises(WriteError, match=r"evolvent-files\.jsonl: wanted to write"):
        folder.write_text("summary.json", "new")
    assert (folder.out / MANIFEST).read_bytes() == before
    assert not (folder.out / "summary.json").exists()


HOLD = """
import sys
from pathlib import Path
from evolvent.results.archive.run_lock import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""


def test_lock_names_its_owner_and_ends_with_it(tmp_path: Path) -> None:
    """A second run is refused with the name of the first; after kill -9 of the first one the lock is free."""
    out, root = tmp_path / "out", ROOT
    with subprocess.Popen(
        [sys.executable, "-c", HOLD, str(out)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=root
    ) as first:
        assert first.stdout is not None and first.stdout.readline() == "held\n"
        owner = rf"found process {first.pid} of .* on .*since"
        with pytest.raises(FolderError, match=owner), locked(out):
            pass
        first.kill()
        first.wait()
        with locked(out):
            pass
    assert not out.exists() or not list(out.iterdir())


@pytest.mark.parametrize("place", ["dangling", "file/out", "/dev/null", "/proc/out", "x" * 300, "a\0b", "file"])
def test_lock_refuses_impossible_folders(place: str, tmp_path: Path) -> None:
    """Below a file, a device, where nobody may, a name that is too long: InputError, and nothing is made."""
    (tmp_path / "file").write_text("", encoding="utf-8")
    (tmp_path / "dangling").symlink_to(tmp_path / "nowhere")
    message = r"--out: found .*; allowed: a directory that can be made and written"
    with pytest.raises(InputError, match=message), locked(tmp_path / place):
        pass
    assert sorted(path.name for path in tmp_path.iterdir()) == ["dangling", "file"]


def test_lock_removes_the_empty_folder_that_it_created(tmp_path: Path) -> None:
    """A folder that was created for a run that writes nothing is removed."""
    with locked(tmp_path / "a" / "b"):
        pass
    assert not list(tmp_path.iterdir())
