"""Files of values: a checksum, a header in JSON, then the arrays, which are mapped into memory when a file is read.

    evolvent cache 1 <CRC-32 of all that follows, 8 hex digits> <bytes of the header, 12 digits>\\n
    header   {"about": {...}, "value": "...", "arrays": [[dtype, shape, order, start], ...]}
    arrays   each from a multiple of 64 bytes on

A file is written under another name and renamed; it is not flushed to the disk, which takes as long as condensing small
gears: the checksum tells where a machine has stopped before it was. A reader that has mapped a file keeps what it has
mapped, whatever becomes of the name.
"""

from __future__ import annotations

import json
import mmap
import os
import tempfile
import zlib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from evolvent.fem.cache.value_coding import CodedValue
from evolvent_meshes.files import open_file

MAGIC = b"evolvent cache 1 "
FIRST_LINE = len(MAGIC) + 8 + 1 + 12 + 1
ALIGNMENT = 64
"""Bytes of a cache line."""
WRITING = ".part"
"""End of the name of a file that is being written."""


class DamagedFile(Exception):
    """A file that is not as it was written."""


def write_value(path: Path, value: CodedValue, about: dict[str, Any]) -> int:
    """Writes a value and what is said about it; returns the bytes of the file. Raises OSError; no part is left then."""
    header, pieces = _pieces(value, about)
    descriptor, part = tempfile.mkstemp(suffix=WRITING, prefix=path.stem, dir=path.parent)
    try:
        with open(descriptor, "wb") as file:
            size, check = FIRST_LINE, 0
            file.write(bytes(FIRST_LINE))
            for piece in pieces:
                check = zlib.crc32(piece, check)
                size += file.write(piece)
            file.seek(0)
            file.write(_first_line(check, header))
        os.replace(part, path)
    finally:
        with suppress(OSError):  # it was renamed
            os.unlink(part)
    return size


def read_value(path: Path) -> CodedValue:
    """The value of a file; its arrays are read-only and lie in the file. Raises OSError, DamagedFile."""
    with open_file(path) as file:
        head = file.read(FIRST_LINE)
        if len(head) < FIRST_LINE or not head.startswith(MAGIC):
            raise DamagedFile("another first line")
        mapped = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
    body = mapped[FIRST_LINE:]
    try:
        check, length = head[len(MAGIC) :].split()
        if zlib.crc32(body) != int(check, 16):
            raise DamagedFile("another checksum")
        header = json.loads(bytes(body[: int(length)]))
        return CodedValue(header["value"], [_array(mapped, *each) for each in header["arrays"]])
    except (ValueError, KeyError, TypeError) as error:
        raise DamagedFile(str(error)) from error


def read_about(path: Path) -> dict[str, Any]:
    """Description of the value of a file. Raises OSError, DamagedFile."""
    with open_file(path) as file:
        head = file.read(FIRST_LINE)
        try:
            if not head.startswith(MAGIC):
                raise DamagedFile("another first line")
            about: dict[str, Any] = json.loads(file.read(int(head.split()[-1])))["about"]
            return about
        except (ValueError, KeyError, IndexError, TypeError) as error:
            raise DamagedFile(str(error)) from error


def _pieces(value: CodedValue, about: dict[str, Any]) -> tuple[int, Iterator[memoryview]]:
    """Length of the header, and all pieces behind the first line."""
    specs: list[Any] = []
    arrays = [_contiguous(each) for each in value.arrays]
    header = b""
    for _ in range(2):  # the places of the arrays, as numbers of 15 digits, do not change the header's length
        start = FIRST_LINE + len(header)
        specs.clear()
        for each in arrays:
            start += -start % ALIGNMENT
            specs.append([each.dtype.str, each.shape, _order(each), f"{start:015d}"])
            start += each.nbytes
        header = json.dumps({"about": about, "value": value.text, "arrays": specs}).encode()

    def pieces() -> Iterator[memoryview]:
        yield memoryview(header)
        place = FIRST_LINE + len(header)
        for each in arrays:
            yield memoryview(bytes(-place % ALIGNMENT))
            yield memoryview(each.ravel(order="K")).cast("B") if each.size else memoryview(b"")
            place += -place % ALIGNMENT + each.nbytes

    return len(header), pieces()


def _first_line(check: int, header: int) -> bytes:
    return MAGIC + f"{check:08x} {header:012d}\n".encode()


def _contiguous(array: Any) -> Any:
    return array if array.flags.c_contiguous or array.flags.f_contiguous else np.ascontiguousarray(array)


def _order(array: Any) -> str:
    return "C" if array.flags.c_contiguous else "F"


def _array(mapped: memoryview, kind: str, shape: list[int], order: Any, start: str) -> Any:
    """An array of a mapped file. Raises ValueError where it ends beyond the file."""
    dtype, count = np.dtype(kind), int(np.prod(shape, dtype=np.int64))
    if dtype.hasobject:
        raise ValueError(f"wanted numbers, found {kind}")
    if not count:
        return np.zeros(shape, dtype)
    return np.frombuffer(mapped, dtype, count, int(start)).reshape(shape, order=order)
