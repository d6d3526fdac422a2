"""Compilation of forms by FFCx: cache folder, one process at a time, no messages of the compiler.

FFCx 0.4 (Debian 12) adds a handler to the root logger when it is imported; later versions exchange its handlers while
they compile. Both compile by setuptools, which sets that logger to INFO and adds handlers where there are none
(`setuptools.logging.configure`), so that every command of the compiler is shown. All of them redirect Python's warnings
to the logging, where they are lost if it has no handler. Here the logging of an application stays as it was.
"""

from __future__ import annotations

import errno
import fcntl
import logging
import os
import shutil
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from evolvent.fem.backend.cache_folder import cache_directory
from evolvent.fem.backend.compiler_options import refused_options
from evolvent.fem.backend.foreign_settings import no_options_files
from evolvent_meshes.errors import EvolventError

COMPILER_PACKAGES = ("distutils", "_distutils", "setuptools")
COMPILER_ERRORS = ("VerificationError", "CompileError", "LinkError")
FULL, FORBIDDEN = {errno.ENOSPC, errno.EDQUOT}, {errno.EACCES, errno.EPERM, errno.EROFS}
LEAST_ROOM = 1_000_000  # bytes; a form's library has a tenth of it


class CompileError(EvolventError, OSError):
    """A form could not be compiled or stored."""


@contextmanager
def logging_kept() -> Iterator[None]:
    """Context after which the root logger has its previous level and handlers, and warnings their previous target.

    Where FFCx was imported before and redirected warnings to a logging without handlers, they are shown again.
    """
    root = logging.getLogger()
    level, handlers, showing, earlier = root.level, list(root.handlers), warnings.showwarning, "ffcx" in sys.modules
    try:
        yield
    finally:
        root.setLevel(level)
        root.handlers[:] = handlers
        if warnings.showwarning is not showing or (earlier and not _warnings_are_heard()):
            logging.captureWarnings(False)


def _warnings_are_heard() -> bool:
    loggers = logging.getLogger("py.warnings"), logging.getLogger()
    return any(not isinstance(each, logging.NullHandler) for logger in loggers for each in logger.handlers)


def form_directory(version: str) -> Path:
    """Folder of the forms compiled by this version of dolfinx. Raises CacheError."""
    return cache_directory(f"dolfinx-{version}")


@contextmanager
def compiling(version: str) -> Iterator[None]:
    """Context in which forms are compiled, by one process at a time.

    FFCx alone waits for the compilation of another process and gives up after a while.

    version: of dolfinx.
    Raises CacheError; CompileError where there is no room, no right to write or no compiler.
    """
    directory = form_directory(version)
    try:
        with open(directory / "lock", "w") as lock, _silent_compiler(), no_options_files():
            fcntl.flock(lock, fcntl.LOCK_EX)
            _remove_half_written(directory)
            yield
    except Exception as error:
        if cause := _cause(error, directory):
            raise CompileError(f"{directory}: wanted to keep compiled forms there, found {cause}") from error
        raise


def _remove_half_written(directory: Path) -> None:
    """Remove unfinished compilations. Under the lock they are left over from runs that were killed or had no room."""
    unfinished = [source for source in directory.glob("*.c") if not source.with_suffix(".c.cached").exists()]
    for path in (*unfinished, *directory.glob("*.c.~*"), *directory.glob("*.c.failed")):
        path.unlink()


@contextmanager
def _silent_compiler() -> Iterator[None]:
    """Filter the messages of distutils and setuptools out of the root logger; all others pass."""
    root = logging.getLogger()
    level = root.level

    def of_others(record: logging.LogRecord) -> bool:
        return record.levelno >= level and not set(COMPILER_PACKAGES) & set(Path(record.pathname).parts)

    with logging_kept():
        root.addFilter(of_others)
        try:
            yield
        finally:
            root.removeFilter(of_others)


def _cause(error: BaseException | None, directory: Path) -> str:
    """The cause of an error in the folder or the compiler, with its remedy; empty for an error of another kind."""
    remedy = "name another folder by XDG_CACHE_HOME"
    known: list[BaseException] = []
    while error is not None and error not in known:
        known.append(error)
        error = error.__cause__ or error.__context__
    numbers = {each.errno for each in known if isinstance(each, OSError) and _lies_in(each.filename, directory)}
    failed = [each for each in known if type(each).__name__ in COMPILER_ERRORS]
    room = shutil.disk_usage(directory).free
    if numbers & FULL or (failed and room < LEAST_ROOM):
        return f"{room / 1e6:.1f} MB left on its disk; free some, or {remedy}"
    if failed:
        return refused_options() or f"{failed[-1]}; install a C compiler (packages/install does)"
    if numbers & FORBIDDEN:
        return f"no right to write; {remedy}"
    return ""


def _lies_in(name: object, directory: Path) -> bool:
    """Whether an error is about a file of the folder, or names none: that of another place has another remedy."""
    return not isinstance(name, (str, bytes)) or Path(os.fsdecode(name)).is_relative_to(directory)
