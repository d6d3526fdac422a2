"""Positions of an excitation on disk that something else has written there."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.store import ArchiveError, Store, arrays_bytes
from evolvent.run.dynamics.kept_positions import NAMES, KeptPositions, another


def single_array() -> bytes:
    """A file of NumPy with one array, which is no archive."""
    content = io.BytesIO()
    np.save(content, np.zeros(3))
    return content.getvalue()


def archive(**arrays: Any) -> bytes:
    """An archive of the right gears."""
    return bytes(arrays_bytes({"identity": "gears", **arrays}))


def kept(out: Path) -> KeptPositions:
    """Positions of the right gears."""
    return KeptPositions(Store(RunFolder(out), "gears", another), NAMES[""])


WHOLE = archive(numbers=np.arange(2), figures=np.ones((2, 1, 4)))


def test_what_was_written_is_read(tmp_path: Path) -> None:
    """Two positions under one torque."""
    RunFolder(tmp_path).write(NAMES[""], WHOLE)
    found = kept(tmp_path).read()
    assert list(found) == [0, 1] and np.array_equal(found[1], np.ones((1, 4)))


@pytest.mark.parametrize(
    "content",
    [
        b"", b"\0" * 100, b"PK\x03\x04" + b"\0" * 60, WHOLE[:-30], WHOLE[:60] + b"\xff" * 40 + WHOLE[100:],
        single_array(), archive(), archive(numbers=np.arange(2)),
        archive(numbers=np.arange(3), figures=np.ones((2, 1, 4))),
        archive(numbers=np.arange(2), figures=np.ones((2, 2))),
        archive(numbers=np.array(["a"]), figures=np.ones((1, 1, 4))),
        archive(numbers=np.arange(1), figures=np.array([[list("abcd")]])),
        archive(numbers=np.arange(2), figures=np.ones((2, 1, 2))),
    ],
)
def test_forged_positions_are_refused(tmp_path: Path, content: bytes) -> None:
    """Archives that are cut off, damaged, no archives, or hold other arrays: an error with the path, nothing else."""
    RunFolder(tmp_path).write(NAMES[""], content)
    with pytest.raises(ArchiveError, match=r"excitation\.npz: wanted"):
        kept(tmp_path).read()
