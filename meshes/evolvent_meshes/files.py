"""Reading of regular files, and atomic writing: under another name, flushed to the disk, then renamed."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import BinaryIO

from evolvent_meshes.errors import EvolventError, InputError

PART = ".evolvent-part"
"""Part of the name of a file that is being written; files of this name left over from a killed run may be removed."""

SPECIAL_FILES = {
    stat.S_IFIFO: "a named pipe", stat.S_IFCHR: "a device", stat.S_IFBLK: "a device", stat.S_IFSOCK: "a socket",
}


class WriteError(EvolventError, OSError):
    """A file could not be written; no part of it is left. The message names file, size and remedy."""


class NoFile(OSError):
    """A path that is not a regular file."""


@contextmanager
def open_file(path: Path | str) -> Iterator[BinaryIO]:
    """A regular file opened for reading.

    Raises OSError; NoFile for a named pipe, which would block until it has a writer, a device or a socket.
    """
    with open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK)) as file:
        kind = SPECIAL_FILES.get(stat.S_IFMT(os.fstat(file.fileno()).st_mode))
        if kind is not None:
            raise NoFile(errno.EINVAL, f"{kind}, which is no file", str(path))
        yield file


def write_bytes(path: Path, content: bytes | memoryview) -> Path:
    """Write a file atomically, create its folders, and return its path. Raises WriteError."""
    with atomic_file(path, len(content)) as part:
        part.write_bytes(content)
    return path


@contextmanager
def atomic_file(path: Path, size: int) -> Iterator[Path]:
    """Context with a temporary path to write a file of about `size` bytes to; at its end it is renamed to `path`.

    Raises WriteError where the block or the renaming raises OSError.
    """
    part = part_of(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield part
        with open(part, "rb+") as stream:
            os.fsync(stream.fileno())
        os.replace(part, path)
    except OSError as error:
        raise write_error(path, size, error) from error
    finally:
        with contextlib.suppress(OSError):  # it was renamed to `path`, or never written
            part.unlink()


def write_text(path: Path, text: str) -> Path:
    """Write a text as UTF-8, as `write_bytes` does. Raises WriteError."""
    return write_bytes(path, text.encode("utf-8"))


@contextmanager
def plain_name(path: Path, suffix: str) -> Iterator[Path]:
    """Context with another name of a file, by a link, in a folder without other files: for programs that take no name
    whose bytes are not UTF-8."""
    with TemporaryDirectory() as folder:
        alias = Path(folder) / f"file{suffix}"
        alias.symlink_to(path.resolve())
        yield alias


@contextmanager
def folder_for(out: Path, option: str = "--out") -> Iterator[None]:
    """Context in which the folder exists; folders that were created for it are removed at its end if they are empty.

    option: of the command line, for the message.
    Raises InputError where the folder cannot be created.
    """
    try:
        made = [folder for folder in (out, *out.parents) if not folder.exists()]
        out.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:  # ValueError: a NUL character in its name
        raise unusable(out, error, option) from error
    try:
        yield
    finally:
        for folder in made:
            with contextlib.suppress(OSError):  # in use
                folder.rmdir()


def unusable(out: Path, error: OSError | ValueError, option: str = "--out") -> InputError:
    """The error of a folder that cannot be created or written to."""
    reason = getattr(error, "strerror", None) or str(error)
    if isinstance(error, FileExistsError):
        reason = "a file" if out.exists() else "a link that leads nowhere"
    return InputError(
        f"{option}: found {str(out)[:200]!r} ({reason}); allowed: a directory that can be made and written to by user "
        f"{os.geteuid()}; remedy: name another one, or change its permissions"
    )


def require_writable(path: Path) -> None:
    """Raises InputError where a file of this name cannot be created; leaves no file and no folder."""
    with folder_for(path.parent):
        try:
            part_of(path).touch()
            part_of(path).unlink(missing_ok=True)
        except (OSError, ValueError) as error:
            raise unusable(path, error) from error


def write_error(path: Path, size: int, error: OSError) -> WriteError:
    """The error of a file of `size` bytes that could not be written."""
    return WriteError(
        f"{path}: wanted to write {size / 1e6:.3g} MB, found {error.strerror or error}; make room or "
        "change the permissions, then try again (a run goes on with --resume: what it computed before is kept)"
    )


def part_of(path: Path) -> Path:
    """The name under which a file is written: hidden, in the same folder, with the same suffix."""
    return path.with_name(f".{path.stem}{PART}{path.suffix}")
