"""A wear study on disk: OUT/results/wear.npz is what it goes on from, OUT/worn_400000/ the worn pair at a report.

Each such folder is a run of its own: its scene has the worn flanks as charts, so that it can be solved, drawn and worn
on by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np

from evolvent.gears.sweep.pitch_sweep import SweepState, SweptPosition
from evolvent.gears.sweep.position import PositionResult, SearchedAt
from evolvent.results.archive.archive import Archive, Meshes, gear_shapes, read_arrays
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import keep_scene
from evolvent.results.tables.tables import csv_text
from evolvent.scene.flank_deviations import FlankChart
from evolvent.scene.scene import GEARS, Scene
from evolvent.wear.gears.gear_study import BlockRow, Kept
from evolvent.wear.gears.gear_wear import GearWear
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

FILE = "wear.npz"
COUNTS = "refused", "searched", "refreshed"  # of a block's facts, the whole numbers


def write_study(archive: Archive, kept: Kept) -> None:
    """Keeps a study, and OUT/wear.csv, a line a block. Raises OSError."""
    last = kept.last or (np.zeros(0), 0.0)
    arrays = {
        "fingerprint": archive.fingerprint, "cycles": kept.cycles, "depth": kept.depth, "known": kept.known,
        "length": kept.length,
        "last_rate": last[0], "last_length": last[1],
        "searches": np.array([(s.angle, *s.extra, s.half_width) for s in kept.searches]),
        "rows": np.array([list(asdict(row).values()) for row in kept.rows]),
    }  # fmt: skip
    if kept.rows:
        archive.files.write_text("wear.csv", csv_text([asdict(row) for row in kept.rows]))
    archive.keep(FILE, arrays)


def read_study(archive: Archive) -> Kept | None:
    """What was kept, None where nothing was. Raises ArchiveError where it is another scene's."""
    if not (archive.folder / FILE).exists():
        return None
    arrays = read_arrays(archive.folder / FILE)
    archive.require_own(arrays)
    last = (arrays["last_rate"], float(arrays["last_length"])) if len(arrays["last_rate"]) else None
    searches = tuple(SearchedAt(a, (x, y), w) for a, x, y, w in arrays["searches"].tolist())
    return Kept(
        float(arrays["cycles"]), arrays["depth"], arrays["known"], last, float(arrays["length"]), searches,
        tuple(map(_row, arrays["rows"].tolist())),
    )  # fmt: skip


def _row(values: list[float]) -> BlockRow:
    named = zip([field.name for field in fields(BlockRow)], values, strict=True)
    typed: dict[str, Any] = {name: int(value) if name in COUNTS else value for name, value in named}
    return BlockRow(**typed)


def worn_folder(out: Path, cycles: float) -> Path:
    """Where the pair after so many cycles is written; OUT itself has the pair at the beginning."""
    return out / f"worn_{cycles:.15g}" if cycles > 0.0 else out


def write_worn(scene: Scene, folder: Path, gears: GearWear, depth: Floats) -> Scene:
    """Writes the flanks after some cycles as charts, depths (n,), and the scene that has them; returns that scene.
    Raises OSError."""
    files = RunFolder(folder)
    worn: dict[str, object] = {"wear": None}
    for gear, name, own in zip(Member, GEARS, gears.by_gear(depth)):
        path = files.write_text(f"flank_{name}.csv", chart_of(gears, gear, own).text())
        worn[name] = getattr(scene, name).model_copy(update={"flank_csv": str(path)})
    changed = scene.model_copy(update=worn)
    keep_scene(changed, files)
    return changed


def chart_of(gears: GearWear, gear: Member, depth: Floats) -> FlankChart:
    """Depths (n,) [mm] of a gear's flank nodes over diameter and height."""
    grid, base = gears.grids[gear], gears.model.pair.gears[gear].base_radius
    return FlankChart(2.0 * np.sqrt(base**2 + 2.0 * base * grid.arcs), grid.heights, depth[grid.node].T)


def write_pitch(archive: Archive, meshes: Meshes, results: Sequence[PositionResult]) -> None:
    """A pitch at one friction coefficient as a sweep leaves it. Raises OSError."""
    archive.write_gears(gear_shapes(meshes))
    for k, result in enumerate(results):
        state = SweepState(result.stand.extra, (None,))
        position = SweptPosition(result.stand.angle, (result,), state, closes=k == len(results) - 1)
        archive.write_position(k, position)
