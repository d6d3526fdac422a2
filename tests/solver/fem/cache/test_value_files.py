"""Files of values. Oracle: the arrays that were written, bit by bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from evolvent.fem.cache import value_files
from evolvent.fem.cache.value_coding import CodedValue
from evolvent.fem.cache.value_files import ALIGNMENT, DamagedFile, read_about, read_value, write_value

RANDOM = np.random.default_rng(0)
ARRAYS = [
    RANDOM.normal(size=(5, 3)), np.asfortranarray(RANDOM.normal(size=(4, 6))), np.arange(7, dtype=np.int32),
    np.zeros((0, 3)), np.array(2.5), RANDOM.normal(size=(8, 8))[::2, 1:], np.ones(3, dtype=np.float32),
    np.array([True, False]), np.array([1j, 2.0]),
]
VALUE = CodedValue('{"a": 0}', ARRAYS)


def written(folder: Path) -> Path:
    """A file of all kinds of arrays."""
    path = folder / "one.values"
    assert write_value(path, VALUE, {"about": "β = 20°"}) == path.stat().st_size
    return path


def test_arrays_come_back_read_only(tmp_path: Path) -> None:
    """C and Fortran order, empty, without dimension, slices, all kinds: equal, of the same kind and shape, read-only,
    aligned in the file; no other file is left."""
    path = written(tmp_path)
    found = read_value(path)
    assert found.text == VALUE.text and read_about(path) == {"about": "β = 20°"}
    for own, array in zip(found.arrays, ARRAYS, strict=True):
        assert np.array_equal(own, array) and (own.dtype, own.shape) == (array.dtype, array.shape)
        if array.size:
            assert not own.flags.writeable and own.ctypes.data % ALIGNMENT == 0
    assert list(tmp_path.iterdir()) == [path]


def test_a_removed_file_stays_readable_where_it_is_mapped(tmp_path: Path) -> None:
    """Another program removes or replaces a file that this one uses: its arrays stay as they are."""
    path = written(tmp_path)
    found = read_value(path)
    write_value(path, CodedValue("", [np.zeros(1000)]), {})
    path.unlink()
    assert np.array_equal(found.arrays[0], ARRAYS[0])


def test_every_flipped_bit_is_seen(tmp_path: Path) -> None:
    """One bit of each byte of a file flipped in turn: an error, or in the unused digits of the first line the value as
    it was; never another value."""
    path = written(tmp_path)
    content = path.read_bytes()
    for place in range(len(content)):
        path.write_bytes(content[:place] + bytes([content[place] ^ 1 << place % 8]) + content[place + 1 :])
        try:
            found = read_value(path)
        except DamagedFile:
            continue
        assert found.text == VALUE.text
        assert all(np.array_equal(own, array) for own, array in zip(found.arrays, ARRAYS, strict=True))


@pytest.mark.parametrize("length", [0, 5, 40, 300, -1])
def test_part_of_a_file_is_damaged(tmp_path: Path, length: int) -> None:
    """A file that ends early, also within its first line, or is empty."""
    path = written(tmp_path)
    path.write_bytes(path.read_bytes()[:length])
    with pytest.raises(DamagedFile):
        read_value(path)


def test_objects_are_refused(tmp_path: Path) -> None:
    """A header that names an array of Python objects, as only pickles have them: refused."""
    path = tmp_path / "one.values"
    write_value(path, CodedValue("", [np.arange(4)]), {})
    content = path.read_bytes().replace(b'"<i8"', b'"|O8"')
    body = content[value_files.FIRST_LINE :]
    head = value_files._first_line(value_files.zlib.crc32(body), int(content[: value_files.FIRST_LINE].split()[-1]))
    path.write_bytes(head + body)
    with pytest.raises(DamagedFile, match=r"object|numbers"):
        read_value(path)


def test_no_part_is_left_where_the_disk_is_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Writing an array fails as on a full disk: the error, and neither file nor part of it."""

    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(value_files.zlib, "crc32", full)
    with pytest.raises(OSError, match="No space left"):
        write_value(tmp_path / "one.values", VALUE, {})
    assert not list(tmp_path.iterdir())
