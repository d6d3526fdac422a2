"""What ranks do together: fail alike, share arrays once a node, say where there is no room for them."""

from __future__ import annotations

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.fem.parallel import ranks
from tests.support.running.processes import RunScript, on_ranks

SHARE = """
import numpy as np
from mpi4py import MPI
from evolvent.fem.parallel import ranks

class Nodes:
    '''The world, with two ranks a node.'''
    def __getattr__(self, name):
        return getattr(MPI.COMM_WORLD, name)
    def Split_type(self, kind, key):
        return MPI.COMM_WORLD.Split(MPI.COMM_WORLD.rank // 2, key)

ranks.CHUNK = 1_000_003
rank, size = MPI.COMM_WORLD.rank, MPI.COMM_WORLD.size
for comm in (MPI.COMM_WORLD, Nodes()):
    for root in range(size):
        a = np.random.default_rng(root).standard_normal((700, 901))
        value = {"a": a, "fortran": np.asfortranarray(a[:300]), "view": a[::2, ::3]}
        value |= {"flags": a > 0, "no": a[:0], "s": "x"}
        got = ranks.shared(comm, value if rank == root else None, root)
        assert got["s"] == "x" and got["fortran"].flags.f_contiguous
        for name in ("a", "fortran", "view", "flags", "no"):
            assert np.array_equal(got[name], value[name]) and got[name].dtype == value[name].dtype, name
        maps = open("/proc/self/maps").read()
        assert ("evolvent-" in maps) == (size > 1) and not (size > 1 and got["a"].flags.writeable)
        del got
        assert "evolvent-" not in open("/proc/self/maps").read()
print("fine")
"""

FAIL_ALIKE = r"""
import sys
from mpi4py import MPI
from evolvent.fem.parallel import ranks

class Stubborn(Exception):
    def __init__(self, a, b):
        super().__init__(f"{a}{b}")

comm = MPI.COMM_WORLD
def work():
    if comm.rank == 1:
        raise ValueError("one") if sys.argv[1] == "plain" else Stubborn("o", "ne")
try:
    ranks.together(comm, work)
except (ValueError, RuntimeError) as error:
    sys.stdout.write(f"rank {comm.rank}: {type(error).__name__} {error}; {error.__notes__[0].splitlines()[0]}\n")
"""


@pytest.mark.parametrize("size", on_ranks(1, 2, 3, 4))
def test_shared_arrays_are_identical_on_all_ranks(size: int, run_script: RunScript) -> None:
    """Every kind of array arrives bit by bit from every root, on one node and on nodes of two ranks, in pieces; it is
    read-only, in shared memory, and the memory is given back with the last array."""
    done = run_script("-c", SHARE, ranks=size)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("fine") == size


@pytest.mark.mpi
@pytest.mark.parametrize(("kind", "found"), [("plain", "ValueError one"), ("stubborn", "RuntimeError Stubborn: one")])
def test_failure_of_a_rank_is_raised_on_all(kind: str, found: str, run_script: RunScript) -> None:
    """One rank's exception is raised on all, with a note of where; also one that cannot be pickled."""
    done = run_script("-c", FAIL_ALIKE, kind, ranks=3)
    assert sorted(done.stdout.splitlines()) == [f"rank {rank}: {found}; on rank 1 of 3:" for rank in range(3)]


def test_no_room_for_shared_memory_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """A node without room is an error that says what to do, not a bus error later."""
    monkeypatch.setattr(ranks, "MEMORY_FOLDERS", ("/nowhere", "/proc/self"))
    with pytest.raises(OSError, match=r"wanted 5 MB of memory shared by the ranks of a node.*--shm-size"):
        ranks._memory_file(5_000_000)


def test_single_rank_copies_nothing() -> None:
    """On one rank `shared` and `together` cost nothing and copy nothing."""
    value = np.arange(10)
    assert ranks.shared(MPI.COMM_SELF, value, 0) is value
    assert ranks.on_first(MPI.COMM_SELF, lambda: value) is value
