"""Root strength of a scene's gears, from start to finish. `evolvent strength` calls only this."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Mesher, prepare_model
from evolvent.gears.meshing.root_meshes import coarse_root_mesh, root_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.solution.certificates import certify
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import initial_state
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.run.pitch_run import pitch_of
from evolvent.run.progress import CONDENSING, ERROR_BARS, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.strength import StrengthSection
from evolvent.scene.skips import wanted_output
from evolvent.strength.peak_positions import Roots, roots_of, with_angles, with_peaks
from evolvent.strength.results.tables import (
    ROOT_STRESS,
    STRENGTH,
    FrictionRoots,
    StrengthRow,
    root_stress_rows,
    strength_rows,
    write_strength,
)
from evolvent.strength.standard.root_stress import RootLoad
from evolvent_meshes.errors import EvolventError
from evolvent_meshes.gears.member import Member

PICTURE = "root_stress.png"
WRITTEN = STRENGTH, ROOT_STRESS, f"pictures/{PICTURE}"
NO_DEEP_TEETH = 12
"""Tolerance class that is taken where the scene names none: Y_DT is 1."""


def run_strength(scene: Scene, out: Path, overwrite: bool = False, quiet: bool = False) -> list[str]:
    """Computes the pitch with roots finer than a run's, and the stress there, and writes tables and picture to `out`.
    Returns a sentence where a picture could not be drawn or error bars not be estimated. Collective.

    scene: its wear is left out. overwrite: replace what an earlier call has written.

    Raises FolderError, MeshError, TooMuchRelief, NotConverged, SearchError, Imbalance, WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    scene = scene.model_copy(update={"wear": None})
    times = (scene.strength or StrengthSection()).root_refinement
    on_first(comm, lambda: _check(out, overwrite))
    dolfinx_compat.silence_logs()
    with Progress(hidden=hidden) as progress:
        fine = pitch_roots(scene, partial(root_mesh, times=times), comm, progress, POSITIONS)
        coarse, failure = None, ""
        if wanted_output(scene).error_bars:
            try:
                mesh = partial(coarse_root_mesh, times=times)
                coarse = pitch_roots(scene, mesh, comm, progress, ERROR_BARS, fine.angles)
            except EvolventError as error:  # the same on all ranks
                failure = f"Error bars: their coarse companion could not be solved: {error}"
        progress.stage(OUTPUT)
        said = on_first(comm, lambda: _written(scene, fine.roots, None if coarse is None else coarse.roots, out))
    return [*said, *([failure] if failure else [])]


def _check(out: Path, overwrite: bool) -> None:
    RunFolder(out).require_free(WRITTEN)
    if (out / STRENGTH).exists() and not overwrite:
        raise FolderError(
            f"{out}: found {STRENGTH} of an earlier call; allowed: a folder without; remedy: --overwrite computes it "
            "anew, --out names another folder"
        )


@dataclass(frozen=True)
class PitchRoots:
    """Root stress of the positions of a pitch, of those around its largest values, and of those at which a tooth of a
    spur gear is loaded at its outer point of single or double contact."""

    angles: tuple[float, ...]
    """Pinion rotations beyond the uniform ones [rad]."""
    roots: Roots


def pitch_roots(
    scene: Scene, mesh: Mesher, comm: MPI.Comm, progress: Progress, stage: str = POSITIONS,
    angles: Sequence[float] | None = None,
) -> PitchRoots:  # fmt: skip
    """Of both gears at each friction coefficient. Collective.

    mesh: of `root_meshes`. stage: of the progress, for the positions. angles: beyond the uniform ones; None: see
    `PitchRoots`.

    Raises MeshError, TooMuchRelief, NotConverged, SearchError, Imbalance.
    """
    progress.stage(MESHING)
    problem = gear_problem(scene)
    one_sector = replace(problem, options=replace(problem.options, whole_gears=False))  # it has the roots
    model = prepare_model(one_sector, comm, mesh, lambda: progress.stage(CONDENSING)).model
    pitch, frictions = pitch_of(scene), scene.contact.friction
    progress.stage(stage, len(pitch.angles))
    swept = []
    for position in sweep_until_periodic(model, pitch, frictions, initial_state(frictions), comm):
        certify(position.results)
        swept.append(position)
        progress.advance(more=not position.closes)
    uniform = one_pitch(swept)
    every = with_peaks(model, uniform, frictions, comm) if angles is None else uniform
    every = with_angles(model, every, _outer_points(problem) if angles is None else angles, frictions, comm)
    for position in every:
        certify(position.results)
    further = sorted({each.angle for each in every} - {each.angle for each in uniform})
    return PitchRoots(tuple(further), on_first(comm, lambda: roots_of(model, every)))


def _outer_points(problem: GearProblem) -> list[float]:
    """Pinion rotations in [0, pitch) at which teeth of spur gears are loaded at `RootLoad.outer_point` [rad]."""
    if problem.pair.pinion.helix_angle_deg > 0.0:
        return []
    loads = (RootLoad(problem.pair, member, problem.pinion_torque) for member in Member)
    pitch = 2.0 * math.pi / problem.pair.pinion.z
    return [load.tooth_rotation(load.outer_point.below_tip) % pitch for load in loads]


def _written(
    scene: Scene, fine: Roots, coarse: Roots | None, out: Path
) -> list[str]:
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
