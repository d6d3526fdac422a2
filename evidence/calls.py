"""Calls of computations whose results are not kept."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from mpi4py import MPI

from evolvent.results.archive.run_folder import RunFolder
from evolvent.run.call import Call, Options, opened_call

QUIET = Options(quiet=True)


@contextmanager
def temporary_call(folder: Path | None = None, options: Options = QUIET) -> Iterator[Call]:
    """A call of this rank alone. folder: where it stores results; None: in a folder that is removed at the end."""
    with TemporaryDirectory() as made, opened_call(
        "run", (), RunFolder(folder or Path(made)), MPI.COMM_SELF, options
    ) as call:
        yield call
