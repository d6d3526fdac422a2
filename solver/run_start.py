"""How a run begins: in an empty folder, or after the positions that an earlier one has left there."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mpi4py import MPI

from meshes.data import Floats, MeshData
from solver.archive import Archive, GearShape, gear_shape
from solver.closed_pitch import errors_of
from solver.gear_sweep import SweepState
from solver.parallel import together
from solver.results import write_text
from solver.scene import GEARS, Scene
from solver.sectors import sector_meshes
from solver.skips import with_deflected_flanks
from solver.surface import surface_of

Meshes = tuple[MeshData, MeshData]


@dataclass(frozen=True)
class Start:
    """Where a run begins: after positions with these transmission errors (`errors_of`), in this state. is_end: nothing
    is left to be solved."""

    errors: tuple[Floats, ...]
    is_end: bool
    state: SweepState


def kept_start(scene: Scene, archive: Archive, resume: bool) -> Start | None:
    """Where to go on, None for the beginning. Raises ArchiveError where another scene's results are to be resumed."""
    pair = scene.gear_pair()
    state = archive.read_state(pair) if resume else None
    if state is None:
        return None
    swept = archive.read_sweep(pair)
    errors = tuple(errors_of(position, scene.contact.friction) for position in swept)
    return Start(errors, bool(swept) and swept[-1].closes, state)


def continued(scene: Scene, archive: Archive, resume: bool) -> Scene:
    """The scene as it is to be solved: on deflected flanks where an earlier run, to be resumed, has come to that."""
    other = with_deflected_flanks(scene)
    return other if resume and Archive(archive.out, other).is_own() else scene


def same_meshes(scene: Scene, archive: Archive) -> Meshes:
    """The scene's meshes; raises ArchiveError where the results stand on others."""
    meshes = sector_meshes(scene)
    archive.check_gears(gear_shapes(meshes))
    return meshes


def open_archive(scene: Scene, archive: Archive, meshes: Meshes, start: Start | None) -> None:
    """Makes the folder ready for this scene's positions. Raises ArchiveError, OSError."""
    if start is None:
        archive.clear()
        archive.write_gears(gear_shapes(meshes))
    else:
        archive.check_gears(gear_shapes(meshes))
    keep_scene(scene, archive.out)


def keep_scene(scene: Scene, folder: Path) -> None:
    """Writes OUT/scene.toml, and the flank charts that it names beside it. Raises OSError."""
    local: dict[str, Any] = {}
    for name in GEARS:
        if chart := scene.flank_chart(name):
            write_text(folder / f"flank_{name}.csv", chart.text())
            local[name] = getattr(scene, name).model_copy(update={"flank_csv": f"flank_{name}.csv"})
    write_text(folder / "scene.toml", scene.model_copy(update=local).resolved_toml())


def gear_shapes(meshes: Meshes) -> tuple[GearShape, GearShape]:
    """What the archive keeps of both sectors."""
    pinion, wheel = (gear_shape(mesh, surface_of(mesh, "flank").nodes) for mesh in meshes)
    return pinion, wheel


@contextmanager
def logged(out: Path, comm: MPI.Comm, start: Start | None) -> Iterator[logging.Logger]:
    """The run's log: OUT/run.log on rank 0, nothing elsewhere; a resumed run adds to it. Makes the folder.

    Raises OSError.
    """
    log = logging.getLogger("evolvent")
    log.setLevel(logging.INFO)
    log.propagate = False
    handler = together(comm, lambda: logging.NullHandler() if comm.rank > 0 else _log_file(out, "a" if start else "w"))
    log.addHandler(handler)
    try:
        yield log
    except Exception as error:
        log.error("failed: %s", error)
        raise
    finally:
        log.removeHandler(handler)
        handler.close()


def _log_file(out: Path, mode: str) -> logging.Handler:
    try:
        out.mkdir(parents=True, exist_ok=True)
        handler = logging.FileHandler(out / "run.log", mode=mode, encoding="utf-8")
    except OSError as error:
        raise OSError(
            f"{out}: wanted a folder to write to, found {error.strerror}; name another one with --out"
        ) from error
    handler.setFormatter(logging.Formatter("%(asctime)s  %(message)s", "%H:%M:%S"))
    return handler
