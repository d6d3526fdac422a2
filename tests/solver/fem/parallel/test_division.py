"""Tasks of different cost, divided among ranks."""

from __future__ import annotations

import pytest

from evolvent.fem.parallel.division import divided
from tests.support.running.processes import RunScript, on_ranks

EXCHANGE = """
from mpi4py import MPI
from evolvent.fem.parallel.division import exchanged

comm = MPI.COMM_WORLD
found = exchanged(comm, {(comm.rank, name): name for name in "ab"})
assert found == {(rank, name): name for rank in range(comm.size) for name in "ab"}
assert list(found) == sorted(found)
print("fine")
"""


def test_each_task_goes_to_the_rank_with_least_to_do() -> None:
    """Five tasks, two ranks of which one is busy, and all tasks on a single rank; equal ones in their order. Exact."""
    assert divided([1.0, 4.0, 2.0, 3.0, 1.0], [0.0, 2.0]) == [[1, 2, 4], [3, 0]]
    assert divided([1.0, 2.0, 2.0], [5.0]) == [[1, 2, 0]]
    assert divided([], [0.0, 0.0]) == [[], []]


@pytest.mark.parametrize("size", on_ranks(1, 2, 3))
def test_all_ranks_get_what_each_has(size: int, run_script: RunScript) -> None:
    """In the order of the ranks."""
    done = run_script("-c", EXCHANGE, ranks=size)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("fine") == size
