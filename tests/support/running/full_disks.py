"""`evolvent run` on disks of many sizes: full_disks.py FOLDER STEP LAST [SETTING ...]; a script that a test runs.

Each disk is a tmpfs of STEP, 2 STEP, ... LAST kB, mounted at FOLDER, with foreign files. The runs follow one another in
this process. Prints one line of JSON per disk: size, status, stderr, state of the files, and the outcome of `--resume`
once there is room.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import subprocess
import sys
from pathlib import Path

from evidence.robustness.faults import SETTINGS
from evolvent.commands.app import main
from evolvent.results.archive.store import ArchiveError, read_arrays

THEIRS = ("out/photo.png", "out/pictures/photo.png", "out/results/measured.npz")
SCENE = ["run", "demos/he2022.toml", "--level", "quick", "--quiet"]


def mounted(folder: Path, kilobytes: int) -> None:
    """An empty file system of this size, or the same one with this size from now on."""
    remount = "remount," if folder.is_mount() else ""
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"{remount}size={kilobytes}k", "tmpfs", str(folder)], check=True)


def run(out: Path, *more: str) -> tuple[int, str]:
    """Exit status and stderr of a run."""
    errors = io.StringIO()
    with contextlib.redirect_stderr(errors):
        status = main([*SCENE, "--out", str(out), *more])
    return status, errors.getvalue()


def broken(out: Path) -> list[str]:
    """Incomplete files: parts, archives that cannot be read, texts without their end."""
    found, theirs = [], [out.parent / name for name in THEIRS]
    for path in (path for path in out.rglob("*") if path.is_file() and path not in theirs):
        if "evolvent-part" in path.name:
            found.append(path.name)
        elif path.suffix == ".npz":
            try:
                read_arrays(path)
            except ArchiveError:
                found.append(path.name)
        elif path.suffix in (".vtp", ".pvd") and not path.read_text(encoding="utf-8").rstrip().endswith("</VTKFile>"):
            found.append(path.name)
        elif path.suffix == ".json":
            json.loads(path.read_text(encoding="utf-8"))
    return found


def digests(folder: Path) -> list[str]:
    return [hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in THEIRS]


def disk(folder: Path, kilobytes: int, settings: list[str]) -> dict[str, object]:
    """Runs and resumes on one disk; see the module's docstring."""
    mounted(folder, kilobytes)
    try:
        for name in THEIRS:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(name, encoding="utf-8")
        before, out = digests(folder), folder / "out"
        status, errors = run(out, *settings)
        found = {
            "kB": kilobytes, "status": status, "stderr": errors, "broken": broken(out),
            "complete": (out / "summary.json").exists(), "kept": digests(folder) == before,
        }
        mounted(folder, 100_000)
        again, errors = run(out, "--resume", *settings)
        still = digests(folder) == before
        return found | {"resumed": again, "resumed stderr": errors, "whole": broken(out), "still": still}
    finally:
        subprocess.run(["umount", str(folder)], check=True)


if __name__ == "__main__":
    place, step, last = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    given = [word for setting in (*SETTINGS, *sys.argv[4:]) for word in ("--set", setting)]
    for size in range(step, last + 1, step):
        print(json.dumps(disk(place, size, given)), flush=True)
