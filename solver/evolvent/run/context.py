"""Objects that all stages of a run share, created once: ranks, folder, log, progress and cost."""

from __future__ import annotations

import resource
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Preparer
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_cost import Cost, Timings, read_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.run.progress import Progress
from evolvent.run.run_log import RunLog, logged
from evolvent.scene.scene import Scene

T = TypeVar("T")


@dataclass(frozen=True)
class RunContext:
    """One run, or the last part of a resumed one."""

    comm: MPI.Comm
    """Ranks that compute the run together."""
    folder: RunFolder
    """Folder of the run; only rank 0 writes to it."""
    log: RunLog
    """Log of the run."""
    progress: Progress
    """Progress display on rank 0."""
    resume: bool
    """Whether results in the folder are continued."""
    earlier: Cost
    """Cost of everything that was computed before."""
    begin: float
    """When this part of the run began, by time.perf_counter() [s]."""
    prepare: Preparer | None = None
    """Prepares gears that other runs share; None: this run has its own."""

    def archive(self, scene: Scene) -> Archive:
        """The archive of a scene in the folder of the run."""
        return Archive(self.folder.out, scene)

    def on_first(self, work: Callable[[], T]) -> T:
        """The result of `work`, done on rank 0 alone, on all ranks. Collective; raises its exception on all of them."""
        return on_first(self.comm, work)

    def memory_MB(self) -> float:
        """Largest resident memory of the run so far [MB], summed over the ranks. Collective."""
        return self.comm.allreduce(peak_memory_MB())

    def cost(self, timings: Timings, memory_MB: float) -> Cost:
        """Cost of the run so far. timings, memory_MB: of what this part has computed since `earlier`."""
        return self.earlier + Cost(timings, memory_MB)

    @property
    def seconds(self) -> float:
        """Wall time since the beginning [s]."""
        return time.perf_counter() - self.begin


@contextmanager
def run_context(
    folder: RunFolder, comm: MPI.Comm, resume: bool, quiet: bool, begin: float, prepare: Preparer | None = None
) -> Iterator[RunContext]:
    """The context of a run, with its log and its progress display open. quiet: no progress is displayed.

    Collective. Raises ArchiveError where the cost of earlier parts cannot be read.
    """
    earlier = on_first(comm, lambda: read_cost(folder) if resume else Cost())
    with logged(folder, comm, resume) as log, Progress(hidden=quiet or comm.rank > 0) as progress:
        yield RunContext(comm, folder, log, progress, resume, earlier, begin, prepare)


def peak_memory_MB() -> float:
    """Largest resident memory of this process so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
