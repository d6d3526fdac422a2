"""Collective operations of ranks: raise the same error, wait without a busy core, share a large object.

Gears are condensed on one rank and used by all. `shared` broadcasts an object whose arrays lie in memory that all ranks
of a node map: one copy a node, and no limit of 2 GB as MPI and pickle have. The memory is an unlinked file, not an MPI
window: it is freed with the last array (freeing a window is collective), and a node without room for it is an error on
all ranks (Open MPI's windows hang where /dev/shm is as small as in Docker).
"""

from __future__ import annotations

import mmap
import os
import pickle
import tempfile
import time
import traceback
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import TypeVar

import numpy as np
from mpi4py import MPI

T = TypeVar("T")
Context = AbstractContextManager[None]

SMALL = 1 << 12  # [bytes] arrays below stay in the pickle
CHUNK = 1 << 28  # [bytes] sent at once between nodes; MPI counts in 32-bit integers
ALIGNMENT = 64  # [bytes] of each array: a cache line
SPARE_ROOM = 1.3  # of memory that had to grow: the next object may be larger still
POLLING = 0.002  # [s] between two tests of a barrier
MEMORY_FOLDERS = ("/dev/shm", tempfile.gettempdir())  # memory where it is large enough, else a file in the page cache


def wait_for_all(comm: MPI.Comm) -> None:
    """A barrier that sleeps; MPI's barrier keeps a core busy that a working rank may need."""
    request = comm.Ibarrier()
    while not request.Test():
        time.sleep(POLLING)


def together(comm: MPI.Comm, work: Callable[[], T], waiting: Callable[[], Context] = nullcontext) -> T:
    """The result of `work` on this rank. Collective: all ranks must call it.

    waiting: makes the context in which this rank waits for the others.
    Raises on every rank the exception of the lowest rank on which `work` failed, with a note that names the rank.
    """
    if comm.size == 1:
        return work()
    failure: Exception | None = None
    try:
        result = work()
    except Exception as error:
        trace = "".join(traceback.format_tb(error.__traceback__)).rstrip()
        error.add_note(f"on rank {comm.rank} of {comm.size}:\n{trace}")
        failure = _portable(error)
    with waiting():
        wait_for_all(comm)
    for other in comm.allgather(failure):
        if other is not None:
            raise other
    return result


def on_first(comm: MPI.Comm, work: Callable[[], T]) -> T:
    """The result of `work` of rank 0, on all ranks. Collective. Raises its exception on all ranks."""
    if comm.size == 1:
        return work()
    result = together(comm, lambda: work() if comm.rank == 0 else None)
    everywhere: T = comm.bcast(result, root=0)
    return everywhere


def shared(comm: MPI.Comm, value: T | None, root: int) -> T:
    """Object `value` of rank `root` on all ranks; with several ranks its arrays are read-only and exist once a node.

    Collective. The memory is freed with the last array. Raises OSError where a node has no room for it.
    """
    if comm.size == 1:
        assert value is not None
        return value
    broadcast = SharedBroadcast(comm, root)
    received = broadcast.send(value)
    broadcast.close()
    return received


class SharedBroadcast:
    """Broadcasts one object after another from one rank to all, through the same shared memory.

    140 MB took 0.09 s the first time, as the pages were new, and 0.007 s each other time. Construction and all methods
    are collective.
    """

    def __init__(self, comm: MPI.Comm, root: int) -> None:
        key = 0 if comm.rank == root else comm.rank + 1  # the root leads its node, and that node leads the others
        self._comm, self._root = comm, root
        self._node = comm.Split_type(MPI.COMM_TYPE_SHARED, key)
        self._leaders = comm.Split(0 if self._node.rank == 0 else MPI.UNDEFINED, key)
        self._memory = memoryview(b"")

    def send(self, value: T | None) -> T:
        """The root's `value` on all ranks; its arrays are read-only, once a node, and valid until the next call.

        Raises OSError where a node has no room for it.
        """
        parts = _parts(value) if self._comm.rank == self._root else []
        sizes: list[int] = self._comm.bcast([part.nbytes for part in parts], root=self._root)
        *starts, total = np.cumsum([0] + [-(-size // ALIGNMENT) * ALIGNMENT for size in sizes]).tolist()
        if total > len(self._memory):
            room = total if len(self._memory) == 0 else int(SPARE_ROOM * total)
            self._memory = node_memory(self._comm, self._node, room)
        for start, part in zip(starts, parts):
            self._memory[start : start + part.nbytes] = part
        if self._node.rank == 0:
            _send(self._leaders, self._memory[:total])
        self._node.Barrier()
        kept = self._memory.toreadonly()
        head, *arrays = (kept[start : start + size] for start, size in zip(starts, sizes))
        restored: T = pickle.loads(head, buffers=arrays)
        return restored

    def close(self) -> None:
        """Free the communicators; the memory is freed with the last array."""
        if self._node.rank == 0:
            self._leaders.Free()
        self._node.Free()


def _parts(value: object) -> list[memoryview]:
    """The pickle of a value, and the buffers of the large arrays, which are not in the pickle."""
    arrays: list[memoryview] = []

    def stays_inside(buffer: pickle.PickleBuffer) -> bool:
        view = buffer.raw()
        if view.nbytes >= SMALL:
            arrays.append(view)
        return view.nbytes < SMALL

    head = pickle.dumps(value, protocol=5, buffer_callback=stays_inside)
    return [memoryview(head), *arrays]


def node_memory(comm: MPI.Comm, node: MPI.Comm, size: int) -> memoryview:
    """Memory of `size` bytes that all ranks of a node share. Collective. Raises OSError on all ranks."""
    path = together(comm, lambda: _memory_file(size) if node.rank == 0 else "")
    path = node.bcast(path, root=0)
    try:
        return together(comm, lambda: memoryview(_mapped(path, size)))
    finally:
        if node.rank == 0:
            os.unlink(path)


def _memory_file(size: int) -> str:
    """The path of a new file of `size` bytes, in memory if there is room. Raises OSError."""
    for folder in MEMORY_FOLDERS:
        try:
            descriptor, path = tempfile.mkstemp(prefix="evolvent-", dir=folder)
        except OSError:
            continue
        try:
            os.posix_fallocate(descriptor, 0, size)  # full now is an error, full later would be a bus error
            return path
        except OSError:
            os.unlink(path)
        finally:
            os.close(descriptor)
    raise OSError(
        f"{' or '.join(MEMORY_FOLDERS)}: wanted {size / 1e6:.0f} MB of memory shared by the ranks of a node, found "
        "less; make room (docker run --shm-size=8g), set TMPDIR to a larger disk, or use one rank"
    )


def _mapped(path: str, size: int) -> mmap.mmap:
    with open(path, "r+b") as file:
        return mmap.mmap(file.fileno(), size)


def _send(leaders: MPI.Comm, memory: memoryview) -> None:
    """Broadcast the memory of rank 0's node to the other nodes."""
    if leaders.size == 1:
        return
    for start in range(0, memory.nbytes, CHUNK):
        leaders.Bcast([memory[start : start + CHUNK], MPI.BYTE], root=0)


def _portable(error: Exception) -> Exception:
    """The exception, or a RuntimeError with its message and notes where it cannot be pickled."""
    try:
        pickle.loads(pickle.dumps(error))
        return error
    except Exception:
        sent = RuntimeError(f"{type(error).__name__}: {error}")
        for note in error.__notes__:
            sent.add_note(note)
        return sent
