"""Memory of large arrays: a process keeps the pages that it has, instead of returning and requesting them again; and
how much memory a result takes.

The first write to a new page is expensive: writing to 512 MB took ten times as long the first time as the second
(measured on a virtual machine; 0.4 s a GB). glibc maps arrays above 32 MB separately and unmaps them with the array.
Condensing two gears touched 25 GB of new pages in that way, which was about a third of its processor time.
"""

from __future__ import annotations

import ctypes
import mmap
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from evolvent_meshes.arrays import Floats

_TRIM_THRESHOLD, _TOP_PAD, _MMAP_MAX = -1, -2, -4  # malloc.h of glibc
_NEVER = 2**31 - 1  # bytes
_PAD = 1 << 26  # bytes
_NORESERVE = 0x4000  # mman.h of Linux; Python has no name for it
_ALIGNMENT = 64  # bytes: a cache line


def keep_freed_memory() -> None:
    """Keep the memory of freed arrays in the process until `return_free_memory` (glibc; elsewhere without effect).

    It is called before the first large array, by `body.assemble`.
    """
    set_option = getattr(ctypes.CDLL(None), "mallopt", None)
    if set_option is not None:
        set_option(_MMAP_MAX, 0)
        set_option(_TRIM_THRESHOLD, _NEVER)
        set_option(_TOP_PAD, _PAD)


def return_free_memory() -> None:
    """Return freed memory to the system (glibc; elsewhere without effect)."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)


def array_bytes(held: object, shared: type) -> int:
    """Memory of all arrays that an object holds, in its attributes, lists and dictionaries and in theirs [bytes]; each
    is counted once, a view as the whole array behind it. shared: a class whose objects are left out, as others hold
    them too."""
    sizes: dict[int, int] = {}
    seen: set[int] = set()
    waiting = [held]
    while waiting:
        part = waiting.pop()
        if id(part) in seen or isinstance(part, (shared, type)):
            continue
        seen.add(id(part))
        if isinstance(part, np.ndarray):
            owner = _owner(part)
            sizes[id(owner)] = owner.nbytes
        elif isinstance(part, Mapping):
            waiting += part.values()
        elif isinstance(part, (list, tuple)):
            waiting += part
        else:
            waiting += getattr(part, "__dict__", {}).values()
    return sum(sizes.values())


def _owner(array: NDArray[Any]) -> NDArray[Any]:
    """The array behind a view."""
    while isinstance(array.base, np.ndarray):
        array = array.base
    return array


def lazy_zeros(size: int) -> Floats:
    """Zeros (size × size) whose pages are allocated when they are first written to."""
    return np.frombuffer(mmap.mmap(-1, max(8 * size**2, 1)), count=size**2).reshape(size, size)


class Stack:
    """Stack allocator: arrays in one mapping, released in the reverse order of their allocation.

    The mapping is not fragmented, grows to the largest sum of arrays, and has huge pages where the system has them.
    """

    def __init__(self) -> None:
        # addresses for all of the machine's memory; pages are allocated when they are first written to
        size = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        self._memory = mmap.mmap(-1, size, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | _NORESERVE)
        if hasattr(mmap, "MADV_HUGEPAGE"):
            self._memory.madvise(mmap.MADV_HUGEPAGE)
        self._top = 0

    def empty(self, rows: int, columns: int) -> Floats:
        """An uninitialised array (rows × columns) in C order. Raises MemoryError beyond the memory of the machine."""
        size = 8 * rows * columns
        if self._top + size > len(self._memory):
            raise MemoryError(
                f"wanted {size / 1e9:.1f} GB beside {self._top / 1e9:.1f} GB, found {len(self._memory) / 1e9:.1f} GB "
                "of memory in all: take a coarser mesh or a machine with more memory"
            )
        array = np.frombuffer(self._memory, dtype=np.float64, count=rows * columns, offset=self._top)
        self._top += -(-size // _ALIGNMENT) * _ALIGNMENT
        return array.reshape(rows, columns)

    @contextmanager
    def released_at_exit(self) -> Iterator[None]:
        """Context whose arrays are released when it is left; they must not be used afterwards."""
        top = self._top
        try:
            yield
        finally:
            self._top = top
