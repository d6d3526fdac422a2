"""Begin of a run: earlier results that it continues, condensed gears, bodies of its vibration, and its folder."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mpi4py import MPI

from evolvent.dynamics.modes.static_shapes import with_elastic_bodies
from evolvent.dynamics.of_scene import operating_point
from evolvent.dynamics.operating_point import OperatingPoint
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Preparation, prepare_model
from evolvent.gears.meshed_gear import meshed_gear
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.pitch_sweep import SweepState, SweptPosition
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.gear_shapes import MeshRecord
from evolvent.results.archive.run_cost import Timings
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import SCENE_FILES, write_scene
from evolvent.run.context import RunContext
from evolvent.run.progress import CONDENSING, MESHING
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent.scene.skips import with_deflected_flanks
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class ResumePoint:
    """Positions that an earlier run has completed, and the state of its sweep."""

    positions: tuple[SweptPosition, ...]
    """The completed positions in the order of their solution."""
    state: SweepState
    """State of the sweep after these positions."""

    @property
    def is_end(self) -> bool:
        """Whether no position is left to be solved."""
        return bool(self.positions) and self.positions[-1].closes


def resume_point(scene: Scene, archive: Archive, resume: bool) -> ResumePoint | None:
    """Where the run continues; None where it begins anew. Raises ArchiveError where the results belong to another
    scene."""
    pair = scene.gear_pair()
    state = archive.read_state(pair) if resume else None
    if state is None:
        return None
    return ResumePoint(tuple(archive.read_sweep(pair)), state)


def no_results_warning(scene: Scene, archive: Archive) -> str:
    """A sentence where there is nothing to resume, empty where there is.

    This is no error: a run that was stopped early has left no results.
    """
    name = "state.npz" if scene.wear is None else "wear.npz"
    if (archive.folder / name).exists():
        return ""
    return f"--resume found nothing to continue in {archive.out} (no results/{name}); the run begins from the start."


def scene_to_solve(scene: Scene, archive: Archive, resume: bool) -> Scene:
    """The scene, on deflected flanks where the run to be resumed had switched to them."""
    deflected = with_deflected_flanks(scene)
    return deflected if resume and Archive(archive.out, deflected).holds_scene() else scene


def prepare_gears(run: RunContext, scene: Scene) -> Preparation:
    """Meshes and condenses both gears. From then on the run writes files. Collective; raises as `prepare_model`."""

    def meshed() -> None:
        run.log.open()
        run.progress.stage(CONDENSING)

    run.progress.stage(MESHING)
    prepare = run.prepare or prepare_model
    preparation: Preparation = prepare(gear_problem(scene), run.comm, meshed=meshed)
    run.log.info("meshed in %.1f s, condensed in %.1f s", preparation.mesh_seconds, preparation.seconds)
    return preparation


def timings_of(preparation: Preparation) -> Timings:
    """Wall time of a preparation [s]."""
    parts = preparation.mesh_seconds, preparation.assemble_seconds, preparation.condense_seconds
    return Timings(*parts, total=preparation.mesh_seconds + preparation.seconds)


def checked_meshes(scene: Scene, archive: Archive) -> MeshRecord:
    """The meshes of the scene. Raises ArchiveError where the results in the archive belong to other meshes."""
    problem = gear_problem(scene)
    meshes = MeshRecord.of([meshed_gear(problem, member) for member in Member])
    archive.check_gears(meshes.shapes)
    return meshes


def open_archive(scene: Scene, archive: Archive, meshes: MeshRecord, resumed: bool) -> None:
    """Prepares the folder for the positions of this scene. Raises ArchiveError, OSError."""
    if resumed:
        archive.check_gears(meshes.shapes)
    else:
        clear(archive.files)
        archive.write_gears(meshes.shapes)
    write_scene(scene, archive.files)


def clear(folder: RunFolder) -> None:
    """Removes an earlier run except its scene files, which this run may have read. Raises OSError."""
    folder.clear(keep=[folder.out / name for name in SCENE_FILES])


def with_bodies(
    settings: DriveSettings, problem: GearProblem, section: DynamicsSection, comm: MPI.Comm
) -> DriveSettings:
    """The settings with rigid or elastic bodies, as the section asks. Collective. Raises as `with_elastic_bodies`."""
    if section.bodies == "rigid":
        return settings
    return on_first(comm, lambda: with_elastic_bodies(settings, problem, section.density_kg_m3))


def elastic_point(scene: Scene, comm: MPI.Comm) -> OperatingPoint | None:
    """Operating point of the scene, with rigid or elastic gear bodies as the scene asks. Collective."""
    point, section = operating_point(scene), scene.dynamics
    if point is None or section is None:
        return None
    return replace(point, settings=with_bodies(point.settings, gear_problem(scene), section, comm))
