"""Independent tasks of different cost, divided among ranks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

import numpy as np
from mpi4py import MPI

from evolvent.fem.parallel.ranks import shared

K = TypeVar("K")
T = TypeVar("T")


def divided(costs: Sequence[float], busy: Sequence[float]) -> list[list[int]]:
    """The tasks of each rank, the dearest first: each goes to the rank that has least to do.

    costs: of each task. busy: cost of the other work of each rank.
    """
    load = np.array(busy, dtype=float)
    own: list[list[int]] = [[] for _ in busy]
    for task in np.argsort(-np.asarray(costs, dtype=float), kind="stable").tolist():
        rank = int(np.argmin(load))
        own[rank].append(task)
        load[rank] += costs[task]
    return own


def exchanged(comm: MPI.Comm, own: Mapping[K, T]) -> dict[K, T]:
    """Union of the mappings of all ranks, on all ranks; their keys differ. Collective. Raises OSError."""
    everything: dict[K, T] = {}
    for root in range(comm.size):
        everything |= shared(comm, own if comm.rank == root else None, root)
    return everything
