"""Files are written whole or not at all: under another name, flushed to the disk, then renamed. Only files are read."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from evolvent_meshes.errors import EvolventError, InputError

PART = ".evolvent-part"
"""In the name of a file that is being written; one that a killed run has left may be removed."""

NO_FILES = {stat.S_IFIFO: "a named pipe", stat.S_IFCHR: "a device", stat.S_IFBLK: "a device", stat.S_IFSOCK: "a socket"}


class WriteError(EvolventError, OSError):
    """A file that could not be written; nothing of it is left. The message names file, size and remedy."""


class NoFile(OSError):
    """Something of this name that is not a file."""


@contextmanager
def open_file(path: Path | str) -> Iterator[BinaryIO]:
    """A file to be read. Raises OSError; NoFile for a named pipe, which may wait for its writer for ever, or a device.
    """
    with open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK)) as file:
        kind = NO_FILES.get(stat.S_IFMT(os.fstat(file.fileno()).st_mode))
        if kind is not None:
            raise NoFile(errno.EINVAL, f"{kind}, which is no file", str(path))
        yield file


def write_bytes(path: Path, content: bytes | memoryview) -> Path:
    """Writes a file, its folders too, atomically and durably; gives its path. Raises WriteError."""
    with whole(path, len(content)) as part:
        part.write_bytes(content)
    return path


@contextmanager
def whole(path: Path, size: int) -> Iterator[Path]:
    """The name under which the block writes a file of about `size` bytes, which then becomes `path`. Raises WriteError
    where the block or the renaming raises OSError."""
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
        with contextlib.suppress(OSError):  # it is `path` now, or was never made
            part.unlink()


def write_text(path: Path, text: str) -> Path:
    """`write_bytes` of a text as UTF-8."""
    return write_bytes(path, text.encode("utf-8"))


@contextmanager
def folder_for(out: Path, option: str = "--out") -> Iterator[None]:
    """The folder exists inside the block; where the block leaves it empty, what was made for it goes again. Raises
    InputError, which names the option, where it cannot be made."""
    try:
        made = [folder for folder in (out, *out.parents) if not folder.exists()]
        out.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:  # ValueError: a NUL in its name
        raise unusable(out, error, option) from error
    try:
        yield
    finally:
        for folder in made:
            with contextlib.suppress(OSError):  # in use
                folder.rmdir()


def unusable(out: Path, error: OSError | ValueError, option: str = "--out") -> InputError:
    """The error of a folder that cannot be made or written to."""
    found = getattr(error, "strerror", None) or str(error)
    if isinstance(error, FileExistsError):
        found = "a file" if out.exists() else "a link that leads nowhere"
    return InputError(
        f"{option}: found {str(out)[:200]!r} ({found}); allowed: a directory that can be made and written to by user "
        f"{os.geteuid()}; remedy: name another one, or mend its access"
    )


def require_writable(path: Path) -> None:
    """Raises InputError where no file of this name can be made; leaves nothing."""
    with folder_for(path.parent):
        try:
            part_of(path).touch()
            part_of(path).unlink(missing_ok=True)
        except (OSError, ValueError) as error:
            raise unusable(path, error) from error


def write_error(path: Path, size: int, error: OSError) -> WriteError:
    """The error of a file of so many bytes that could not be written."""
    return WriteError(
        f"{path}: wanted to write {size / 1e6:.3g} MB, found {error.strerror or error}; make room or mend the access, "
        "then try again (a run goes on with --resume: what it computed before is kept)"
    )


def part_of(path: Path) -> Path:
    """The name under which a file is written: in the same folder, hidden, with the same ending."""
    return path.with_name(f".{path.stem}{PART}{path.suffix}")
