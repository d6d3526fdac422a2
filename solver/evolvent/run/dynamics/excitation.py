"""The excitation of a scene's gears, from start to finish. `evolvent excitation` calls only this."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from evolvent.dynamics.excitation.unloaded_error import RigidFlanks, unloaded_error
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS, excitation_rows, harmonic_rows, write_tables
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.load_list import LoadList
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.run.progress import CONDENSING, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene

PICTURE = "excitation.png"
WRITTEN = EXCITATION, HARMONICS, f"pictures/{PICTURE}"


def run_excitation(scenes: Sequence[Scene], out: Path, overwrite: bool = False, quiet: bool = False) -> list[str]:
    """Computes the excitation under some torques and writes its tables and picture to `out`. Returns a sentence for
    each picture that could not be drawn. Collective.

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
        progress.stage(OUTPUT)
        return on_first(comm, lambda: _written(excitation, problems, out))


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
    models = [gears.prepare(each, comm).model for each in problems]
    progress.stage(POSITIONS, positions * len(problems))
    angles = np.array(uniform_pitch(first.pair.pinion.z, positions).angles)
    loaded = loaded_mesh(models, [each.torque for each in problems], angles, comm, progress.advance)
    return MeshExcitation(unloaded_error(RigidFlanks(first.pair, first.flanks), angles, first.torque_on), loaded)


def _written(excitation: MeshExcitation, problems: Sequence[GearProblem], out: Path) -> list[str]:
    """Writes everything. On rank 0 alone."""
    with locked(out):
        return write_excitation(RunFolder(out), excitation, problems)


def write_excitation(folder: RunFolder, excitation: MeshExcitation, problems: Sequence[GearProblem]) -> list[str]:
    """Writes tables and picture; returns a sentence for a picture that could not be drawn. Raises WriteError,
    FolderError."""
    first = problems[0]
    radius, torques = first.pair.gears[first.torque_on].base_radius, [1e-3 * each.torque for each in problems]
    write_tables(folder, excitation_rows(excitation, radius), harmonic_rows(excitation, radius))

    def drawn() -> bytes:
        from evolvent.dynamics.results.figures import excitation_picture  # matplotlib takes a second to import

        return excitation_picture(excitation, torques)

    return list(draw([Picture(PICTURE, drawn)], folder).failures)
