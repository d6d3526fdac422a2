"""Tasks and answers survive their files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from evidence.benchmarks.comparison.round_contacts import sphere
from evidence.benchmarks.comparison.task import Answer, Task


def test_a_task_and_an_answer_survive_their_files(tmp_path: Path) -> None:
    """What is read is what was written: meshes, groups, supports."""
    task = sphere(2, 1, "tetrahedron")
    task.write(tmp_path / "task.npz")
    again = Task.read(tmp_path / "task.npz")
    assert (again.held, again.drive, again.contact) == (task.held, task.drive, task.contact)
    for one, other in zip(task.bodies, again.bodies):
        assert np.array_equal(one.cells, other.cells) and np.array_equal(one.points, other.points)
        assert one.facets.keys() == other.facets.keys()
    answer = Answer(1, np.arange(3.0), np.arange(3), iterations=4, seconds={"solve": 2.0})
    answer.write(tmp_path / "answer.npz")
    read = Answer.read(tmp_path / "answer.npz")
    assert (read.body, read.iterations, read.seconds, read.points) == (1, 4, {"solve": 2.0}, None)
