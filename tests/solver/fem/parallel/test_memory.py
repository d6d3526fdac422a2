"""Stack allocator, freed memory and what an object holds: reuse, release, error beyond the memory of the machine."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.fem.parallel.memory import Stack, array_bytes, lazy_zeros
from evolvent_meshes.arrays import Floats
from tests.support.running.processes import RunScript

KEPT = """
import numpy as np
from evolvent_meshes.shapes.blocks import rectangle
from evolvent.fem.body import Body, assemble
from evolvent.fem.parallel.memory import return_free_memory

def resident():
    return int(open("/proc/self/statm").read().split()[1]) * 4096

assemble(Body(rectangle(1.0, 1.0, 1, 1)))
before = resident()
array = np.ones(1 << 23)
del array
kept = resident()
return_free_memory()
print(kept - before, resident() - before)
"""


def test_released_memory_is_reused() -> None:
    """Three arrays, two of them in a context: the next one has the address of the first of these, and the one below is
    unchanged."""
    stack = Stack()
    below = stack.empty(3, 5)
    below[:] = 1.0
    with stack.released_at_exit():
        first = stack.empty(100, 10)
        second = stack.empty(7, 7)
        first[:], second[:] = 2.0, 3.0
        assert np.all(first == 2.0) and np.all(second == 3.0)
    again = stack.empty(50, 4)
    assert again.ctypes.data == first.ctypes.data
    again[:] = 4.0
    assert np.all(below == 1.0)


def test_memory_is_released_after_an_error() -> None:
    """Arrays are released where their context is left by an error."""
    stack = Stack()
    made = []

    def fails() -> None:
        with stack.released_at_exit():
            made.append(stack.empty(2, 2))
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fails()
    assert stack.empty(2, 2).ctypes.data == made[0].ctypes.data


def test_array_larger_than_the_machine_is_refused() -> None:
    """An array larger than all memory is refused with both sizes, not by the kernel."""
    columns = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 8
    with pytest.raises(MemoryError, match="take a coarser mesh"):
        Stack().empty(2, columns)


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "mallopt"), reason="what the C library does, here glibc's")
def test_freed_arrays_stay_until_returned(run_script: RunScript) -> None:
    """In a new process, once a stiffness is assembled, 64 MB that were written to and freed are still resident; given
    back they are not."""
    done = run_script("-c", KEPT)
    assert done.returncode == 0, done.stderr[-3000:]
    kept, returned = map(int, done.stdout.split())
    assert kept > 60e6 and returned < 10e6


@dataclass(frozen=True)
class Gear:
    """What results share."""

    stiffness: Floats


@dataclass(frozen=True)
class Found:
    """A result with arrays, one of them in several places, and with what it has derived."""

    gear: Gear
    parts: dict[str, Sequence[Floats]]
    matrix: sp.csr_matrix

    @cached_property
    def total(self) -> Floats:
        """(n,)."""
        return np.asarray(sum(self.parts["all"]))


def test_arrays_are_counted_once() -> None:
    """A result of 8 kB, the same again, every third of its numbers, a sparse matrix with three entries of 8 bytes and
    its indices, and a gear that is not counted: 8 kB and the matrix; once it has derived another 8 kB, these too."""
    one = np.ones(1000)
    found = Found(Gear(np.ones(5000)), {"all": (one, one), "some": [one[::3]]}, sp.identity(3, format="csr"))
    matrix = 24 + found.matrix.indices.nbytes + found.matrix.indptr.nbytes
    assert array_bytes(found, Gear) == 8000 + matrix
    assert array_bytes(found, Found) == 0
    assert found.total[0] == 2.0
    assert array_bytes(found, Gear) == 16000 + matrix


def test_lazy_zeros_is_zero() -> None:
    """(n × n) zeros that can be written to; n = 0 too."""
    square = lazy_zeros(3)
    square[1, 2] = 5.0
    assert square.sum() == 5.0 and lazy_zeros(0).shape == (0, 0)
