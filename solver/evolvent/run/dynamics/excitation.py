"""The excitation of a scene's gears, from start to finish. `evolvent excitation` calls only this."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import Figures, LoadedMesh, certify_torques, mesh_of, solved_figures
from evolvent.dynamics.excitation.unloaded_error import RigidFlanks, unloaded_error
from evolvent.dynamics.figures.all import EXCITATION_PICTURE
from evolvent.dynamics.of_scene import check_positions
from evolvent.dynamics.results.curves import NO_COMPANION, CoarseExcitation
from evolvent.dynamics.results.design_load import EXCITATION_FACTS, excitation_facts
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS, excitation_rows, harmonic_rows
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import GearModel, Mesher, Preparer, prepare_model
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED, balanced
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.drawing.picture_files import draw
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.run.companion import attempted
from evolvent.run.dynamics.kept_positions import KEPT, KEPT_COARSE, KEPT_DEFLECTED, KeptPositions, kept_positions
from evolvent.run.dynamics.scene_torques import SceneTorques
from evolvent.run.dynamics.written_files import OF_DYNAMICS, OF_EXCITATION
from evolvent.run.folder_checks import require_unfinished, writing_to
from evolvent.run.progress import CONDENSING, ERROR_BARS, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.skips import wanted_output
from evolvent_meshes.arrays import Floats


def run_excitation(
    loads: SceneTorques, out: Path, resume: bool = False, overwrite: bool = False, quiet: bool = False,
    prepare: Preparer = prepare_model,
) -> list[str]:
    """Computes the excitation under some torques and writes its tables and picture to `out`. Returns a sentence where
    a picture could not be drawn or error bars not be estimated. Collective.

    loads: the scene and its torques, see `scene_torques`.
    resume: go on from the positions that an earlier call has solved.
    overwrite: begin anew, and replace what an earlier call has written.
    prepare: prepares gears that other calls share.

    Raises SceneError, FolderError, ArchiveError, MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError,
    NoForceSurface, WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    check_positions(loads.scene)
    fine, coarse = kept_positions(loads, out, resume)
    with writing_results(out, OF_EXCITATION, comm, resume, overwrite) as said, Progress(hidden=hidden) as progress:
        excitation = computed_excitation(loads, comm, progress, fine, prepare)
        companion = companion_of(excitation, loads, comm, progress, coarse, prepare)
        progress.stage(OUTPUT)
        return said + on_first(comm, lambda: _written(RunFolder(out), excitation, companion, loads))


def writing_results(
    out: Path, written: Sequence[str], comm: MPI.Comm, resume: bool, overwrite: bool
) -> AbstractContextManager[list[str]]:
    """Context in which no other run writes to the folder. Gives a sentence where there is nothing to resume.
    Collective. written: names of all files that the command writes.

    Raises FolderError where files of others would be lost, or results unasked.
    """
    dolfinx_compat.silence_logs()
    every = *written, KEPT, KEPT_COARSE, *KEPT_DEFLECTED
    return writing_to(
        out, comm, lambda: require_unfinished(out, every, (KEPT, EXCITATION.name), "positions", resume, overwrite)
    )


def computed_excitation(
    loads: SceneTorques, comm: MPI.Comm, progress: Progress, kept: KeptPositions | None = None,
    prepare: Preparer = prepare_model,
) -> MeshExcitation:
    """Excitation of the scene's gears under each torque. kept: positions on disk. prepare: as of `run_excitation`.
    Collective."""
    problem = loads.problem
    angles = np.array(uniform_pitch(problem.pair.pinion.z, loads.scene.sweep.positions).angles)
    loaded = loaded_pitch(loads, angles, run_mesh, comm, progress, POSITIONS, kept, prepare)
    return MeshExcitation(unloaded_error(RigidFlanks(problem.pair, problem.flanks), angles, problem.torque_on), loaded)


def companion_of(
    excitation: MeshExcitation, loads: SceneTorques, comm: MPI.Comm, progress: Progress,
    kept: KeptPositions | None = None, prepare: Preparer = prepare_model,
) -> CoarseExcitation:
    """Excitation at the same positions and torques on elements of twice the size, where the scene asks for error bars;
    an error of meshing or solving becomes its `failure`, see `attempted`. Collective."""
    if not wanted_output(loads.scene).error_bars:
        return NO_COMPANION

    def solved() -> MeshExcitation:
        angles = excitation.loaded.angles
        loaded = loaded_pitch(loads, angles, companion_mesh, comm, progress, ERROR_BARS, kept, prepare)
        return MeshExcitation(excitation.unloaded_error, loaded)

    found = attempted(solved)
    return CoarseExcitation(found.value, loads.scene.mesh.order, loads.elements, found.reason)


def loaded_pitch(
    loads: SceneTorques, angles: Floats, mesh: Mesher, comm: MPI.Comm, progress: Progress, stage: str = POSITIONS,
    kept: KeptPositions | None = None, prepare: Preparer = prepare_model,
) -> LoadedMesh:
    """The certified pitch under each torque, on the sectors that `mesh` makes; on deflected flanks where its energy
    does not balance otherwise. Collective.

    stage: name of the solution in the progress.
    kept: positions on disk; where all of them are there, no gears are meshed.
    prepare: see `run_excitation`.
    """
    asked = loads.problem.options.deflected_flanks

    @cache
    def gears() -> GearModel:
        progress.stage(MESHING)
        model: GearModel = prepare(loads.problem, comm, mesh, lambda: progress.stage(CONDENSING)).model
        return model

    def solved(deflected: bool) -> LoadedMesh:
        store = kept.deflected if kept is not None and deflected > asked else kept
        found: Figures = on_first(comm, store.read) if store is not None else {}

        def keep(solved: Figures) -> None:
            progress.reach(len(solved))
            if store is not None:
                on_first(comm, lambda: store.write(solved))

        if len(found) < len(angles):
            model = replace(gears(), deflected=deflected)
            progress.stage(stage, len(angles), len(found))
            found = solved_figures(model, loads.torques, angles, comm, found, keep)
        else:
            progress.stage(stage, len(angles), len(found))
        certify_torques(found, loads.torques)
        return mesh_of(found, loads.forces, angles, deflected)

    return balanced(solved, asked)


def _written(
    folder: RunFolder, excitation: MeshExcitation, companion: CoarseExcitation, loads: SceneTorques
) -> list[str]:
    """Writes all files, in place of those of an earlier call. On rank 0 alone."""
    folder.remove(OF_DYNAMICS)
    said = excitation_warnings(excitation, companion, loads)
    return [*said, *write_excitation(folder, excitation, companion, loads, said)]


def excitation_warnings(excitation: MeshExcitation, companion: CoarseExcitation, loads: SceneTorques) -> list[str]:
    """Sentences that a reader of the excitation has to know, on missing error bars, too."""
    mended = excitation.loaded.deflected and not loads.problem.options.deflected_flanks
    return [*loads.warnings, *filter(None, [ON_DEFLECTED if mended else "", companion.failure])]


def write_excitation(
    folder: RunFolder, excitation: MeshExcitation, companion: CoarseExcitation, loads: SceneTorques, said: Sequence[str]
) -> list[str]:
    """Writes tables and, where it is wanted, the picture; returns a sentence where that could not be drawn. said:
    `excitation_warnings`, which are kept beside the tables. Raises WriteError, FolderError."""
    scene, radius = loads.scene, loads.base_radius
    EXCITATION.write(folder, excitation_rows(excitation, radius, companion))
    HARMONICS.write(folder, harmonic_rows(excitation, radius, companion))
    facts = excitation_facts(scene.title, scene.mesh.level, excitation, radius, companion, said)
    EXCITATION_FACTS.write(folder, facts)
    pictures = [EXCITATION_PICTURE] if wanted_output(scene).pictures else []
    return [*draw(from_tables(pictures, folder.out), folder).failures]
