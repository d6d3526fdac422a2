"""Positions of an excitation on disk: those that something else has written there, and a vibration resumed on them."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.store import ArchiveError, Store, arrays_bytes
from evolvent.run.dynamics.kept_positions import KeptPositions, another, file_name
from evolvent.run.kinds import dynamics
from evolvent.run.kinds.dynamics import TABLES, Dynamics
from evolvent.scene.scene import load_scene
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import spur_scene


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
    return KeptPositions(Store(RunFolder(out), "gears", another), file_name(""))


WHOLE = archive(numbers=np.arange(2), figures=np.ones((2, 1, 4)))


def test_what_was_written_is_read(tmp_path: Path) -> None:
    """Two positions under one torque."""
    RunFolder(tmp_path).write(file_name(""), WHOLE)
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
    RunFolder(tmp_path).write(file_name(""), content)
    with pytest.raises(ArchiveError, match=r"excitation\.npz: wanted"):
        kept(tmp_path).read()


class Stopped(Exception):
    """A call ends here."""


def test_tables_of_another_scene_are_removed_before_it_is_solved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """He's pair under two torques, resumed and stopped before its vibration is there: with the same damping all tables
    stay; with another one, whose scene is written, none does."""
    small = (
        "mesh.level=quick", "sweep.positions=4", "dynamics.torque_percents=[50,100]", "dynamics.speeds=3",
        "dynamics.backlash_um=50",
    )
    tables = {table.name for table in TABLES}

    def stopped(*_: object) -> None:
        raise Stopped

    def left(damping: float) -> set[str]:
        with pytest.raises(Stopped):
            quietly(Dynamics.of(spur_scene(*small, f"dynamics.damping_ratio={damping}")), tmp_path, resume=True)
        section = load_scene(tmp_path / "scene.toml").dynamics
        assert section is not None and section.damping_ratio == damping
        return {path.name for path in tmp_path.iterdir()} & tables

    quietly(Dynamics.of(spur_scene(*small, "dynamics.damping_ratio=0.1")), tmp_path)
    monkeypatch.setattr(dynamics, "swept_vibration", stopped)
    whole = left(0.1)
    assert {"response.csv", "excitation.csv"} <= whole
    assert left(0.2) == set()
