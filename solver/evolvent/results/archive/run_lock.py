"""One run a folder: a lock of the operating system, which ends with the process that holds it, however it ends."""

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

ATTEMPTS = 10  # at a lock file that its owner removes while we open it


@contextmanager
def locked(out: Path) -> Iterator[None]:
    """No other run computes into OUT inside this block. Makes the folder; what it has made and nobody has used is gone
    afterwards. Raises InputError where it cannot be made or written, FolderError where another run is at it."""
    with folder_for(out), _lock(out):
        yield


@contextmanager
def _lock(out: Path) -> Iterator[None]:
    path = out / LOCK
    try:
        descriptor = _opened(path)
    except OSError as error:
        raise unusable(out, error) from error
    try:
        os.ftruncate(descriptor, 0)
        with contextlib.suppress(OSError):  # a full disk: the lock holds without its owner's name
            os.write(descriptor, _owner().encode())
        yield
    finally:
        with contextlib.suppress(OSError):
            path.unlink()
        os.close(descriptor)


def _opened(path: Path) -> int:
    """The locked file. Raises OSError, FolderError where another process holds the lock."""
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
        except OSError:  # no locks on this file system: a second run is not seen
            return descriptor
        os.close(descriptor)
    raise FolderError(f"{path}: wanted to lock this file, found it removed {ATTEMPTS} times; start the run again")


def _owner() -> str:
    user = ""
    with contextlib.suppress(OSError, KeyError):  # a number without a name, as in a container
        user = f" of {getpass.getuser()}"
    return f"process {os.getpid()}{user} on {socket.gethostname()}, since {time.strftime('%Y-%m-%d %H:%M:%S')}"
