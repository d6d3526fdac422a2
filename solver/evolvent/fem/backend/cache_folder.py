"""Cache folder for compiled code and font lists, also for a user without a home directory.

What is loaded from there runs with the rights of this user. No folder is used to which another user may write, or in
which another user has left a file.
"""

from __future__ import annotations

import atexit
import logging
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

from evolvent_meshes.errors import EvolventError

ROOT = 0
"""User number of root, who may write everywhere."""
OTHERS_WRITE, OTHERS_SEARCH = stat.S_IWGRP | stat.S_IWOTH, stat.S_IXGRP | stat.S_IXOTH


class CacheError(EvolventError, OSError):
    """No cache folder can be written."""


@cache
def cache_directory(name: str) -> Path:
    """The cache folder `name`, created where it is missing.

    It lies in $XDG_CACHE_HOME/evolvent or ~/.cache/evolvent; where these cannot be written, or could be written by
    other users, which is logged, in a folder of this user below the temporary directory, which later runs use again.
    Raises CacheError where that cannot be written either.
    """
    with suppress(OSError, RuntimeError):  # no home directory, or one that may not be written to
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
        folder = _writable(base / "evolvent" / name).resolve()
        if not (reason := foreign_access(folder)):
            return folder
        _warn(folder, reason, "another folder is used")
    try:
        return _writable(_temporary() / name)
    except OSError as error:
        raise CacheError(
            f"{tempfile.gettempdir()}: wanted a folder for compiled forms, found {error.strerror or error}; name one "
            "that can be written to by XDG_CACHE_HOME"
        ) from error


def keep_fonts() -> None:
    """Let matplotlib keep its list of fonts in the cache folder where the home directory cannot be written."""
    home = os.path.expanduser("~")
    if "MPLCONFIGDIR" not in os.environ and not (os.path.isdir(home) and os.access(home, os.W_OK)):
        with suppress(CacheError):  # only figures need it, and matplotlib warns itself
            os.environ["MPLCONFIGDIR"] = str(cache_directory("matplotlib"))


def foreign_access(folder: Path) -> str:
    """How another user has or gets access to what this user loads from a folder; empty where none does.

    The folder and its files must belong to this user or to root, and no other user may write to them, nor exchange the
    folder: so it is with all folders above it, but for those in which only the owner of a file may rename it
    (sticky). The modes of files do not matter where no other user can reach them. Raises OSError.
    """
    real = folder.resolve()
    for above in real.parents:
        facts = above.lstat()
        exchangeable = facts.st_mode & OTHERS_WRITE and not facts.st_mode & stat.S_ISVTX
        if reason := _foreign(facts, exchangeable, _unmapped_owners()):
            return f"{above}, which {reason}"
    facts = real.lstat()
    if reason := _foreign(facts, facts.st_mode & OTHERS_WRITE):
        return f"one that {reason}"
    for path in _below(real):
        with suppress(FileNotFoundError):  # of a compilation that ends at this moment
            within = path.lstat()
            if reason := _foreign(within, facts.st_mode & OTHERS_SEARCH and within.st_mode & OTHERS_WRITE):
                return f"{path.relative_to(real)} in it, which {reason}"
            if not (stat.S_ISDIR(within.st_mode) or stat.S_ISREG(within.st_mode)):
                return f"{path.relative_to(real)} in it, which is no file"
    return ""


def _below(folder: Path) -> Iterator[Path]:
    """All files and folders below a folder."""
    for parent, folders, files in os.walk(folder):
        yield from (Path(parent, name) for name in (*folders, *files))


def _foreign(facts: os.stat_result, writable: int, owners: frozenset[int] = frozenset()) -> str:
    """Reason why a file or folder is not trusted: its owner, or other users who may write to it; empty where it is.

    owners: who may own it beside this user and root.
    """
    if facts.st_uid not in {os.geteuid(), ROOT, *owners}:
        return f"belongs to user {facts.st_uid}"
    return "other users may write to" if writable else ""


@cache
def _unmapped_owners() -> frozenset[int]:
    """Apparent owner of root's folders in a container that has no name for root: in a user namespace all users without
    a name have the same number."""
    try:
        everybody = Path("/proc/self/uid_map").read_text().split() == ["0", "0", str(2**32 - 1)]
        return frozenset() if everybody else frozenset({int(Path("/proc/sys/kernel/overflowuid").read_text())})
    except OSError:
        return frozenset()


@cache
def _temporary() -> Path:
    """The folder of this user below the temporary directory; where another user has access to it, a new one, which is
    removed at the end of the process."""
    folder = Path(tempfile.gettempdir()) / f"evolvent-{os.geteuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    reason = "a link" if folder.is_symlink() else foreign_access(folder)
    if not reason:
        return folder
    private = Path(tempfile.mkdtemp(prefix="evolvent-cache-"))
    atexit.register(shutil.rmtree, private, ignore_errors=True)
    _warn(folder, reason, "compiled forms are not kept")
    return private


def _warn(folder: Path, reason: str, instead: str) -> None:
    logging.getLogger("evolvent").warning(
        "warning: %s: wanted a folder that only this user may write to, found %s; nothing is loaded from it, %s. Take "
        "that right away (chmod go-w), remove it, or name another one by XDG_CACHE_HOME", folder, reason, instead,
    )


def _writable(directory: Path) -> Path:
    """The folder, created where it is missing, then for this user alone. Raises OSError where it cannot be written."""
    directory.parent.parent.mkdir(parents=True, exist_ok=True)
    for each in (directory.parent, directory):
        each.mkdir(mode=0o700, exist_ok=True)
    with tempfile.TemporaryFile(dir=directory):
        return directory
