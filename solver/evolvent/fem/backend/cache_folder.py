"""Where what can be made again is kept from run to run, also for a user without a home."""

from __future__ import annotations

import atexit
import logging
import os
import shutil
import stat
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path

from evolvent_meshes.errors import EvolventError


class CacheError(EvolventError, OSError):
    """There is no folder to keep things in."""


@cache
def cache_directory(name: str) -> Path:
    """A folder of this name in $XDG_CACHE_HOME/evolvent or ~/.cache/evolvent; where these cannot be written, in a
    folder of this user's below the temporary one, which the next run finds again. Raises CacheError where that cannot
    be written, either.
    """
    try:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
        return _writable(base / "evolvent" / name)
    except (OSError, RuntimeError):  # no home, or one that cannot be written: a container run as another user
        pass
    try:
        return _writable(_temporary() / name)
    except OSError as error:
        raise CacheError(
            f"{tempfile.gettempdir()}: wanted a folder for compiled forms, found {error.strerror or error}; name one "
            "that can be written to by XDG_CACHE_HOME"
        ) from error


def keep_fonts() -> None:
    """Matplotlib's list of fonts is made once, not in every run, for a user whose home cannot be written."""
    if "MPLCONFIGDIR" not in os.environ and not os.access(os.path.expanduser("~"), os.W_OK):
        with suppress(CacheError):  # only pictures need it, and matplotlib says so itself
            os.environ["MPLCONFIGDIR"] = str(cache_directory("matplotlib"))


@cache
def _temporary() -> Path:
    """This user's folder below the temporary one. What is loaded from it runs with this user's rights: where another
    one owns it or may write to it, a new one, removed at the end of the process."""
    folder = Path(tempfile.gettempdir()) / f"evolvent-{os.geteuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    if _is_private(folder):
        return folder
    own = Path(tempfile.mkdtemp(prefix="evolvent-cache-"))
    atexit.register(shutil.rmtree, own, ignore_errors=True)
    logging.getLogger("evolvent").warning(
        "%s: wanted a folder that only this user may write to, found one that others may; compiled forms are not kept. "
        "Remove it, or name another one by XDG_CACHE_HOME", folder,
    )  # fmt: skip
    return own


def _is_private(folder: Path) -> bool:
    """A folder, not a link to one, of this user, to which nobody else may write."""
    facts = folder.lstat()
    others = facts.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return stat.S_ISDIR(facts.st_mode) and facts.st_uid == os.geteuid() and not others


def _writable(directory: Path) -> Path:
    """The folder, made where it is missing. Raises OSError where it cannot be written."""
    directory.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryFile(dir=directory):
        return directory
