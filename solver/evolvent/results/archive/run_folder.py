"""The folder of a run, in which other files may lie too: what our runs have made is listed, all else is left alone.

    OUT/results/evolvent-files.jsonl   a line for each file when it was written: its path below OUT and its SHA-256

A file is ours if a line of the manifest has its path and its content; one that somebody has changed since is theirs.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import os
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from evolvent_meshes.errors import InputError
from evolvent_meshes.files import PART, open_file, write_bytes, write_error

MANIFEST = Path("results/evolvent-files.jsonl")
LOG = Path("run.log")
LOCK = Path(".evolvent.lock")
WORN = "worn_*"  # folders of worn pairs, each with a manifest of its own
FOLDERS = (".", "results", "fields", "pictures")
"""Where a run writes. Others below OUT, which may be a home with a million files, are not looked into."""

NAMED = 5  # files in a message


class FolderError(InputError):
    """A folder that a run may not write to as it is; nothing in it has been touched."""


@dataclass(frozen=True)
class RunFolder:
    """The folder OUT of a run."""

    out: Path

    def write(self, name: str | Path, content: bytes | memoryview) -> Path:
        """Writes OUT/name and lists it; gives its path. Ours with this very content is left as it is. Raises
        WriteError, FolderError where a file that is not ours has this name."""
        path = self.out / name
        self.require_ours([path])
        digest = _digest(content)
        if path.exists() and _digest(path.read_bytes()) == digest:
            return path
        self._list(path, digest)
        return write_bytes(path, content)

    def write_text(self, name: str | Path, text: str) -> Path:
        """`write` of a text as UTF-8."""
        return self.write(name, text.encode("utf-8"))

    def is_ours(self, path: Path) -> bool:
        """Whether a run has made this file, and nobody has changed it."""
        made = self._made().get(self._name(path), set())
        if not made or self._linked(path) or not path.is_file():
            return False
        return path == self.out / LOG or _digest(path.read_bytes()) in made

    def require_ours(self, paths: Iterable[Path]) -> None:
        """Raises FolderError where one of these exists and is not ours, or lies in a folder that is a link."""
        theirs = [path for path in paths if (path.exists() or self._linked(path)) and not self.is_ours(path)]
        if theirs:
            raise FolderError(
                f"{self.out}: wanted to write {', '.join(self._name(path) for path in theirs[:NAMED])}, found "
                f"{_files(len(theirs))} of this name that no run has made, or that somebody has changed since; "
                f"move or remove {_all_of(theirs)}, or name another folder with --out"
            )

    def require_free(self, patterns: Iterable[str]) -> None:
        """Raises FolderError where a file that is not ours has a name that a run writes (globs below OUT)."""
        links = [self.out / folder for folder in FOLDERS[1:] if (self.out / folder).is_symlink()]
        if links:
            raise FolderError(
                f"{self.out}: wanted folders of its own for what a run writes, found the link {self._name(links[0])} "
                f"to {links[0].readlink()}; what lies there may be another run's: name another folder with --out"
            )
        self.require_ours(path for pattern in patterns for path in sorted(self.out.glob(pattern)))

    def changed(self, patterns: Iterable[str]) -> list[Path]:
        """Files of these names (globs below OUT) that a run has made and somebody has changed, or cut off, since."""
        made = self._made()
        found = (path for pattern in patterns for path in sorted(self.out.glob(pattern)))
        return [path for path in found if self._name(path) in made and not self.is_ours(path)]

    def ours(self) -> list[Path]:
        """All files that are here and ours, the last written first."""
        return [path for name in reversed(self._made()) if self.is_ours(path := self.out / name)]

    def theirs(self) -> list[Path]:
        """All other files where a run writes."""
        known = {*self.ours(), self.out / MANIFEST}
        here = (path for folder in FOLDERS for path in sorted((self.out / folder).glob("*")))
        files = [path for path in here if path.is_file() and PART not in path.name and path != self.out / LOCK]
        below = [path for worn in self._worn() for path in worn.theirs()]
        return [path for path in files if path not in known] + below

    def clear(self, keep: Collection[Path] = ()) -> None:
        """Removes what our runs have made, the newest first, and folders that are then empty; but for the log and
        `keep`. Raises OSError."""
        if self._linked(self.out / MANIFEST):
            return
        kept, stays = {path.resolve() for path in keep}, [self.out / LOG]
        for worn in self._worn():
            worn.clear(keep)
        for path in self.ours():
            if path.resolve() in kept:
                stays.append(path)
            elif path != self.out / LOG:
                path.unlink()
        self._forget_all_but(stays)
        for folder in FOLDERS[1:]:
            with contextlib.suppress(OSError):  # not empty, or not there
                (self.out / folder).rmdir()

    def remove_parts(self) -> None:
        """Removes files that a killed run was writing."""
        for folder in FOLDERS:
            for path in (self.out / folder).glob(f".*{PART}*"):
                path.unlink(missing_ok=True)
        for worn in self._worn():
            worn.remove_parts()

    def list_log(self) -> None:
        """The log, which grows, is ours by its name."""
        self._list(self.out / LOG, _digest(b""))

    def _worn(self) -> Iterator[RunFolder]:
        for path in sorted(self.out.glob(WORN)):
            if (path / MANIFEST).is_file():
                yield RunFolder(path)

    def _linked(self, path: Path) -> bool:
        """Whether a file, or a folder between it and OUT, is a link: what it leads to is somebody's."""
        between = path.relative_to(self.out).parents
        return path.is_symlink() or any((self.out / part).is_symlink() for part in between if part != Path())

    def _name(self, path: Path) -> str:
        return path.relative_to(self.out).as_posix()

    def _made(self) -> dict[str, set[str]]:
        """Name -> SHA-256 of all that was ever written under it, in the order of the last writing."""
        made: dict[str, set[str]] = {}
        for line in self._lines():
            with contextlib.suppress(ValueError, KeyError, TypeError):  # the last line of a killed run
                entry = json.loads(line)
                if ".." not in Path(entry["path"]).parts:
                    made[entry["path"]] = made.pop(entry["path"], set()) | {entry["sha256"]}
        return made

    def _lines(self) -> list[str]:
        """Of the manifest. Raises FolderError."""
        path = self.out / MANIFEST
        try:
            with open_file(path) as file:
                return file.read().decode("utf-8", errors="replace").splitlines()
        except FileNotFoundError:
            return []
        except OSError as error:
            raise FolderError(
                f"{path}: wanted the list of what runs have made here, found {error.strerror}; name another folder "
                "with --out, or mend its access"
            ) from error

    def _forget_all_but(self, stays: Collection[Path]) -> None:
        manifest, names = self.out / MANIFEST, {self._name(path) for path in stays}
        entries = [_entry(name, digest) for name, all_ in self._made().items() if name in names for digest in all_]
        if entries:
            write_bytes(manifest, b"".join(entries))
        else:
            manifest.unlink(missing_ok=True)

    def _list(self, path: Path, digest: str) -> None:
        """Before the file itself is there: one that is listed and missing does no harm. Raises WriteError."""
        line, manifest = _entry(self._name(path), digest), self.out / MANIFEST
        try:
            manifest.parent.mkdir(parents=True, exist_ok=True)
            _append(manifest, line)
        except OSError as error:
            raise write_error(manifest, len(line), error) from error


def _entry(name: str, digest: str) -> bytes:
    """A line; it begins anew where a killed run has left half of one."""
    return ("\n" + json.dumps({"path": name, "sha256": digest}, ensure_ascii=False) + "\n").encode()


def _append(path: Path, line: bytes) -> None:
    """All of the line or nothing of it, on the disk. Raises OSError."""
    with open(path, "ab", buffering=0) as stream:
        before = stream.tell()
        try:
            if stream.write(line) != len(line):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            os.fsync(stream.fileno())
        except OSError:
            stream.truncate(before)
            raise


def _digest(content: bytes | memoryview) -> str:
    return hashlib.sha256(content).hexdigest()


def _all_of(paths: Sequence[Path]) -> str:
    """Their names, of many the first."""
    more = f" and {len(paths) - NAMED} more" if len(paths) > NAMED else ""
    return ", ".join(map(str, paths[:NAMED])) + more


def _files(count: int) -> str:
    return "a file" if count == 1 else f"{count} files"
