"""Memory for large arrays that come and go: pages that a process has are used again, instead of going back and forth.

A page that is new to a process costs more than anything that is done to it once: the first write to 512 MB took ten
times as long as the second (measured on a virtual machine; 0.4 s a GB). glibc gives arrays above 32 MB pages of their
own and takes them back with the array. Condensing two gears touched 25 GB of new pages in that way, about a third of
its processor time.
"""

from __future__ import annotations

import ctypes
import mmap
import os
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from evolvent_meshes.arrays import Floats

_TRIM_THRESHOLD, _TOP_PAD, _MMAP_MAX = -1, -2, -4  # malloc.h of glibc
_NEVER = 2**31 - 1  # bytes
_PAD = 1 << 26  # bytes
_NORESERVE = 0x4000  # mman.h of Linux; Python has no name for it
_ALIGNMENT = 64  # bytes: a cache line


def keep_freed_memory() -> None:
    """Let freed arrays stay with the process until `return_free_memory` (glibc; elsewhere nothing). To be called
    before the first large array: `body.assemble` does."""
    set_option = getattr(ctypes.CDLL(None), "mallopt", None)
    if set_option is not None:
        set_option(_MMAP_MAX, 0)
        set_option(_TRIM_THRESHOLD, _NEVER)
        set_option(_TOP_PAD, _PAD)


def return_free_memory() -> None:
    """Give freed memory back to the system (glibc; elsewhere nothing)."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)


def untouched_square(size: int) -> Floats:
    """(size × size) of zeros whose pages come when they are first written to."""
    return np.frombuffer(mmap.mmap(-1, max(8 * size**2, 1)), count=size**2).reshape(size, size)


class Stack:
    """Arrays that are given up in the reverse order of their making, in one piece of memory that grows to the largest
    sum of them, is not fragmented, and has large pages where the system has them."""

    def __init__(self) -> None:
        # addresses for all the machine's memory; pages come when they are first written to
        size = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        self._memory = mmap.mmap(-1, size, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | _NORESERVE)
        if hasattr(mmap, "MADV_HUGEPAGE"):
            self._memory.madvise(mmap.MADV_HUGEPAGE)
        self._top = 0

    def empty(self, rows: int, columns: int) -> Floats:
        """A new (rows × columns) in C order, of any content. Raises MemoryError where the machine has no more."""
        size = 8 * rows * columns
        if self._top + size > len(self._memory):
            raise MemoryError(
                f"wanted {size / 1e9:.1f} GB beside {self._top / 1e9:.1f} GB, found {len(self._memory) / 1e9:.1f} GB "
                "of memory in all: take a coarser mesh or a machine with more memory"
            )
        found = np.frombuffer(self._memory, dtype=np.float64, count=rows * columns, offset=self._top)
        self._top += -(-size // _ALIGNMENT) * _ALIGNMENT
        return found.reshape(rows, columns)

    @contextmanager
    def given_up_after(self) -> Iterator[None]:
        """What is made within is given up at the end: nobody may use it after that."""
        top = self._top
        try:
            yield
        finally:
            self._top = top
