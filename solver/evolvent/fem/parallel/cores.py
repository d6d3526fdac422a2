"""Cores of ranks that wait, lent to those of the same node that work.

Gears of different sizes are condensed on one rank each, and who is done waits for the other; positions are alike. The
largest products of the one who works then run on all these cores.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

from mpi4py import MPI
from threadpoolctl import threadpool_limits

from evolvent.fem.parallel.ranks import node_memory

Threads = Callable[[], AbstractContextManager[None]]
"""Makes the context in which BLAS may use more cores than the rank's own, if it may now."""


class Cores:
    """Of the ranks of a node. All ranks must make one together; where there is one rank it never changes a thing."""

    def __init__(self, comm: MPI.Comm) -> None:
        node = comm.Split_type(MPI.COMM_TYPE_SHARED)
        self._rank, self._size = node.rank, node.size
        self._waits = node_memory(comm, node, node.size) if node.size > 1 else memoryview(bytearray(1))
        node.Free()

    @property
    def count(self) -> int:
        """How many this rank may use at present: those that wait are shared out among those that work."""
        waiting = sum(self._waits)
        return 1 + waiting // max(1, self._size - waiting)

    @contextmanager
    def lent(self) -> Iterator[None]:
        """While this rank waits."""
        self._waits[self._rank] = self._size > 1
        try:
            yield
        finally:
            self._waits[self._rank] = 0

    @contextmanager
    def used(self) -> Iterator[None]:
        """See `Threads`. How many cores there are is asked once, at the begin."""
        count = self.count
        if count == 1:
            yield
            return
        own = os.sched_getaffinity(0)
        os.sched_setaffinity(0, range(os.cpu_count() or 1))  # mpirun ties each rank to one core
        try:
            with threadpool_limits(limits=count, user_api="blas"):
                yield
        finally:
            os.sched_setaffinity(0, own)
