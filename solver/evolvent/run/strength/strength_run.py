"""Root strength of a scene's gears, from start to finish. `evolvent strength` calls only this."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import GearModel, Mesher, Preparer, prepare_model
from evolvent.gears.meshing.root_meshes import coarse_root_mesh, root_mesh
from evolvent.gears.solution.certificates import certify
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import SweptPosition, initial_state
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.run.pitch_run import pitch_of
from evolvent.run.progress import CONDENSING, ERROR_BARS, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.strength import StrengthSection
from evolvent.scene.skips import wanted_output
from evolvent.strength.results.tables import (
    ROOT_STRESS,
    STRENGTH,
    FrictionRoots,
    StrengthRow,
    root_stress_rows,
    strength_rows,
    write_strength,
)
from evolvent.strength.root_passage import GearRoots, root_passages
from evolvent.strength.standard.root_stress import RootLoad
from evolvent_meshes.errors import EvolventError
from evolvent_meshes.gears.member import Member

PICTURE = "root_stress.png"
WRITTEN = STRENGTH, ROOT_STRESS, f"pictures/{PICTURE}"
NO_DEEP_TEETH = 12
"""Tolerance class that is taken where the scene names none: Y_DT is 1."""


def run_strength(
    scene: Scene, out: Path, overwrite: bool = False, quiet: bool = False, prepare: Preparer = prepare_model
) -> list[str]:
    """Computes the pitch with roots finer than a run's, and the stress there, and writes tables and picture to `out`.
    Returns a sentence where a picture could not be drawn or error bars not be estimated. Collective.

    scene: its wear is left out. overwrite: replace what an earlier call has written. prepare: prepares gears that other
    calls share.

    Raises FolderError, MeshError, TooMuchRelief, NotConverged, SearchError, Imbalance, WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    scene = scene.model_copy(update={"wear": None})
    on_first(comm, lambda: _check(out, overwrite))
    dolfinx_compat.silence_logs()
    with Progress(hidden=hidden) as progress:
        fine = _roots(scene, root_mesh, comm, progress, POSITIONS, prepare)
        coarse, failure = None, ""
        if wanted_output(scene).error_bars:
            try:
                coarse = _roots(scene, coarse_root_mesh, comm, progress, ERROR_BARS, prepare)
            except EvolventError as error:  # the same on all ranks
                failure = f"Error bars: their coarse companion could not be solved: {error}"
        progress.stage(OUTPUT)
        said = on_first(comm, lambda: _written(scene, fine, coarse, out))
    return [*said, *([failure] if failure else [])]


def _check(out: Path, overwrite: bool) -> None:
    RunFolder(out).require_free(WRITTEN)
    if (out / STRENGTH).exists() and not overwrite:
        raise FolderError(
            f"{out}: found {STRENGTH} of an earlier call; allowed: a folder without; remedy: --overwrite computes it "
            "anew, --out names another folder"
        )


def _roots(
    scene: Scene, mesh: Mesher, comm: MPI.Comm, progress: Progress, stage: str, prepare: Preparer
) -> list[tuple[GearRoots, GearRoots]]:
    """Of both gears at each friction coefficient; on rank 0, none on the others. Collective."""
    progress.stage(MESHING)
    model: GearModel = prepare(gear_problem(scene), comm, mesh, lambda: progress.stage(CONDENSING)).model
    pitch, frictions = pitch_of(scene), scene.contact.friction
    progress.stage(stage, len(pitch.angles))
    swept = []
    for position in sweep_until_periodic(model, pitch, frictions, initial_state(frictions), comm):
        certify(position.results)
        swept.append(position)
        progress.advance(more=not position.closes)
    return on_first(comm, lambda: _stresses(model, one_pitch(swept), len(frictions)))


def _stresses(
    model: GearModel, positions: Sequence[SweptPosition], frictions: int
) -> list[tuple[GearRoots, GearRoots]]:
    found = []
    for index in range(frictions):
        pinion, wheel = (root_passages(body, [each.results[index] for each in positions]) for body in model.bodies)
        found.append((pinion, wheel))
    return found


def _written(
    scene: Scene, fine: Sequence[tuple[GearRoots, GearRoots]], coarse: Sequence[tuple[GearRoots, GearRoots]] | None,
    out: Path,
) -> list[str]:  # fmt: skip
    """Writes everything, in place of what an earlier call has written. On rank 0 alone."""
    section, problem = scene.strength or StrengthSection(), gear_problem(scene)
    found = [
        FrictionRoots(friction, own, None if coarse is None else coarse[index], scene.mesh.order)
        for index, (friction, own) in enumerate(zip(scene.contact.friction, fine))
    ]
    tolerance = section.tolerance_class or NO_DEEP_TEETH
    rows: list[StrengthRow] = []
    for member in Member:
        load = RootLoad(problem.pair, member, problem.pinion_torque)
        rows += strength_rows(load, found, section.editions, tolerance)

    def drawn() -> bytes:
        from evolvent.strength.figures.root_stress import root_stress_picture  # matplotlib takes a second to import

        return root_stress_picture(scene.title, found, rows)

    with locked(out):
        folder = RunFolder(out)
        folder.remove(WRITTEN)
        write_strength(folder, rows, list(root_stress_rows(found)))
        return list(draw([Picture(PICTURE, drawn)] if wanted_output(scene).pictures else [], folder).failures)
