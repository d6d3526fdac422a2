"""How a run begins: in an empty folder, or after the positions that an earlier one has left there."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.gears.sweep.periodic_pitch import transmission_errors
from evolvent.gears.sweep.pitch_sweep import SweepState
from evolvent.results.archive.archive import Archive, Meshes, gear_shapes
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import SCENE_FILES, keep_scene
from evolvent.scene.meshing.sector_meshes import sector_meshes
from evolvent.scene.scene import Scene
from evolvent.scene.skips import with_deflected_flanks
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class Start:
    """Where a run begins: after positions with these `transmission_errors`, in this state. is_end: nothing is left to
    be solved."""

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
    errors = tuple(transmission_errors(position, scene.contact.friction) for position in swept)
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
