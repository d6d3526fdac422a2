"""Items that are computed ahead of their use."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from threading import Event, current_thread, main_thread
from time import monotonic, sleep

import pytest
from mpi4py import MPI

from evolvent.fem.parallel.background import computed_ahead

LONG, PAUSE = 20.0, 0.01
"""How long a test waits for a thread at most, and between two looks [s]."""


@pytest.fixture(autouse=True)
def threads_in_mpi(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if MPI allowed calls from several threads; none are made here."""
    monkeypatch.setattr(MPI, "Query_thread", lambda: MPI.THREAD_MULTIPLE)


def test_items_come_in_order_and_ahead() -> None:
    """Two items ahead: before the first has been used, the second and the third are computed, and no fourth: the thread
    has nothing else to do when it has computed the third."""
    begun: list[int] = []

    def counted() -> Iterator[int]:
        for number in range(10):
            assert current_thread() is not main_thread()
            begun.append(number)
            yield number

    with closing(computed_ahead(counted(), 2)) as items:
        assert next(items) == 0
        wait_until(lambda: len(begun) == 3)
        sleep(10 * PAUSE)
        assert begun == [0, 1, 2]
        assert list(items) == list(range(1, 10))


def test_items_that_are_not_wanted_are_not_begun() -> None:
    """Closed after the first while the second is computed: that one ends, and the third and the fourth of three ahead
    never begin."""
    begun: list[int] = []
    closing_now = Event()

    def waiting() -> Iterator[int]:
        for number in range(10):
            begun.append(number)
            if number == 1:
                assert closing_now.wait(LONG)
                sleep(10 * PAUSE)  # until the others are cancelled
            yield number

    items = computed_ahead(waiting(), 3)
    assert next(items) == 0
    wait_until(lambda: len(begun) == 2)
    closing_now.set()
    items.close()
    assert begun == [0, 1]
    assert list(items) == []


def wait_until(is_so: Callable[[], bool]) -> None:
    """Waits for what a thread does."""
    end = monotonic() + LONG
    while not is_so():
        assert monotonic() < end
        sleep(PAUSE)


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
