"""The order in which pytest-xdist's workers get test files: those that take longest first.

A worker that gets a long file last works alone at the end. How long files take stands in tests/durations.csv, which
`python -m tests.support.running.schedule JUNIT.xml ...` writes from reports of `pytest --junitxml`. One mpirun runs at
a time (processes.py), so that two workers with such files would wait for each other.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from statistics import median
from xml.etree import ElementTree

import pytest
from xdist.scheduler import LoadFileScheduling
from xdist.workermanage import WorkerController

from evidence.tables import read_csv, write_csv
from tests.support.checkout import ROOT

DURATIONS = ROOT / "tests/durations.csv"


def durations(table: Path = DURATIONS) -> dict[str, float]:
    """Test file below the root -> seconds that its tests took when they were last measured."""
    return {row["file"]: float(row["seconds"]) for row in read_csv(table)} if table.exists() else {}


def measured(reports: Iterable[Path]) -> dict[str, float]:
    """Test file -> seconds of its tests in JUnit reports of pytest together. Raises OSError, ElementTree.ParseError."""
    seconds: defaultdict[str, float] = defaultdict(float)
    for report in reports:
        for case in ElementTree.parse(report).iter("testcase"):
            seconds[case.attrib["classname"].replace(".", "/") + ".py"] += float(case.attrib["time"])
    return dict(seconds)


def update(reports: Iterable[Path], root: Path = ROOT, table: Path = DURATIONS) -> None:
    """Writes the table again: files of the reports have their seconds, others keep theirs as long as they exist."""
    seconds = {file: value for file, value in (durations(table) | measured(reports)).items() if (root / file).is_file()}
    write_csv(table, ["file", "seconds"], [[file, f"{seconds[file]:.1f}"] for file in sorted(seconds)])


def longest_files_first(items: list[pytest.Item], root: Path, seconds: Mapping[str, float]) -> None:
    """Sorts collected tests; those of a file stay together, in their order. A file without an entry counts as one of
    the median duration."""
    middle = median(seconds.values()) if seconds else 0.0

    def rank(item: pytest.Item) -> tuple[float, str]:
        file = item.path.relative_to(root).as_posix()
        return -seconds.get(file, middle), file

    items.sort(key=rank)


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


if __name__ == "__main__":
    update([Path(name) for name in sys.argv[1:]])
