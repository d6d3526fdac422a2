"""Lock of the output folder: one run at a time. The operating system releases it however the process ends."""

from __future__ import annotations

import contextlib
import fcntl
import getpass
import os
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from evolvent.results.archive.run_folder import LOCK, FolderError
from evolvent_meshes.files import folder_for, unusable

ATTEMPTS = 10
"""Attempts to lock a file that its owner removes between opening and locking."""


@contextmanager
def locked(out: Path) -> Iterator[None]:
    """Context in which no other run writes to OUT. Creates the folder, and removes it at the end if it is still empty.

    Raises InputError where the folder cannot be created or written, FolderError where another run holds the lock.
    """
    with folder_for(out), _lock(out):
        yield


@contextmanager
def _lock(out: Path) -> Iterator[None]:
    """Holds the lock file, with its owner's name as content."""
    path = out / LOCK
    try:
        descriptor = _opened(path)
    except OSError as error:
        raise unusable(out, error) from error
    try:
        os.ftruncate(descriptor, 0)
        with contextlib.suppress(OSError):  # on a full disk the lock holds without its owner's name
            os.write(descriptor, _owner().encode())
        yield
    finally:
        with contextlib.suppress(OSError):
            path.unlink()
        os.close(descriptor)


def _opened(path: Path) -> int:
    """Descriptor of the locked file. Raises OSError; FolderError where another process holds the lock."""
    for _ in range(ATTEMPTS):
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o644)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if path.exists() and os.path.samestat(os.fstat(descriptor), os.stat(path)):
                return descriptor
        except BlockingIOError as error:
            owner = os.read(descriptor, 1000).decode(errors="replace").strip() or "another run"
            os.close(descriptor)
            raise FolderError(
                f"{path.parent}: wanted a folder that no other run computes into, found {owner} at it; wait for its "
                "end, or name another folder with --out"
            ) from error
        except OSError:  # the file system has no locks: a second run is not detected
            return descriptor
        os.close(descriptor)
    raise FolderError(f"{path}: wanted to lock this file, found it removed {ATTEMPTS} times; start the run again")


def _owner() -> str:
    """Process, user, host and time of this run."""
    user = ""
    with contextlib.suppress(OSError, KeyError):  # the user has no name, as in a container
        user = f" of {getpass.getuser()}"
    return f"process {os.getpid()}{user} on {socket.gethostname()}, since {time.strftime('%Y-%m-%d %H:%M:%S')}"
