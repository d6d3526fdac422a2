"""Cache folder for compiled forms and font lists, also for a user without a home directory."""

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
    """No cache folder can be written."""


@cache
def cache_directory(name: str) -> Path:
    """The cache folder `name`, created where it is missing.

    It lies in $XDG_CACHE_HOME/evolvent or ~/.cache/evolvent; where these cannot be written, in a folder of this user
    below the temporary directory, which later runs use again. Raises CacheError where that cannot be written either.
    """
    try:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
        return _writable(base / "evolvent" / name)
    except (OSError, RuntimeError):  # no home directory, or one that may not be written to
        pass
    try:
        return _writable(_temporary() / name)
    except OSError as error:
        raise CacheError(
            f"{tempfile.gettempdir()}: wanted a folder for compiled forms, found {error.strerror or error}; name one "
            "that can be written to by XDG_CACHE_HOME"
        ) from error


def keep_fonts() -> None:
    """Let matplotlib keep its list of fonts in the cache folder where the home directory cannot be written."""
    if "MPLCONFIGDIR" not in os.environ and not os.access(os.path.expanduser("~"), os.W_OK):
        with suppress(CacheError):  # only figures need it, and matplotlib warns itself
            os.environ["MPLCONFIGDIR"] = str(cache_directory("matplotlib"))


@cache
def _temporary() -> Path:
    """The folder of this user below the temporary directory.

    Code that is loaded from it runs with the rights of this user. Where another user owns it or may write to it, a new
    folder is made, and removed at the end of the process.
    """
    folder = Path(tempfile.gettempdir()) / f"evolvent-{os.geteuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    if _is_private(folder):
        return folder
    private = Path(tempfile.mkdtemp(prefix="evolvent-cache-"))
    atexit.register(shutil.rmtree, private, ignore_errors=True)
    logging.getLogger("evolvent").warning(
        "%s: wanted a folder that only this user may write to, found one that others may; compiled forms are not kept. "
        "Remove it, or name another one by XDG_CACHE_HOME", folder,
    )  # fmt: skip
    return private


def _is_private(folder: Path) -> bool:
    """Whether this is a folder, not a link, that belongs to this user and that no other user may write to."""
    facts = folder.lstat()
    others = facts.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return stat.S_ISDIR(facts.st_mode) and facts.st_uid == os.geteuid() and not others


def _writable(directory: Path) -> Path:
    """The folder, created where it is missing. Raises OSError where it cannot be written."""
    directory.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryFile(dir=directory):
        return directory
