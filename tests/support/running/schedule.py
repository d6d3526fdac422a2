"""The order in which pytest-xdist's workers get test files: those that take longest first.

A worker that gets a long file last works alone at the end. How long a file takes is told by its markers. One mpirun
runs at a time (processes.py), so that two workers with such files would wait for each other.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest
from xdist.scheduler import LoadFileScheduling
from xdist.workermanage import WorkerController

SLOW, MPI, OTHER = 20.0, 5.0, 0.3
"""Seconds of a test marked `slow`, of one marked `mpi`, and of any other, about."""


def longest_files_first(items: list[pytest.Item]) -> None:
    """Sorts collected tests; those of a file stay together, in their order."""
    seconds: defaultdict[Path, float] = defaultdict(float)
    for item in items:
        marks = {mark.name for mark in item.iter_markers()}
        seconds[item.path] += SLOW if "slow" in marks else MPI if "mpi" in marks else OTHER
    items.sort(key=lambda item: (-seconds[item.path], str(item.path)))


@cache
def starts_mpirun(file: Path) -> bool:
    """Whether a test of this file is marked `mpi`, as its text has it: what hands out files sees no markers."""
    text = file.read_text(encoding="utf-8")
    return "pytest.mark.mpi" in text or "on_ranks(" in text


class CollectedOrder(LoadFileScheduling):
    """A file goes to one worker, for its tests share what is costly to compute. The first worker gets files that start
    mpirun as long as there are any, the others those that do not; each in the order in which they were collected.
    xdist itself sends those with the most tests first, in some of its versions."""

    def _assign_work_unit(self, node: WorkerController) -> None:
        place = {name: number for number, name in enumerate(self.collection)}
        wanted = node is self.nodes[0]

        def rank(file: str) -> tuple[bool, int]:
            return starts_mpirun(self.config.rootpath / file) != wanted, place[next(iter(self.workqueue[file]))]

        self.workqueue.move_to_end(min(self.workqueue, key=rank), last=False)
        super()._assign_work_unit(node)
