"""OUT/run.log: buffered until the gears are meshed, so that bad input leaves no file behind."""

from __future__ import annotations

import contextlib
import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from evolvent.results.archive.run_folder import LOG, RunFolder
from evolvent_meshes.errors import InputError

if TYPE_CHECKING:
    from mpi4py import MPI

LOGGER = "evolvent"
"""Name of the standard logger to which all modules log; the log file of a run is a handler of it."""


class LogFile(logging.Handler):
    """A handler that buffers its lines until `begin`, then writes these and all later ones to OUT/run.log.

    A disk without room for the log does not end the run: one message on stderr says where the log ends.
    """

    def __init__(self, folder: RunFolder, append: bool, label: str | None = "") -> None:
        super().__init__()
        self._label = label
        self.setFormatter(logging.Formatter("%(asctime)s  %(message)s", "%H:%M:%S"))
        self._folder, self._mode, self._held = folder, "a" if append else "w", list[str]()
        self._begun = self._lost = False

    @property
    def path(self) -> Path:
        """Path of OUT/run.log."""
        return self._folder.out / LOG

    def begin(self) -> None:
        """Opens the file and writes the buffered lines; further calls do nothing."""
        if not self._begun:
            self._begun = True
            self._guarded(self._open)

    def emit(self, record: logging.LogRecord) -> None:
        """Buffers or writes a line; a warning is printed on stderr, too, whichever module it comes from."""
        line = self.format(record) + "\n"
        if record.levelno == logging.WARNING and self._label is not None:
            label = f"{self._label}: " if self._label else ""
            print(f"evolvent: {label}{record.getMessage()}", file=sys.stderr)
        if self._begun:
            self._guarded(lambda: self._append(line))
        else:
            self._held.append(line)

    def _open(self) -> None:
        self._folder.list_log()
        with open(self.path, self._mode, encoding="utf-8", errors="backslashreplace") as stream:  # names of files
            stream.writelines(self._held)

    def _append(self, line: str) -> None:
        with open(self.path, "a", encoding="utf-8", errors="backslashreplace") as stream:
            stream.write(line)

    def _guarded(self, write: Callable[[], None]) -> None:
        if self._lost:
            return
        try:
            write()
        except OSError as error:
            self._lost = True
            print(f"evolvent: {self.path}: the log ends here ({error}); the run continues", file=sys.stderr)


class RunLog:
    """The log of a run: a file on rank 0, nothing on the other ranks.

    warnings: all warnings so far, a sentence each.
    """

    def __init__(self, handler: LogFile | None) -> None:
        self._handler, self._logger = handler, logging.getLogger(LOGGER)
        self.warnings: list[str] = []

    def open(self) -> None:
        """Opens the log file: from now on the run writes files."""
        if self._handler is not None:
            self._handler.begin()

    def info(self, message: str, *values: object) -> None:
        """Writes a line to the log."""
        self._logger.info(message, *values)

    def warning(self, message: str) -> None:
        """Writes a line to the log and prints it on stderr."""
        self.warnings.append(message)
        self._logger.warning("warning: %s", message)

    def error(self, message: str, *values: object) -> None:
        """Writes the reason for which the run ended to the log."""
        self._logger.error(message, *values)


@contextmanager
def logged(folder: RunFolder, comm: MPI.Comm, resumed: bool, label: str | None = "") -> Iterator[RunLog]:
    """Context with the log of a run. Where the run fails, its last line is the reason. Within the log of a run of
    several, lines go to the inner one alone.

    resumed: append to the file.
    label: name in front of the warnings that are printed; None: they are not printed.

    Collective over `comm`.
    """
    logger = logging.getLogger(LOGGER)
    level, propagate, outer = logger.level, logger.propagate, list(logger.handlers)
    logger.setLevel(logging.INFO)
    logger.propagate = False
    handler: logging.Handler = LogFile(folder, resumed, label) if comm.rank == 0 else logging.NullHandler()
    log = RunLog(handler if isinstance(handler, LogFile) else None)
    logger.handlers = [handler]
    try:
        yield log
    except BaseException as error:
        if not isinstance(error, InputError):
            log.open()
        with contextlib.suppress(Exception):
            log.error("%s", str(error) if isinstance(error, KeyboardInterrupt) else f"failed: {error}")
        raise
    finally:
        logger.handlers = outer
        handler.close()
        logger.setLevel(level)
        logger.propagate = propagate
