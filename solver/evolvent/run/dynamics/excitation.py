"""The excitation of a scene's gears, from start to finish. `evolvent excitation` calls only this."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh, loaded_mesh
from evolvent.dynamics.excitation.unloaded_error import RigidFlanks, unloaded_error
from evolvent.dynamics.results.curves import NO_COMPANION, CoarseExcitation
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS, excitation_rows, harmonic_rows, write_tables
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
from evolvent.run.progress import CONDENSING, ERROR_BARS, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.skips import wanted_output
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import EvolventError

PICTURE = "excitation.png"
WRITTEN = EXCITATION, HARMONICS, f"pictures/{PICTURE}"


def run_excitation(scenes: Sequence[Scene], out: Path, overwrite: bool = False, quiet: bool = False) -> list[str]:
    """Computes the excitation under some torques and writes its tables and picture to `out`. Returns a sentence where
    a picture could not be drawn or error bars not be estimated. Collective.

    scenes: the scene under each torque, see `load_scenes`.
    overwrite: replace what an earlier call has written.

    Raises FolderError, MeshError, TooMuchRelief, NotConverged, SearchError, NoForceSurface, WriteError.
    """
    comm = MPI.COMM_WORLD
    on_first(comm, lambda: check_results(out, WRITTEN, overwrite))
    dolfinx_compat.silence_logs()
    problems = sorted((gear_problem(scene) for scene in scenes), key=lambda problem: problem.torque)
    with Progress(hidden=quiet or comm.rank > 0) as progress:
        excitation = computed_excitation(problems, scenes[0].sweep.positions, comm, progress)
        companion = companion_of(excitation, problems, scenes[0], comm, progress)
        progress.stage(OUTPUT)
        return on_first(comm, lambda: _written(excitation, companion, problems, out))


def check_results(out: Path, written: Sequence[str], overwrite: bool) -> None:
    """Raises FolderError where files of others would be lost, or results unasked. written: names of what is written."""
    RunFolder(out).require_free(written)
    if (out / EXCITATION).exists() and not overwrite:
        raise FolderError(
            f"{out}: found {EXCITATION} of an earlier call; allowed: a folder without; remedy: --overwrite replaces "
            "it, --out names another folder"
        )


def computed_excitation(
    problems: Sequence[GearProblem], positions: int, comm: MPI.Comm, progress: Progress
) -> MeshExcitation:
    """Of the same gears under each torque, the lightest first. Collective."""
    progress.stage(MESHING)
    gears, first = LoadList(problems), problems[0]
    gears.prepare(first, comm, meshed=lambda: progress.stage(CONDENSING))
    progress.stage(POSITIONS, positions * len(problems))
    angles = np.array(uniform_pitch(first.pair.pinion.z, positions).angles)
    loaded = loaded_pitch(gears, problems, angles, run_mesh, comm, progress)
    return MeshExcitation(unloaded_error(RigidFlanks(first.pair, first.flanks), angles, first.torque_on), loaded)


def companion_of(
    excitation: MeshExcitation, problems: Sequence[GearProblem], scene: Scene, comm: MPI.Comm, progress: Progress
) -> CoarseExcitation:
    """The same positions and torques on elements of twice the size, where the scene asks for error bars; an error of
    meshing or solving becomes its `failure`: results are not lost for their error bars. Collective."""
    if not wanted_output(scene).error_bars:
        return NO_COMPANION
    angles = excitation.loaded.angles
    progress.stage(ERROR_BARS, len(angles) * len(problems))
    try:
        loaded = loaded_pitch(LoadList(problems), problems, angles, companion_mesh, comm, progress)
        return CoarseExcitation(MeshExcitation(excitation.unloaded_error, loaded), scene.mesh.order)
    except EvolventError as error:  # the same on all ranks
        return CoarseExcitation(None, failure=f"Error bars: their coarse companion could not be solved: {error}")


def loaded_pitch(
    gears: LoadList, problems: Sequence[GearProblem], angles: Floats, mesh: Mesher, comm: MPI.Comm, progress: Progress
) -> LoadedMesh:
    """The pitch under each problem's torque, on the sectors that `mesh` makes. Collective."""
    models = [gears.prepare(each, comm, mesh).model for each in problems]
    return loaded_mesh(models, [each.torque for each in problems], angles, comm, progress.advance)


def _written(
    excitation: MeshExcitation, companion: CoarseExcitation, problems: Sequence[GearProblem], out: Path
) -> list[str]:
    """Writes everything. On rank 0 alone."""
    with locked(out):
        return write_excitation(RunFolder(out), excitation, companion, problems)


def write_excitation(
    folder: RunFolder, excitation: MeshExcitation, companion: CoarseExcitation, problems: Sequence[GearProblem]
) -> list[str]:
    """Writes tables and picture; returns a sentence where a picture could not be drawn or error bars not be estimated.
    Raises WriteError, FolderError."""
    first = problems[0]
    radius, torques = first.pair.gears[first.torque_on].base_radius, [1e-3 * each.torque for each in problems]
    tables = excitation_rows(excitation, radius, companion), harmonic_rows(excitation, radius, companion)
    write_tables(folder, *tables)

    def drawn() -> bytes:
        from evolvent.dynamics.figures.excitation import excitation_picture  # matplotlib takes a second to import

        return excitation_picture(excitation, torques, companion)

    failures = draw([Picture(PICTURE, drawn)], folder).failures
    return [*failures, *([companion.failure] if companion.failure else [])]
