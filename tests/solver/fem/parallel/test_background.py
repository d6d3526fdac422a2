"""Items that are computed ahead of their use."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from threading import Event, current_thread, main_thread

import pytest
from mpi4py import MPI

from evolvent.fem.parallel.background import computed_ahead

LONG = 20.0  # [s] that a test waits for a thread at most


def counted(begun: list[int], ready: Event, count: int = 10) -> Iterator[int]:
    """Numbers from 0 on, each noted in `begun` as it is computed; `ready` is set at the third."""
    for number in range(count):
        assert current_thread() is not main_thread()
        begun.append(number)
        if number == 2:
            ready.set()
        yield number


def test_items_come_in_order_and_ahead() -> None:
    """Two items ahead: while the first is used, the second and the third are computed, and no fourth."""
    begun: list[int] = []
    ready = Event()
    with closing(computed_ahead(counted(begun, ready), 2)) as items:
        assert next(items) == 0
        assert ready.wait(LONG) and begun == [0, 1, 2]
        assert list(items) == list(range(1, 10))
    assert begun == list(range(10))


def test_items_that_are_not_wanted_are_not_begun() -> None:
    """Closed after the first of two ahead: the others that were begun end, and no more begin."""
    begun: list[int] = []
    ready = Event()
    items = computed_ahead(counted(begun, ready), 2)
    assert next(items) == 0 and ready.wait(LONG)
    items.close()
    assert begun == [0, 1, 2]
    assert list(items) == []


def test_an_error_is_raised_where_its_item_is_asked_for() -> None:
    """The items before it come first."""

    def failing() -> Iterator[int]:
        yield 1
        raise ArithmeticError("as the test wants")

    items = computed_ahead(failing(), 3)
    assert next(items) == 1
    with pytest.raises(ArithmeticError, match="as the test wants"):
        next(items)


def test_without_threads_in_mpi_nothing_is_computed_ahead(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where MPI allows no calls from several threads: each item as it is asked for, in the same thread."""
    monkeypatch.setattr(MPI, "Query_thread", lambda: MPI.THREAD_SERIALIZED)
    asked = []

    def here() -> Iterator[int]:
        for number in range(3):
            assert current_thread() is main_thread()
            asked.append(number)
            yield number

    items = computed_ahead(here(), 2)
    assert next(items) == 0 and asked == [0]
    assert list(items) == [1, 2]
