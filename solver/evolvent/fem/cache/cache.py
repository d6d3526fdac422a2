"""The cache: values under the digest of all that they depend on, up to a number of bytes; those used least recently go.

A value of another program, other libraries or other inputs has another name, so that no value is ever out of date. The
folder is one that only this user may write to (`cache_directory`). Whatever goes wrong with it costs time alone: a
value that cannot be read is made again, one that cannot be written is not kept, and the log says so.
"""

from __future__ import annotations

import logging
import os
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeVar

from evolvent.fem.backend.cache_folder import CacheError, cache_directory
from evolvent.fem.cache.program import program_identity
from evolvent.fem.cache.value_coding import coded, decoded
from evolvent.fem.cache.value_files import WRITING, DamagedFile, read_about, read_value, write_value
from evolvent_meshes.digests import digest
from evolvent_meshes.errors import InputError

T = TypeVar("T")
FOLDER = "condensed"
"""Name of the cache folder."""
SUFFIX = ".values"
SIZE = "EVOLVENT_CACHE_GB"
"""Environment variable with the largest size of the cache [GB]; 0: nothing is read or kept."""
PART_OF_DISK, LEAST, MOST_OF_DISK = 0.1, 5e9, 0.5
"""Largest size where none is given: a tenth of the free disk with what the cache has already, but 5 GB if that is no
more than half of it. A pair at level quick can take 1.2 GB, and a cache that holds one gear alone is of no use."""
LEFT_OVER = 86400.0
"""Age from which on an unfinished file belongs to a program that was killed [s]."""


@dataclass(frozen=True)
class Entry:
    """A kept value."""

    path: Path
    """File of the value."""
    about: str
    """Description of the value."""
    size: int
    """Bytes of the file."""
    used: float
    """When it was read or written last [s since 1970]."""


@dataclass(frozen=True)
class Cache:
    """Values kept in files. All methods may be called by several processes at a time."""

    size_GB: float | None = None
    """Largest size; 0: nothing is read or kept; None: `PART_OF_DISK`."""

    @staticmethod
    def of_environment() -> Cache:
        """The cache with the size that the environment variable `SIZE` says. Raises InputError where it is no size."""
        given = os.environ.get(SIZE, "")
        if not given:
            return Cache()
        with suppress(ValueError):
            if 0.0 <= (size := float(given)) < float("inf"):
                return Cache(size)
        raise InputError(f"{SIZE}: wanted a size [GB], 0 or more, found {given!r}; correct it, or unset it")

    def kept(self, about: str, inputs: object, kind: type[T], make: Callable[[], T]) -> T:
        """The value for some inputs, read or, where there is none, made and kept.

        about: what it is, in words. inputs: all that it depends on beside the program, as `digest` takes it. kind: type
        of the value, see `coded`.
        """
        name = self.name(inputs)
        found = self.read(name, kind, about)
        if found is None:
            found = make()
            self.write(name, found, kind, about)
        return found

    def name(self, inputs: object) -> str:
        """Name of the value for some inputs; empty where nothing is kept."""
        return digest((program_identity(), inputs)) if self.folder else ""

    def read(self, name: str, kind: type[T], about: str) -> T | None:
        """The value of a name, its arrays read-only; None where there is none, where it cannot be read now, and where
        it is damaged, which is removed; the log says why. about: what it is, in words."""
        if not self.folder:
            return None
        path = self.folder / (name + SUFFIX)
        try:
            found = decoded(read_value(path), kind)
        except FileNotFoundError:
            return None
        except (OSError, MemoryError) as error:
            _log("not from the cache: %s (%s: %s)", about, path, error)
            return None
        except Exception as error:  # cattrs and NumPy raise whatever the bytes of another file lead them to
            reason = str(error) if isinstance(error, DamagedFile) else f"{type(error).__name__}: {error}"
            _log("%s: wanted %s, found a damaged file (%s); it is made again", path, about, reason)
            with suppress(OSError):
                path.unlink()
            return None
        with suppress(OSError):
            os.utime(path)
        _log("from the cache: %s", about)
        return found

    def write(self, name: str, value: T, kind: type[T], about: str) -> None:
        """Keeps a value; where that is not possible, the log says why."""
        if not self.folder:
            return
        try:
            content = coded(value, kind)
            need = sum(each.nbytes for each in content.arrays)
            if need > self.bound:
                _log("not kept: %s, %.0f MB of at most %.0f", about, need / 1e6, self.bound / 1e6)
                return
            self._make_room(self.bound - need)
            write_value(self.folder / (name + SUFFIX), content, {"about": about})
        except OSError as error:
            _log("not kept: %s (%s: %s)", about, self.folder, error.strerror or error)

    def entries(self) -> list[Entry]:
        """All values of any program, the one used last first."""
        found = []
        for path in self._files(SUFFIX):
            with suppress(OSError):  # another program has just removed it
                facts = path.stat()
                found.append(Entry(path, _about(path), facts.st_size, facts.st_mtime))
        return sorted(found, key=lambda each: -each.used)

    def clear(self) -> int:
        """Removes all values, and what killed programs have left; returns the bytes."""
        removed = 0
        for path in (*self._files(SUFFIX), *self._files(WRITING)):
            with suppress(OSError):
                size = path.stat().st_size
                path.unlink()
                removed += size
        return removed

    @cached_property
    def folder(self) -> Path | None:
        """Folder of the files; None where nothing is kept."""
        if self.size_GB == 0.0:
            return None
        with suppress(CacheError):
            return cache_directory(FOLDER)
        return None

    @property
    def bound(self) -> float:
        """Largest size [bytes]."""
        if self.size_GB is not None:
            return 1e9 * self.size_GB
        if self.folder is None:
            return 0.0
        disk = shutil.disk_usage(self.folder).free + sum(size for _, _, size in self._sizes())
        return max(PART_OF_DISK * disk, min(LEAST, MOST_OF_DISK * disk))

    def _make_room(self, bound: float) -> None:
        """Removes the values used least recently until the others have at most `bound` bytes."""
        for path in self._files(WRITING):
            with suppress(OSError):
                if time.time() - path.stat().st_mtime > LEFT_OVER:
                    path.unlink()
        found = sorted(self._sizes())
        total = sum(size for _, _, size in found)
        for _, path, size in found:
            if total <= bound:
                break
            with suppress(OSError):
                path.unlink()
            total -= size

    def _sizes(self) -> Iterator[tuple[float, Path, int]]:
        """When each file was used last, the file, its bytes."""
        for path in self._files(SUFFIX):
            with suppress(OSError):
                facts = path.stat()
                yield facts.st_mtime, path, facts.st_size

    def _files(self, suffix: str) -> list[Path]:
        return [] if self.folder is None else sorted(self.folder.glob(f"*{suffix}"))


NOT_KEPT = Cache(0.0)
"""A cache that reads and keeps nothing."""


def _about(path: Path) -> str:
    try:
        return str(read_about(path).get("about", ""))
    except (DamagedFile, OSError):
        return "damaged"


def _log(message: str, *values: object) -> None:
    logging.getLogger("evolvent").info(message, *values)
