"""The output folder OUT, which may hold other files: those written by runs are listed, all others are left alone.

    OUT/results/evolvent-files.jsonl   the manifest: one line a written file with its path below OUT and its SHA-256

A file counts as written by a run if a line of the manifest has its path and its content. All others are foreign files,
those changed after they were written among them.
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
WORN = "worn_*"
"""Folders of worn pairs, each with its own manifest."""
FOLDERS = (".", "results", "fields", "pictures")
"""Folders in which a run writes. Others are not searched: OUT may be a home directory with a million files."""
LONGEST = 200
"""Length that no name of a file of a run reaches [characters]."""
NAMED = 5
"""Largest number of files that a message names."""


class FolderError(InputError):
    """A folder that a run may not write to; its files are unchanged."""


@dataclass(frozen=True)
class RunFolder:
    """The output folder of a run."""

    out: Path
    """Path of the folder OUT."""

    def write(self, name: str | Path, content: bytes | memoryview) -> Path:
        """Writes OUT/name and lists it; returns its path. A file that a run wrote with the same content is left as it
        is. Raises WriteError; FolderError where a foreign file has this name."""
        path = self.out / name
        self.require_not_foreign([path])
        digest = _digest(content)
        if path.exists() and _digest(path.read_bytes()) == digest:
            return path
        self._list(path, digest)
        return write_bytes(path, content)

    def write_text(self, name: str | Path, text: str) -> Path:
        """Writes a text as UTF-8, as `write` does."""
        return self.write(name, text.encode("utf-8"))

    def is_written(self, path: Path) -> bool:
        """Whether a run wrote this file and its content is unchanged."""
        digests = self._digests().get(self._name(path), set())
        if not digests or self._linked(path) or not path.is_file():
            return False
        return path == self.out / LOG or _digest(path.read_bytes()) in digests

    def require_not_foreign(self, paths: Iterable[Path]) -> None:
        """Raises FolderError where one of these paths is a foreign file, or lies in a folder that is a link."""
        foreign = [path for path in paths if (path.exists() or self._linked(path)) and not self.is_written(path)]
        if foreign:
            raise FolderError(
                f"{self.out}: wanted to write {', '.join(self._name(path) for path in foreign[:NAMED])}, found "
                f"{_files(len(foreign))} of this name that no run has written, or that was changed since; "
                f"move or remove {_all_of(foreign)}, or name another folder with --out"
            )

    def require_free(self, patterns: Iterable[str]) -> None:
        """Raises FolderError where a foreign file has a name that a run writes. patterns: globs below OUT."""
        links = [self.out / folder for folder in FOLDERS[1:] if (self.out / folder).is_symlink()]
        if links:
            raise FolderError(
                f"{self.out}: wanted folders of its own for what a run writes, found the link {self._name(links[0])} "
                f"to {links[0].readlink()}; what lies there may be another run's: name another folder with --out"
            )
        self.require_not_foreign(path for pattern in patterns for path in sorted(self.out.glob(pattern)))

    def changed_files(self, patterns: Iterable[str]) -> list[Path]:
        """Files written by a run whose content was changed or truncated since. patterns: globs below OUT."""
        listed = self._digests()
        paths = (path for pattern in patterns for path in sorted(self.out.glob(pattern)))
        return [path for path in paths if self._name(path) in listed and not self.is_written(path)]

    def written_files(self) -> list[Path]:
        """All files written by runs, the last written first."""
        return [path for name in reversed(self._digests()) if self.is_written(path := self.out / name)]

    def foreign_files(self) -> list[Path]:
        """All other files in the folders in which a run writes."""
        known = {*self.written_files(), self.out / MANIFEST}
        here = (path for folder in FOLDERS for path in sorted((self.out / folder).glob("*")))
        files = [path for path in here if path.is_file() and PART not in path.name and path != self.out / LOCK]
        below = [path for worn in self._worn() for path in worn.foreign_files()]
        return [path for path in files if path not in known] + below

    def clear(self, keep: Collection[Path] = ()) -> None:
        """Removes the files written by runs, the last written first, except the log and `keep`; then empty folders.
        Raises OSError."""
        if self._linked(self.out / MANIFEST):
            return
        kept, remaining = {path.resolve() for path in keep}, [self.out / LOG]
        for worn in self._worn():
            worn.clear(keep)
        for path in self.written_files():
            if path.resolve() in kept:
                remaining.append(path)
            elif path != self.out / LOG:
                path.unlink()
        self._reduce_manifest(remaining)
        for folder in FOLDERS[1:]:
            with contextlib.suppress(OSError):  # not empty, or missing
                (self.out / folder).rmdir()

    def remove(self, names: Iterable[str]) -> None:
        """Removes those of the files OUT/name that runs have written. Raises OSError."""
        gone = [path for name in names if self.is_written(path := self.out / name)]
        for path in gone:
            path.unlink()
        if gone:
            self._reduce_manifest([self.out / LOG, *self.written_files()])

    def remove_parts(self) -> None:
        """Removes temporary files that a killed run left."""
        for folder in FOLDERS:
            for path in (self.out / folder).glob(f".*{PART}*"):
                path.unlink(missing_ok=True)
        for worn in self._worn():
            worn.remove_parts()

    def list_log(self) -> None:
        """Lists the log. As it grows it is identified by its name alone. Raises WriteError."""
        self._list(self.out / LOG, _digest(b""))

    def _worn(self) -> Iterator[RunFolder]:
        """The folders of worn pairs."""
        for path in sorted(self.out.glob(WORN)):
            if (path / MANIFEST).is_file():
                yield RunFolder(path)

    def _linked(self, path: Path) -> bool:
        """Whether a file, or a folder between it and OUT, is a link; its target is not the run's."""
        between = path.relative_to(self.out).parents
        return path.is_symlink() or any((self.out / part).is_symlink() for part in between if part != Path())

    def _name(self, path: Path) -> str:
        return path.relative_to(self.out).as_posix()

    def _digests(self) -> dict[str, set[str]]:
        """Name -> SHA-256 of every content written under it, in the order of the last writing. Raises FolderError."""
        digests: dict[str, set[str]] = {}
        for line in self._lines():
            with contextlib.suppress(ValueError, KeyError, TypeError, RecursionError):  # a killed run left a part
                entry = json.loads(line)
                if _is_below(entry["path"]):
                    digests[entry["path"]] = digests.pop(entry["path"], set()) | {entry["sha256"]}
        return digests

    def _lines(self) -> list[str]:
        """Lines of the manifest. Raises FolderError."""
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

    def _reduce_manifest(self, remaining: Collection[Path]) -> None:
        """Writes the manifest anew with the entries of these files only; removes it where there are none."""
        manifest, names = self.out / MANIFEST, {self._name(path) for path in remaining}
        entries = [_entry(name, digest) for name, all_ in self._digests().items() if name in names for digest in all_]
        if entries:
            write_bytes(manifest, b"".join(entries))
        else:
            manifest.unlink(missing_ok=True)

    def _list(self, path: Path, digest: str) -> None:
        """Adds a file to the manifest, before it is written: a listed file that is missing does no harm. Raises
        WriteError."""
        line, manifest = _entry(self._name(path), digest), self.out / MANIFEST
        if manifest.is_symlink():
            raise FolderError(
                f"{manifest}: found a link to {manifest.readlink()}; wanted the list of what runs have made here, or "
                "no file; move or remove it, or name another folder with --out"
            )
        try:
            manifest.parent.mkdir(parents=True, exist_ok=True)
            _append(manifest, line)
        except OSError as error:
            raise write_error(manifest, len(line), error) from error


def _is_below(name: str) -> bool:
    """Whether a name is that of a file below the folder, as a run writes it."""
    path = Path(name)
    return not path.is_absolute() and ".." not in path.parts and all(len(part) < LONGEST for part in path.parts)


def _entry(name: str, digest: str) -> bytes:
    """A line of the manifest; the leading newline ends an incomplete line of a killed run."""
    return ("\n" + json.dumps({"path": name, "sha256": digest}, ensure_ascii=False) + "\n").encode()


def _append(path: Path, line: bytes) -> None:
    """Appends a line to a file durably: the whole line, or nothing if that fails. Raises OSError."""
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
    """Names of the files, of many the first NAMED and the number of others."""
    more = f" and {len(paths) - NAMED} more" if len(paths) > NAMED else ""
    return ", ".join(map(str, paths[:NAMED])) + more


def _files(count: int) -> str:
    return "a file" if count == 1 else f"{count} files"
