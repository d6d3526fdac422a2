"""Evolvent's side of the comparison, a process of its own.

python -m evidence.benchmarks.comparison.evolvent_program TASK.npz ANSWER.npz
"""

from __future__ import annotations

import sys
import time
from math import nan
from pathlib import Path

import numpy as np

from evidence.benchmarks.comparison.task import Answer, Push, Task, Turn
from evolvent import Contact, ContactResult, Problem, Step, Sweep
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import Material
from evolvent_meshes.arrays import Floats

GEAR_REACH = 0.1  # mm, the gap up to which flanks may close


def problem_of(task: Task) -> Problem:
    """The task for the public API. The driven body carries the pressure: its cells are the larger ones."""
    if isinstance(task.drive, Push):
        freedom = Freedom("xyz"[task.dimension - 1], displacement=task.drive.displacement)
        reach = 4 * abs(task.drive.displacement)
    else:
        freedom, reach = Freedom("rz", displacement=task.drive.rotation), GEAR_REACH
    bodies = tuple(
        Body(
            mesh,
            Material(*task.materials[i]),
            _supports(task, i),
            rigid=Rigid(task.driven, (freedom,)) if i == 0 else None,
            name=f"body {i}",
        )
        for i, mesh in enumerate(task.bodies)
    )
    contact = Contact((0, task.contact[0]), (1, task.contact[1]), task.friction, reach)
    return Problem(bodies, (contact,))


def _torque(points: Floats, contact: ContactResult) -> float:
    """About z, of what the driven body presses on the other one with [N·mm]."""
    return float(contact.weights @ (points[:, 0] * contact.traction[:, 1] - points[:, 1] * contact.traction[:, 0]))


def _supports(task: Task, index: int) -> tuple[Fixed, ...]:
    """Of one body; the driven group is held by its coupling already."""
    held = [(group, axes) for body, group, axes in task.held if body == index]
    return tuple(Fixed(group, axes) for group, axes in held if (index, group) != (0, task.driven))


def solved(task: Task) -> Answer:
    """The answer, and what its parts took (CPU seconds)."""
    run, marks = Sweep(problem_of(task)), [time.process_time()]
    _ = run.condensed  # at its first use
    marks.append(time.process_time())
    solution = run.solve(Step())
    marks.append(time.process_time())
    contact = solution.contacts[0]
    points = np.pad(contact.points, ((0, 0), (0, 3 - contact.points.shape[1])))
    return Answer(
        body=0,
        torque=_torque(points, contact) if isinstance(task.drive, Turn) else nan,
        pressure=contact.pressure,
        points=points,
        weights=contact.weights,
        iterations=solution.iterations,
        dofs=task.dofs,
        seconds={"start": marks[0], "condense": marks[1] - marks[0], "solve": marks[2] - marks[1]},
    )


def main() -> None:
    dolfinx_compat.silence_logs()
    source, target = sys.argv[1:]
    solved(Task.read(Path(source))).write(Path(target))


if __name__ == "__main__":
    main()
