"""Cores of waiting ranks, used by the working ranks of the same node.

Gears of different sizes are condensed on one rank each, so that one rank waits for the other; so it is with positions.
The largest products of a working rank run on the cores of those that wait.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

from mpi4py import MPI
from threadpoolctl import threadpool_limits

from evolvent.fem.parallel.ranks import node_memory

Threads = Callable[[], AbstractContextManager[None]]
"""Makes the context in which BLAS uses the cores of waiting ranks too, as many as there are at its start."""


class Cores:
    """The cores of the ranks of a node. Construction is collective; on a single rank it has no effect."""

    def __init__(self, comm: MPI.Comm) -> None:
        node = comm.Split_type(MPI.COMM_TYPE_SHARED)
        self._rank, self._size = node.rank, node.size
        self._waits = node_memory(comm, node, node.size) if node.size > 1 else memoryview(bytearray(1))
        node.Free()

    @property
    def count(self) -> int:
        """Cores that this rank may use at present: its own and its share of those of waiting ranks."""
        waiting = sum(self._waits)
        return 1 + waiting // max(1, self._size - waiting)

    @contextmanager
    def lent(self) -> Iterator[None]:
        """Context in which this rank waits, and its core may be used by others."""
        self._waits[self._rank] = self._size > 1
        try:
            yield
        finally:
            self._waits[self._rank] = 0

    @contextmanager
    def used(self) -> Iterator[None]:
        """Context in which BLAS uses `count` cores; see `Threads`."""
        count = self.count
        if count == 1:
            yield
            return
        affinity = os.sched_getaffinity(0)
        os.sched_setaffinity(0, range(os.cpu_count() or 1))  # mpirun binds each rank to one core
        try:
            with threadpool_limits(limits=count, user_api="blas"):
                yield
        finally:
            os.sched_setaffinity(0, affinity)
