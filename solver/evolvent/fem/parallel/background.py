"""Items of an iterator, computed in the background while this rank takes part in what all ranks do."""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar, cast

from mpi4py import MPI

T = TypeVar("T")


def computed_ahead(items: Iterator[T], count: int) -> Generator[T, None, None]:
    """The items, up to `count` of them computed before they are asked for, in a thread.

    Only this thread may use PETSc meanwhile, as that is not made for several. Where MPI does not allow calls from
    several threads at once, each item is computed when it is asked for. Raises what computing an item raises. Close it
    where it is left early: that waits for the item that is being computed.
    """
    if MPI.Query_thread() < MPI.THREAD_MULTIPLE:
        yield from items
        return
    end = object()
    with ThreadPoolExecutor(1, "ahead") as thread:
        coming = deque(thread.submit(next, items, end) for _ in range(count))
        try:
            while (item := coming.popleft().result()) is not end:
                coming.append(thread.submit(next, items, end))
                yield cast(T, item)
        finally:
            for each in coming:
                each.cancel()
