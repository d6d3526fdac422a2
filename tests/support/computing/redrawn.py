"""Pictures of a command beside those that `evolvent plot` draws from its folder."""

from __future__ import annotations

from pathlib import Path
from shutil import copytree, rmtree

from evolvent.commands.app import main


def redrawn(out: Path, scratch: Path) -> set[str]:
    """Names of the pictures of a folder, all of which `evolvent plot` draws in a copy of it, byte by byte as they were.
    Animations are left out. Raises AssertionError where it does not."""
    copy = copytree(out, scratch / "copy")
    before = _pictures(copy)
    rmtree(copy / "pictures")
    assert main(["plot", str(copy)]) == 0
    after = _pictures(copy)
    assert before.keys() == after.keys()
    assert [name for name, content in before.items() if content != after[name]] == []
    return set(before)


def _pictures(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("pictures/*.png")}
