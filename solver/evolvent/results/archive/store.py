"""Archives of arrays below OUT: files (.npz), each with the identity of its scene.

A call that goes on from them refuses those of another scene, of another version, and files that are none. A file is
written under a temporary name and then renamed, so that a call killed at any moment leaves whole files only.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from evolvent.results.archive.run_folder import RunFolder
from evolvent_meshes.errors import InputError
from evolvent_meshes.files import open_file

Arrays = dict[str, Any]
T = TypeVar("T")


class ArchiveError(InputError):
    """A file of arrays that cannot be read or belongs to another scene."""


@dataclass(frozen=True)
class Store:
    """Files of arrays that belong to one scene. Only rank 0 uses it, or each rank its own files."""

    folder: RunFolder
    """Folder OUT of the call."""
    identity: str
    """SHA-256 of everything that the arrays depend on."""
    another: Callable[[Path], str]
    """Message on a file with another identity: wanted, given, remedy."""
    key: str = "identity"
    """Name of the array in a file that holds its identity."""

    def holds(self, name: str) -> bool:
        """Whether there is a file of this identity. Raises ArchiveError where it cannot be read."""
        path = self.folder.out / name
        return path.exists() and self._is_own(read_arrays(path))

    def read(self, name: str, decoded: Callable[[Arrays], T]) -> T | None:
        """The content of a file; None where there is no file.

        decoded: makes it from the arrays; KeyError of a missing one is taken for a file of another version.

        Raises ArchiveError where the file cannot be read or belongs to another scene or version.
        """
        path = self.folder.out / name
        if not path.exists():
            return None
        arrays = read_arrays(path)
        if not self._is_own(arrays):
            raise ArchiveError(self.another(path))
        return _content(path, arrays, decoded)

    def write(self, name: str, arrays: Mapping[str, Any]) -> None:
        """Writes a file atomically and durably. Raises WriteError, FolderError."""
        self.folder.write(name, arrays_bytes({self.key: self.identity, **arrays}))

    def _is_own(self, arrays: Arrays) -> bool:
        return str(arrays.get(self.key)) == self.identity


def read_as(path: Path, decoded: Callable[[Arrays], T]) -> T:
    """The content of a file, whatever its identity, see `Store.read`. Raises ArchiveError."""
    return _content(path, read_arrays(path), decoded)


def _content(path: Path, arrays: Arrays, decoded: Callable[[Arrays], T]) -> T:
    try:
        return decoded(arrays)
    except KeyError as missing:
        raise ArchiveError(
            f"{path}: wanted results of this version of Evolvent, found some without {missing}; compute anew with "
            "--overwrite"
        ) from missing


def arrays_bytes(arrays: Mapping[str, Any]) -> memoryview:
    """The content of a NumPy archive (.npz) with these arrays."""
    content = io.BytesIO()
    np.savez(content, **{name.replace("/", "|"): value for name, value in arrays.items()})
    return content.getbuffer()


def read_arrays(path: Path) -> Arrays:
    """The arrays of an archive written from `arrays_bytes`. Raises ArchiveError."""
    try:
        with open_file(path) as file, np.load(file, allow_pickle=False) as archive:
            return {name.replace("|", "/"): archive[name] for name in archive.files}
    except Exception as error:  # NumPy and zipfile raise whatever the bytes of another file lead them to
        remedy = "move or remove it, then compute" if path.exists() else "compute"
        raise ArchiveError(
            f"{path}: wanted a results file, found none that can be read ({error}); {remedy} anew with --overwrite"
        ) from error
