"""The excitation of a scene's gears, from start to finish. `evolvent excitation` calls only this."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import Figures, LoadedMesh, loaded_mesh, mesh_of
from evolvent.dynamics.excitation.unloaded_error import RigidFlanks, unloaded_error
from evolvent.dynamics.results.curves import NO_COMPANION, CoarseExcitation
from evolvent.dynamics.results.design_load import excitation_facts, write_excitation_facts
from evolvent.dynamics.results.tables import EXCITATION, excitation_rows, harmonic_rows, write_tables
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Mesher
from evolvent.gears.load_list import LoadList
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.run.dynamics.kept_positions import KEPT, KEPT_COARSE, KeptPositions, kept_positions
from evolvent.run.dynamics.written_files import EXCITATION_PICTURE, OF_DYNAMICS, OF_EXCITATION
from evolvent.run.progress import CONDENSING, ERROR_BARS, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.pair_dynamics import check_positions
from evolvent.scene.scene import Scene
from evolvent.scene.skips import wanted_output
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import EvolventError


def run_excitation(
    scenes: Sequence[Scene], out: Path, resume: bool = False, overwrite: bool = False, quiet: bool = False
) -> list[str]:
    """Computes the excitation under some torques and writes its tables and picture to `out`. Returns a sentence where
    a picture could not be drawn or error bars not be estimated. Collective.

    scenes: the scene under each torque, see `load_scenes`.
    resume: go on from the positions that an earlier call has solved.
    overwrite: begin anew, and replace what an earlier call has written.

    Raises SceneError, FolderError, ArchiveError, MeshError, TooMuchRelief, NotConverged, SearchError, NoForceSurface,
    WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    check_positions(scenes[0])
    problems = sorted((gear_problem(scene) for scene in scenes), key=lambda problem: problem.torque)
    fine, coarse = kept_positions(scenes, out, resume)
    with writing_to(out, OF_EXCITATION, comm, resume, overwrite) as said, Progress(hidden=hidden) as progress:
        excitation = computed_excitation(problems, scenes[0].sweep.positions, comm, progress, fine)
        companion = companion_of(excitation, problems, scenes[0], comm, progress, coarse)
        progress.stage(OUTPUT)
        return said + on_first(comm, lambda: _written(RunFolder(out), excitation, companion, problems, scenes[0]))


@contextmanager
def writing_to(out: Path, written: Sequence[str], comm: MPI.Comm, resume: bool, overwrite: bool) -> Iterator[list[str]]:
    """Context in which no other run writes to the folder. Gives a sentence where there is nothing to go on from.
    Collective. written: names of what is written in the end.

    Raises FolderError where files of others would be lost, or results unasked.
    """
    with ExitStack() as lock:
        on_first(comm, lambda: lock.enter_context(locked(out)))
        said = on_first(comm, lambda: _checked(out, written, resume, overwrite))
        dolfinx_compat.silence_logs()
        yield said


def _checked(out: Path, written: Sequence[str], resume: bool, overwrite: bool) -> list[str]:
    RunFolder(out).require_free((*written, KEPT, KEPT_COARSE))
    there = [name for name in (KEPT, EXCITATION) if (out / name).exists()]
    if there and not (resume or overwrite):
        raise FolderError(
            f"{out}: found {there[-1]} of an earlier call; allowed: a folder without; remedy: --resume goes on from "
            "its positions, --overwrite computes them anew, --out names another folder"
        )
    if resume and not there:
        return [f"--resume found nothing to continue in {out} (no {KEPT}); the call begins from the start."]
    return []


def computed_excitation(
    problems: Sequence[GearProblem], positions: int, comm: MPI.Comm, progress: Progress,
    kept: KeptPositions | None = None,
) -> MeshExcitation:  # fmt: skip
    """Of the same gears under each torque, the lightest first. Collective."""
    first = problems[0]
    angles = np.array(uniform_pitch(first.pair.pinion.z, positions).angles)
    loaded = loaded_pitch(problems, angles, run_mesh, comm, progress, POSITIONS, kept)
    return MeshExcitation(unloaded_error(RigidFlanks(first.pair, first.flanks), angles, first.torque_on), loaded)


def companion_of(
    excitation: MeshExcitation, problems: Sequence[GearProblem], scene: Scene, comm: MPI.Comm, progress: Progress,
    kept: KeptPositions | None = None,
) -> CoarseExcitation:  # fmt: skip
    """The same positions and torques on elements of twice the size, where the scene asks for error bars; an error of
    meshing or solving becomes its `failure`: results are not lost for their error bars. Collective."""
    if not wanted_output(scene).error_bars:
        return NO_COMPANION
    angles = excitation.loaded.angles
    try:
        loaded = loaded_pitch(problems, angles, companion_mesh, comm, progress, ERROR_BARS, kept)
        return CoarseExcitation(MeshExcitation(excitation.unloaded_error, loaded), scene.mesh.order)
    except EvolventError as error:  # the same on all ranks
        return CoarseExcitation(None, failure=f"Error bars: their coarse companion could not be solved: {error}")


def loaded_pitch(
    problems: Sequence[GearProblem], angles: Floats, mesh: Mesher, comm: MPI.Comm, progress: Progress,
    stage: str = POSITIONS, kept: KeptPositions | None = None,
) -> LoadedMesh:  # fmt: skip
    """The pitch under each problem's torque, on the sectors that `mesh` makes. Collective.

    stage: name of the solution in the progress.
    kept: positions on disk; where all of them are there, no gears are meshed.
    """
    first, torques = problems[0], [each.torque for each in problems]
    known = on_first(comm, kept.read) if kept is not None else {}

    def keep(found: Figures) -> None:
        progress.reach(len(found))
        if kept is not None:
            on_first(comm, lambda: kept.write(found))

    if len(known) == len(angles):
        progress.stage(stage, len(angles), len(known))
        return mesh_of(known, first.pair.gears[first.torque_on], torques, angles)
    progress.stage(MESHING)
    gears = LoadList(problems)
    gears.prepare(first, comm, mesh, meshed=lambda: progress.stage(CONDENSING))
    progress.stage(stage, len(angles), len(known))
    return loaded_mesh([gears.prepare(each, comm, mesh).model for each in problems], torques, angles, comm, known, keep)


def _written(
    folder: RunFolder, excitation: MeshExcitation, companion: CoarseExcitation, problems: Sequence[GearProblem],
    scene: Scene,
) -> list[str]:  # fmt: skip
    """Writes everything, in place of what an earlier call has written. On rank 0 alone."""
    folder.remove(OF_DYNAMICS)
    return write_excitation(folder, excitation, companion, problems, scene)


def write_excitation(
    folder: RunFolder, excitation: MeshExcitation, companion: CoarseExcitation, problems: Sequence[GearProblem],
    scene: Scene,
) -> list[str]:  # fmt: skip
    """Writes tables and, where it is wanted, the picture; returns a sentence where that could not be drawn or error
    bars not be estimated. Raises WriteError, FolderError."""
    first = problems[0]
    radius = first.pair.gears[first.torque_on].base_radius
    facts = excitation_facts(scene.title, scene.mesh.level, excitation, radius, companion)
    tables = excitation_rows(excitation, radius, companion), harmonic_rows(excitation, radius, companion)
    write_tables(folder, *tables)
    write_excitation_facts(folder, facts)

    def drawn() -> bytes:
        from evolvent.dynamics.figures.excitation import excitation_picture  # matplotlib takes a second to import

        return excitation_picture(excitation, facts, companion)

    failures = draw([Picture(EXCITATION_PICTURE, drawn)] if wanted_output(scene).pictures else [], folder).failures
    return [*failures, *([companion.failure] if companion.failure else [])]
