"""Solution of a coarse companion. Its failure costs the error bars only: results are not lost for it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from evolvent.results.archive.archive import ArchiveError
from evolvent.results.archive.run_folder import FolderError
from evolvent_meshes.errors import EvolventError
from evolvent_meshes.files import WriteError

T = TypeVar("T")


@dataclass(frozen=True)
class Attempt(Generic[T]):
    """Outcome of solving a coarse companion."""

    value: T | None = None
    """Solution of the companion; None where it failed or was not asked for."""
    reason: str = ""
    """Why the solution failed, as a sentence; empty where it did not."""
    seconds: float = 0.0
    """Wall time of the solution [s]."""


@dataclass(frozen=True)
class WithCompanion(Generic[T]):
    """A solution, and that of its coarse companion."""

    fine: T
    """Solution on the meshes of the scene."""
    coarse: Attempt[T]
    """Solution on the meshes of the error bars."""


def attempted(solve: Callable[[], T]) -> Attempt[T]:
    """Solves a companion. Collective: `solve` fails on all ranks together.

    An error of meshing or solving becomes the `reason`. Raises ArchiveError, FolderError and WriteError, because the
    results of the folder are in doubt, too; every other exception is a bug and is raised.
    """
    begin = time.perf_counter()
    try:
        value, reason = solve(), ""
    except (ArchiveError, FolderError, WriteError):
        raise
    except EvolventError as error:
        value, reason = None, f"Error bars: their coarse companion could not be solved: {error}"
    return Attempt(value, reason, time.perf_counter() - begin)
