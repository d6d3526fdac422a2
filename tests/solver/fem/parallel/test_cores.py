"""Cores of waiting ranks are used by working ones, and returned."""

from __future__ import annotations

import os

import pytest
from mpi4py import MPI
from threadpoolctl import threadpool_info

from evolvent.fem.parallel.cores import Cores
from tests.support.running.processes import RunScript

LEND = """
import os, sys, time
from functools import partial
from mpi4py import MPI
from threadpoolctl import threadpool_info
from evolvent.fem.parallel.cores import Cores
from evolvent.fem.parallel.ranks import together

comm = MPI.COMM_WORLD
cores = Cores(comm)

def threads():
    return max(info["num_threads"] for info in threadpool_info() if info["user_api"] == "blas")

def work(busy):
    '''The number of cores at the begin and once all the others wait; BLAS threads with them and after.'''
    if comm.rank != busy:
        return None
    found = [cores.count, threads()]
    deadline = time.monotonic() + 60.0
    while cores.count < comm.size and time.monotonic() < deadline:
        time.sleep(0.01)
    found.append(cores.count)
    with cores.used():
        found += [threads(), len(os.sched_getaffinity(0))]
    return [*found, threads()]

own = len(os.sched_getaffinity(0))
for busy in range(comm.size):
    found = together(comm, partial(work, busy), cores.lent)
    if found is not None:
        begin, before, count, within, affinity, after = found
        assert count == within == comm.size and before == after == 1 and affinity == os.cpu_count(), found
    assert len(os.sched_getaffinity(0)) == own and cores.count == 1
    comm.Barrier()
sys.stdout.write("fine\\n")
"""


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", [2, 3])
def test_waiting_ranks_lend_their_cores(ranks: int, run_script: RunScript) -> None:
    """Each rank in turn works while the others wait: it has as many BLAS threads as there are ranks, and may run on
    every processor; afterwards it has one thread and its own processors again."""
    done = run_script("-c", LEND, ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    assert done.stdout.count("fine") == ranks


def test_cores_of_a_single_rank_are_unchanged() -> None:
    """A single rank has no other cores to use: BLAS keeps the number of threads that the user has set."""
    cores, before = Cores(MPI.COMM_SELF), threadpool_info()
    with cores.lent(), cores.used():
        assert cores.count == 1 and threadpool_info() == before
    assert len(os.sched_getaffinity(0)) >= 1
