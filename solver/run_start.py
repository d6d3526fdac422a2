"""How a run begins: in an empty folder, or after the positions that an earlier one has left there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from meshes.data import Floats, MeshData
from solver.archive import Archive, GearShape, gear_shape
from solver.closed_pitch import errors_of
from solver.gear_sweep import SweepState
from solver.run_folder import RunFolder
from solver.scene import GEARS, Scene
from solver.sectors import sector_meshes
from solver.skips import with_deflected_flanks
from solver.surface import surface_of

Meshes = tuple[MeshData, MeshData]
SCENE_FILES = ("flank_pinion.csv", "flank_wheel.csv", "scene.toml")


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


def nothing_kept(scene: Scene, archive: Archive) -> str:
    """A sentence where nothing is there to be resumed, empty where there is. A run that was stopped early has left
    nothing, so that is no error."""
    name = "state.npz" if scene.wear is None else "wear.npz"
    if (archive.folder / name).exists():
        return ""
    return f"--resume found nothing to go on from in {archive.out} (no results/{name}); the run begins from the start."


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
        clear(archive.files)
        archive.write_gears(gear_shapes(meshes))
    else:
        archive.check_gears(gear_shapes(meshes))
    keep_scene(scene, archive.files)


def clear(folder: RunFolder) -> None:
    """Removes an earlier run, but not its scene, from which this run may have come. Raises OSError."""
    folder.clear(keep=[folder.out / name for name in SCENE_FILES])


def keep_scene(scene: Scene, folder: RunFolder) -> None:
    """Writes OUT/scene.toml, and the flank charts that it names beside it. Raises OSError."""
    texts = scene_texts(scene)
    for name in SCENE_FILES:
        if name in texts:
            folder.write_text(name, texts[name])
        elif folder.is_ours(folder.out / name):
            (folder.out / name).unlink()


def scene_texts(scene: Scene) -> dict[str, str]:
    """What `keep_scene` writes: file name -> text."""
    local: dict[str, Any] = {}
    texts: dict[str, str] = {}
    for name in GEARS:
        if chart := scene.flank_chart(name):
            texts[f"flank_{name}.csv"] = chart.text()
            local[name] = getattr(scene, name).model_copy(update={"flank_csv": f"flank_{name}.csv"})
    return texts | {"scene.toml": scene.model_copy(update=local).resolved_toml()}


def gear_shapes(meshes: Meshes) -> tuple[GearShape, GearShape]:
    """What the archive keeps of both sectors."""
    pinion, wheel = (gear_shape(mesh, surface_of(mesh, "flank").nodes) for mesh in meshes)
    return pinion, wheel
