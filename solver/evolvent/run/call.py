"""Objects that all stages of a computation share, created once: ranks, folder, log, progress and cost."""

from __future__ import annotations

import resource
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Mesher, Preparation, Preparer, prepare_model
from evolvent.gears.line.line_start import with_line_starts
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_cost import Cost, Timings, read_cost, write_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import SCENE_FILES, holds_scene, write_scene
from evolvent.run.companion import Attempt, attempted
from evolvent.run.progress import CONDENSING, ERROR_BARS, MESHING, Progress
from evolvent.run.run_log import RunLog, logged
from evolvent.scene.scene import Scene
from evolvent.scene.skips import wanted_output

T = TypeVar("T")


@dataclass(frozen=True)
class Options:
    """Options of a call."""

    resume: bool = False
    """Go on from the results that an earlier call has stored; where there are none, begin with a warning."""
    overwrite: bool = False
    """Begin anew and, once there are results, replace those of an earlier call that nobody has changed since. With
    neither, the folder must not hold results."""
    quiet: bool = False
    """No progress is displayed."""
    source: Path | None = None
    """The scene's file, which is never overwritten."""
    prepare: Preparer = prepare_model
    """Prepares gears, its own or those that several calls share."""
    label: str | None = ""
    """Name in front of the warnings that are printed; None: they are in the log, and returned, but not printed."""


DEFAULT = Options()


@dataclass(frozen=True)
class Call:
    """One call that computes a scene into a folder, or the last part of a resumed one."""

    command: str
    """Command of the program that computes."""
    replaced: tuple[str, ...]
    """Names of the tables and pictures that the call replaces."""
    comm: MPI.Comm
    """Ranks that compute together."""
    folder: RunFolder
    """Folder of the call; rank 0 writes to it, others only results that they alone have."""
    log: RunLog
    """Log of the call."""
    progress: Progress
    """Progress display on rank 0."""
    options: Options
    """Options of the call."""
    earlier: Cost
    """Cost of everything that was computed before."""
    begun: float
    """When this part of the computation began, by time.perf_counter() [s]."""

    @property
    def resume(self) -> bool:
        """Whether results in the folder are continued."""
        return self.options.resume

    def preparing(self, prepare: Preparer) -> Call:
        """The call with gears that are prepared by another function."""
        return replace(self, options=replace(self.options, prepare=prepare))

    def archive(self, scene: Scene, part: str = "") -> Archive:
        """The archive of a scene in the folder. part: as of `Archive`."""
        return Archive(self.folder.out, scene, self.command, part)

    def on_first(self, work: Callable[[], T]) -> T:
        """The result of `work`, done on rank 0 alone, on all ranks. Collective; raises its exception on all of them."""
        return on_first(self.comm, work)

    def gears(self, problem: GearProblem, mesh: Mesher = run_mesh, shown: bool = True) -> Preparation:
        """Meshed and condensed gears. Collective; raises as `prepare_model`.

        mesh: makes the mesh of a gear's sector.
        shown: whether meshing and condensing are stages of the progress display.
        """

        def meshed() -> None:
            self.log.open()
            if shown:
                self.progress.stage(CONDENSING)

        if shown:
            self.progress.stage(MESHING)
        made: Preparation = self.options.prepare(problem, self.comm, mesh, meshed)
        self.log.info("meshed in %.1f s, condensed in %.1f s", made.mesh_seconds, made.seconds)
        return replace(made, model=with_line_starts(made.model))

    def companion(self, scene: Scene, solve: Callable[[], T]) -> Attempt[T]:
        """Outcome of solving the coarse companion, where the scene asks for error bars, see `attempted`. Collective."""
        if not wanted_output(scene).error_bars:
            return Attempt()
        self.progress.stage(ERROR_BARS)
        attempt = attempted(solve)
        if attempt.reason:
            self.log.info("%s", attempt.reason)
        self.log.info("coarse companion for the error bars in %.1f s", attempt.seconds)
        return attempt

    def begin(self, scene: Scene, resumed: bool = False) -> None:
        """Prepares the folder for results of a scene: removes those of an earlier call unless they are resumed, and
        tables of another scene. On rank 0 alone. Raises WriteError, FolderError, OSError."""
        self.log.open()
        if not resumed:
            self.folder.clear(keep=[self.folder.out / name for name in SCENE_FILES])
        elif not holds_scene(self.folder.out, scene):
            self.folder.remove(self.replaced)
        write_scene(scene, self.folder)
        write_cost(self.folder, self.cost(Timings(), 0.0))

    @contextmanager
    def beginning(self, scene: Scene, prepare: Preparer) -> Iterator[Preparer]:
        """Context with a function that prepares gears as `prepare` does. The folder of the scene begins once the first
        gears are condensed or, where all results are stored, at the end of the context. Collective; raises as `begin`.
        """
        begin = cache(lambda: self.on_first(lambda: self.begin(scene, self.resume)))

        def prepared(*arguments: Any, **options: Any) -> Preparation:
            made: Preparation = prepare(*arguments, **options)
            begin()
            return made

        yield prepared
        begin()

    def memory_MB(self) -> float:
        """Largest resident memory of the call so far [MB], summed over the ranks. Collective."""
        return self.comm.allreduce(peak_memory_MB())

    def cost(self, timings: Timings, memory_MB: float) -> Cost:
        """Cost of the computation so far. timings, memory_MB: of what this part has computed since `earlier`."""
        return self.earlier + Cost(timings, memory_MB, self.command)

    @property
    def seconds(self) -> float:
        """Wall time since the beginning [s]."""
        return time.perf_counter() - self.begun


@contextmanager
def opened_call(
    command: str, replaced: tuple[str, ...], folder: RunFolder, comm: MPI.Comm, options: Options = DEFAULT
) -> Iterator[Call]:
    """A call with its log and its progress display open.

    Collective. Raises ArchiveError where the cost of earlier parts cannot be read.
    """
    begun = time.perf_counter()
    earlier = on_first(comm, lambda: read_cost(folder) if options.resume else Cost())
    shown = Progress(hidden=options.quiet or comm.rank > 0)
    with logged(folder, comm, options.resume, options.label) as log, shown as progress:
        yield Call(command, replaced, comm, folder, log, progress, options, earlier, begun)


def peak_memory_MB() -> float:
    """Largest resident memory of this process so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
