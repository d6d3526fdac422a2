"""Excitation scenes that differ in misalignment only: their positions are solved together, with one search for all."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from contextlib import ExitStack

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.misaligned_mesh import misaligned_figures
from evolvent.dynamics.of_scene import check_positions
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import GearModel
from evolvent.gears.shared_gears import SharedGears
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.results.archive.archive import COARSE
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.run.dynamics.kept_positions import KEPT, KeptPositions, kept_positions
from evolvent.run.study.plan.shared_gears import meshes, own_torque
from evolvent.run.study.results.scene_record import SceneRecord, read_record
from evolvent.run.study.scene_task import SceneTask, solve
from evolvent_meshes.errors import EvolventError


def line_name(task: SceneTask) -> str:
    """Name that scenes have in common which differ in misalignment only and are solved together; other scenes have
    their own."""
    if task.compute != "excitation":
        return task.name
    return task.scene.changed("pair", misalignment_um=0.0).model_dump_json()


def solve_line(tasks: Sequence[SceneTask], gears: SharedGears) -> list[SceneRecord]:
    """Computes scenes of one `line_name`, as `solve` does each. Where their positions cannot be solved together, each
    scene solves its own. gears: condensed for all of them."""
    missing = [task for task in tasks if read_record(task.folder) is None]
    if len(missing) > 1:
        with contextlib.suppress(EvolventError):
            _keep_positions(sorted(missing, key=lambda task: task.scene.pair.misalignment_um), gears)
    return [solve(task, gears) for task in tasks]


def _keep_positions(tasks: Sequence[SceneTask], gears: SharedGears) -> None:
    """Archives solved positions in the scenes' folders, from which each excitation resumes. tasks: at ascending
    misalignments. Raises what `compute` does."""
    first, loads = tasks[0].scene, [own_torque(task.scene) for task in tasks]
    check_positions(first)
    dolfinx_compat.silence_logs()
    with ExitStack() as locks:
        for task in tasks:
            locks.enter_context(locked(task.folder))
            RunFolder(task.folder).require_free(KEPT)
        for part, mesh in zip(("", COARSE), meshes(first, "excitation")):
            models = [gears.prepare(each.problem, MPI.COMM_SELF, mesh).model for each in loads]
            kept = [kept_positions(each, RunFolder(task.folder), part) for each, task in zip(loads, tasks)]
            _solve_missing(models, kept, first.sweep.positions)


def _solve_missing(models: Sequence[GearModel], kept: Sequence[KeptPositions], positions: int) -> None:
    """Solves the positions that are not archived for all of the scenes. positions: number in a pitch."""
    known = [each.read() for each in kept]
    missing = [number for number in range(positions) if not all(number in found for found in known)]
    angles = np.array(uniform_pitch(models[0].pair.pinion.z, positions).angles)[missing]
    for number, figures in zip(missing, misaligned_figures(models, angles)):
        for own, found, place in zip(figures, known, kept):
            found[number] = own[None]
            place.write(found)
