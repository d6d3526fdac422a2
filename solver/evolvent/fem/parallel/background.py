"""Items of an iterator, computed in the background while this rank takes part in what all ranks do."""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import islice
from typing import TypeVar

from mpi4py import MPI

T = TypeVar("T")


def computed_ahead(items: Iterator[T], count: int) -> Generator[T, None, None]:
    """The items, up to `count` of them computed before they are asked for, in a thread.

    While they are computed, the caller must not use PETSc, which is not made for several threads. PETSc and the caller
    both call MPI: where that does not allow calls from several threads at once, each item is computed when it is asked
    for. Raises what computing an item raises. Close it where it is left early: that waits for the item that is being
    computed.
    """
    if MPI.Query_thread() < MPI.THREAD_MULTIPLE:
        yield from items
        return
    with ThreadPoolExecutor(1, "ahead") as thread:
        coming = deque(thread.submit(_first, items) for _ in range(count))
        try:
            while found := coming.popleft().result():
                coming.append(thread.submit(_first, items))
                yield found.pop()  # so that no item is kept here while it is used
        finally:
            for each in coming:
                each.cancel()


def _first(items: Iterator[T]) -> list[T]:
    """A list of the next item, empty at the end."""
    return list(islice(items, 1))
