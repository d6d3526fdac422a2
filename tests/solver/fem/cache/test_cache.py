"""The cache: what it keeps, for how long, and that no fault of it reaches a result."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
from dataclasses import dataclass

import numpy as np
import pytest

from evolvent.fem.cache import cache as module
from evolvent.fem.cache.cache import LEFT_OVER, NOT_KEPT, SIZE, Cache
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError

KILOBYTES = 100
"""Size of a value."""


@dataclass(frozen=True, eq=False)
class Value:
    """An array."""

    array: Floats


@pytest.fixture
def cache(kept: Cache) -> Cache:
    """A cache of ten values in a folder of its own."""
    return Cache(10.5e-6 * KILOBYTES)


def made(number: int) -> Value:
    """The value for a number."""
    return Value(np.full(KILOBYTES * 1000 // 8, float(number)))


def value_of(cache: Cache, number: int, calls: list[int]) -> Value:
    """The value for a number from the cache; `calls` gets the numbers of those that are made."""

    def make() -> Value:
        calls.append(number)
        return made(number)

    return cache.kept(f"value {number}", ("values", number), Value, make)


def test_a_value_is_made_once(cache: Cache) -> None:
    """The second call reads, also by another object of the cache; other inputs are another value."""
    calls: list[int] = []
    for number, by in ((1, cache), (1, Cache(cache.size_GB)), (2, cache), (1, cache)):
        assert np.array_equal(value_of(by, number, calls).array, made(number).array)
    assert calls == [1, 2]
    assert {each.about for each in cache.entries()} == {"value 1", "value 2"}


def test_a_value_of_another_program_is_not_used(cache: Cache, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another version has another identity: it makes its own value, and the old one stays."""
    calls: list[int] = []
    value_of(cache, 1, calls)
    monkeypatch.setattr(module, "program_identity", lambda: "another")
    value_of(cache, 1, calls)
    assert calls == [1, 1] and len(cache.entries()) == 2


def test_the_ones_used_least_recently_go(cache: Cache) -> None:
    """Problem: ten values fit; the first one is read again before the twelfth is written. Exact: the second and third
    are gone, the folder is within its size."""
    calls: list[int] = []
    for number in range(10):
        value_of(cache, number, calls)
        os.utime(cache.entries()[0].path, (number, number))
    value_of(cache, 0, calls)
    for number in (10, 11):
        value_of(cache, number, calls)
    names = {each.about for each in cache.entries()}
    assert names == {f"value {number}" for number in (0, *range(3, 12))}
    assert sum(each.size for each in cache.entries()) <= cache.bound


def test_a_value_larger_than_the_cache_is_not_kept(cache: Cache, caplog: pytest.LogCaptureFixture) -> None:
    """It is made each time, removes nothing else, and the log says so."""
    small, calls = Cache(0.5e-6 * KILOBYTES), list[int]()
    value_of(cache, 1, calls)
    with caplog.at_level(logging.INFO, "evolvent"):
        value_of(small, 2, calls)
    assert calls == [1, 2] and [each.about for each in cache.entries()] == ["value 1"]
    assert "not kept: value 2" in caplog.text


@pytest.mark.parametrize("content", [b"", b"another file", None])
def test_a_damaged_file_is_made_again(
    cache: Cache, content: bytes | None, caplog: pytest.LogCaptureFixture
) -> None:
    """An empty file, one of another program, a flipped bit: the value is made again and kept, with a word in the log.
    """
    calls: list[int] = []
    value_of(cache, 1, calls)
    path = cache.entries()[0].path
    whole = path.read_bytes()
    path.write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]) if content is None else content)
    with caplog.at_level(logging.INFO, "evolvent"):
        assert np.array_equal(value_of(cache, 1, calls).array, made(1).array)
    assert "damaged" in caplog.text and "made again" in caplog.text
    value_of(cache, 1, calls)
    assert calls == [1, 1]


@pytest.mark.parametrize("error", [MemoryError("too little"), OSError("busy")])
def test_a_file_that_cannot_be_read_now_stays(
    error: Exception, cache: Cache, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Memory that runs out or a disk that does not answer damages no file: the value is made, the log says why, and
    the file is read the next time."""
    calls: list[int] = []
    value_of(cache, 1, calls)

    def failing(path: object) -> None:
        raise error

    with monkeypatch.context() as patched, caplog.at_level(logging.INFO):
        patched.setattr(module, "read_value", failing)
        assert np.array_equal(value_of(cache, 1, calls).array, made(1).array)
    assert calls == [1, 1] and f"not from the cache: value 1 ({cache.entries()[0].path}: {error})" in caplog.text
    value_of(cache, 1, calls)
    assert calls == [1, 1]


def test_nothing_is_read_or_kept_where_the_size_is_0(cache: Cache, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a cache each call makes its value; by the environment variable, too."""
    calls: list[int] = []
    value_of(cache, 1, calls)
    monkeypatch.setenv(SIZE, "0")
    for none in (NOT_KEPT, Cache.of_environment()):
        value_of(none, 1, calls)
        assert not none.entries() and none.clear() == 0
    assert calls == [1, 1, 1]
    monkeypatch.setenv(SIZE, "2")
    assert Cache.of_environment().bound == 2e9
    monkeypatch.delenv(SIZE)
    assert Cache.of_environment().size_GB is None and Cache.of_environment().bound > 0.0


@pytest.mark.parametrize("size", ["many", "-1", "nan", "inf", "20 GB"])
def test_a_size_that_is_none_is_refused(size: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The message names the environment variable, what it holds and what to do."""
    monkeypatch.setenv(SIZE, size)
    with pytest.raises(InputError, match=f"{SIZE}: wanted a size .*found '{size}'; correct it"):
        Cache.of_environment()


@pytest.mark.parametrize("fault", ["full disk", "folder gone"])
def test_a_value_that_cannot_be_written_is_returned(
    cache: Cache, fault: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """A full disk, or a folder that was removed: the value itself, and a word in the log."""
    if fault == "folder gone":
        assert cache.folder is not None
        cache.folder.rmdir()
    else:

        def full(*_: object) -> int:
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(module, "write_value", full)
    calls: list[int] = []
    with caplog.at_level(logging.INFO, "evolvent"):
        assert np.array_equal(value_of(cache, 1, calls).array, made(1).array)
    assert "not kept: value 1" in caplog.text


def test_what_a_killed_program_has_left_goes(cache: Cache) -> None:
    """An unfinished file: it is no value; after a day the next write removes it, `clear` at once."""
    calls: list[int] = []
    assert cache.folder is not None
    old, new = (cache.folder / f"{name}.part" for name in ("old", "new"))
    for path in (old, new):
        path.write_bytes(b"begun")
    os.utime(old, (new.stat().st_mtime - 2 * LEFT_OVER,) * 2)
    value_of(cache, 1, calls)
    assert len(cache.entries()) == 1 and not old.exists() and new.exists()
    assert cache.clear() > 5 and not list(cache.folder.iterdir())


def _write_for_ever(size: float) -> None:
    while True:
        Cache(size).write("a" * 64, made(1), Value, "value 1")


def test_writers_that_are_killed_leave_whole_values(cache: Cache) -> None:
    """Problem: two processes write the same value over and over, both are killed. Exact: at each moment the value is
    whole, or there is none."""
    assert cache.size_GB is not None
    context = multiprocessing.get_context("fork")
    writers = [context.Process(target=_write_for_ever, args=(cache.size_GB,)) for _ in range(2)]
    for writer in writers:
        writer.start()
    seen = 0
    while seen < 30:
        found = cache.read("a" * 64, Value, "value 1")
        if found is not None:
            assert np.array_equal(found.array, made(1).array)
            seen += 1
    for writer in writers:
        assert writer.pid is not None
        os.kill(writer.pid, signal.SIGKILL)
        writer.join()
    found = cache.read("a" * 64, Value, "value 1")
    assert found is not None and np.array_equal(found.array, made(1).array)
