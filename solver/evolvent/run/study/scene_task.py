"""One scene of a study, and the condensed gears of several, computed in a worker process."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mpi4py import MPI

from evolvent.check.problem_size import MEMORY_OF, memory_megabytes, require_memory
from evolvent.gears.gear_model import Preparer, prepare_model
from evolvent.gears.shared_gears import SharedGears
from evolvent.results.archive.run_folder import FolderError
from evolvent.results.archive.run_lock import locked
from evolvent.results.archive.store import ArchiveError
from evolvent.run.call import Options
from evolvent.run.computation import Computation
from evolvent.run.compute import compute
from evolvent.run.folder_checks import begun_results
from evolvent.run.kinds.all import kind_named
from evolvent.run.kinds.excitation import Excitation
from evolvent.run.study.plan.shared_gears import condensed_problem, meshes, own_torque
from evolvent.run.study.results.check_figures import run_check
from evolvent.run.study.results.scene_record import SceneRecord, Status, read_record, write_record
from evolvent.scene.scene import Scene
from evolvent_meshes.errors import EvolventError, InputError, ResultError

DONE: Status = "done"
FAILED: Status = "failed"
REFUSED: Status = "refused"
GLANCE = 1.0
"""Time between two looks at a folder that another process writes to [s]."""


@dataclass(frozen=True)
class SceneTask:
    """A scene to be computed."""

    name: str
    """Hash of the scene's content."""
    folder: Path
    """Folder for the results of the scene."""
    compute: str
    """Computation, as the study file names it."""
    scene: Scene
    """Validated scene."""
    share_of_memory: int = 1
    """Number of scenes that are computed at once on a machine; 0: its memory is not checked."""


def condense(tasks: Sequence[SceneTask]) -> SharedGears:
    """Gears that some scenes share, condensed. Those that cannot be condensed are left out: each scene then fails by
    itself, with its own reason."""
    compute, first = tasks[0].compute, tasks[0].scene
    gears = SharedGears([condensed_problem(task.scene, compute) for task in tasks])
    for mesh in meshes(first, compute):
        with contextlib.suppress(EvolventError):
            gears.prepare(condensed_problem(first, compute), MPI.COMM_SELF, mesh)
    return gears


def solve(task: SceneTask, gears: SharedGears | None = None) -> SceneRecord:
    """Computes a scene in its folder, and leaves a record there where a repetition would find the same: it is done, or
    fails by its input or without a reliable result. gears: condensed for it, None: it condenses its own."""
    begin, warnings, reason, lasting = time.perf_counter(), [], "", True
    try:
        _wait_until_free(task.folder)
        if (known := read_record(task.folder)) is not None:
            return known
        _require_room(task)
        warnings = _computed(task, prepare_model if gears is None else gears.prepare)
    except EvolventError as error:
        reason = str(error)
        lasting = isinstance(error, (InputError, ResultError)) and not isinstance(error, (FolderError, ArchiveError))
    except (OSError, MemoryError) as error:
        reason, lasting = str(error) or type(error).__name__, False
    record = SceneRecord(
        task.name, task.compute, FAILED if reason else DONE, reason, tuple(warnings), time.perf_counter() - begin
    )
    if lasting:
        write_record(task.folder, record)
    return record


def _wait_until_free(folder: Path) -> None:
    """Waits until no other process computes in the folder: a worker of a scheduler may still compute a scene of a study
    that was killed."""
    while True:
        try:
            with locked(folder):
                return
        except FolderError:
            time.sleep(GLANCE)


def _require_room(task: SceneTask) -> None:
    """Raises SceneError where all scenes that are computed at once need more memory than the machine has."""
    if task.share_of_memory and task.compute != "check":
        needed = MEMORY_OF.get(task.compute, memory_megabytes)
        require_memory(task.scene, lambda scene, ranks: task.share_of_memory * needed(scene, ranks), MPI.COMM_SELF)


def computation_of(task: SceneTask) -> Computation[Any]:
    """The computation of a scene; an excitation is that of the scene's own torque."""
    if task.compute == "excitation":
        return Excitation.under(own_torque(task.scene))
    return kind_named(task.compute).load().of(task.scene)


def _computed(task: SceneTask, prepare: Preparer) -> list[str]:
    """Computes a scene in its folder, or goes on there. Returns warnings, a sentence each."""
    if task.compute == "check":
        return run_check(task.scene, task.folder)
    what = computation_of(task)
    resume = bool(begun_results(what, task.folder))
    return compute(what, task.folder, Options(resume, not resume, quiet=True, prepare=prepare, label=None))
