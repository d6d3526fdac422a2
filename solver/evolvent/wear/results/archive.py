"""A wear study on disk: the checkpoint OUT/results/wear.npz, and the worn pair at a report in OUT/worn_400000/.

Each such folder is a run of its own: its scene names the worn flanks as charts, so that it can be solved, drawn and
worn further by itself.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from evolvent.dynamics.operation_figures import VibrationRow
from evolvent.gears.sweep.pitch_sweep import SweepState, SweptPosition
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import SearchedAt
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.gear_shapes import GearShape
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import write_scene
from evolvent.results.archive.store import Arrays
from evolvent.results.tables.table import Table
from evolvent.scene.scene import Scene
from evolvent.wear.block_stepping import PreviousBlock
from evolvent.wear.gears.gear_study import BlockRow, StudyCheckpoint
from evolvent.wear.gears.gear_wear import GearWear
from evolvent.wear.gears.pitch_state import Vibration
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

FILE = "results/wear.npz"
BLOCKS, VIBRATION = Table("wear.csv", BlockRow), Table("vibration.csv", VibrationRow)
COUNTS = "refused", "searched", "refreshed", "repeats"  # the integer columns of rows
R = TypeVar("R", BlockRow, VibrationRow)


def write_checkpoint(archive: Archive, checkpoint: StudyCheckpoint) -> None:
    """Writes OUT/wear.csv and OUT/vibration.csv, one line per block, and then the checkpoint. Raises OSError."""
    previous, vibration = checkpoint.previous or PreviousBlock(np.zeros(0), 0.0), checkpoint.vibration
    arrays = {
        "cycles": checkpoint.cycles, "depth": checkpoint.depth,
        "known": checkpoint.mesh_depth, "length": checkpoint.next_length,
        "last_rate": previous.rate, "last_length": previous.length,
        "searches": _places(checkpoint.searches),
        "rows": np.array([list(asdict(row).values()) for row in checkpoint.rows]),
        "vibrations": np.array([list(asdict(row).values()) for row in checkpoint.vibrations]),
        "vibration": np.zeros(0) if vibration is None else np.array([*vibration.state, *vibration.forces]),
        "vibration_torques": np.zeros(0) if vibration is None else np.array(vibration.torques),
        "vibration_searches": np.zeros((0, 4)) if vibration is None else _places(vibration.searches),
    }
    VIBRATION.write(archive.files, checkpoint.vibrations)
    BLOCKS.write(archive.files, checkpoint.rows)
    archive.store.write(FILE, arrays)


def read_checkpoint(archive: Archive) -> StudyCheckpoint | None:
    """The checkpoint of a study, None where there is none. Raises ArchiveError where it is another scene's."""
    return archive.store.read(FILE, _checkpoint)


def _checkpoint(arrays: Arrays) -> StudyCheckpoint:
    rate = arrays["last_rate"]
    previous = PreviousBlock(rate, float(arrays["last_length"])) if len(rate) else None
    return StudyCheckpoint(
        float(arrays["cycles"]), arrays["depth"], arrays["known"], previous, float(arrays["length"]),
        _searches(arrays["searches"]),
        tuple(_row(BlockRow, values) for values in arrays["rows"].tolist()),
        tuple(_row(VibrationRow, values) for values in arrays["vibrations"].tolist()),
        _vibration(arrays),
    )


def _vibration(arrays: Mapping[str, Any]) -> Vibration | None:
    """Vibration of an archived checkpoint; None where it has none."""
    if not len(arrays["vibration"]):
        return None
    s, velocity, low, high = arrays["vibration"].tolist()
    torques = tuple(arrays["vibration_torques"].tolist())
    return Vibration(np.array([s, velocity]), (low, high), torques, _searches(arrays["vibration_searches"]))


def _places(searches: Sequence[SearchedAt]) -> Floats:
    """Places (n, 4) of the searches: angle, rotations beyond the nominal ones and half-width."""
    return np.array([(s.angle, *s.beyond_nominal, s.half_width) for s in searches]).reshape(-1, 4)


def _searches(places: Floats) -> tuple[SearchedAt, ...]:
    return tuple(SearchedAt(a, (x, y), w) for a, x, y, w in places.tolist())


def _row(kind: type[R], values: list[float]) -> R:
    named = zip([field.name for field in fields(kind)], values, strict=True)
    typed: dict[str, Any] = {name: int(value) if name in COUNTS else value for name, value in named}
    return kind(**typed)


def worn_folder(out: Path, cycles: float) -> Path:
    """The folder of the pair after so many cycles; OUT itself is that of the pair at the beginning."""
    return out / f"worn_{cycles:.15g}" if cycles > 0.0 else out


def write_worn(scene: Scene, folder: Path, gears: GearWear, depth: Floats) -> Scene:
    """Writes the flanks with depths (n,) [mm] as charts, and a scene that names them; returns that scene.

    Raises OSError.
    """
    files = RunFolder(folder)
    worn: dict[str, object] = {"wear": None}
    for gear, nodal in zip(Member, gears.by_gear(depth)):
        path = files.write_text(f"flank_{gear.label}.csv", gears.chart(gear, nodal).text())
        worn[gear.label] = getattr(scene, gear.label).model_copy(update={"flank_csv": str(path)})
    worn_scene = scene.model_copy(update=worn)
    write_scene(worn_scene, files)
    return worn_scene


def write_pitch(
    archive: Archive, shapes: tuple[GearShape, GearShape], results: Sequence[PositionResult]
) -> None:
    """Writes a pitch at one friction coefficient as a run without wear does. Raises OSError."""
    archive.write_gears(shapes)
    for k, result in enumerate(results):
        state = SweepState(result.stand.beyond_nominal, (None,))
        position = SweptPosition(result.stand.angle, (result,), state, closes=k == len(results) - 1)
        archive.write_position(k, position)
