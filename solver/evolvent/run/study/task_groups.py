"""Groups of scenes of a study that are computed together: on the same condensed gears, or as one task of one worker."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Protocol

from evolvent.run.study.misalignment_line import line_name
from evolvent.run.study.results.scene_record import SceneRecord, read_record
from evolvent.run.study.scene_task import FAILED, SceneTask

DEATHS = 3
"""Largest number of times that a worker process may end unexpectedly at one order before its scenes are given up."""
Line = tuple[SceneTask, ...]
"""Scenes that one task computes."""


class SceneWorkers(Protocol):
    """Processes that compute scenes."""

    def finished(self, tasks: Mapping[SceneTask, str]) -> Iterator[SceneRecord]:
        """Records of the scenes as they are computed, in any order. tasks: with the name of the gears that several
        share; empty: a scene has its own."""


def sharing(tasks: Mapping[SceneTask, str]) -> list[Line]:
    """Groups of tasks that share gears; a task with gears of its own is a group by itself."""
    return _grouped(tasks, lambda task: tasks[task] or task.name)


def lines(group: Iterable[SceneTask]) -> list[Line]:
    """Tasks that share gears, in lines of those that are solved together."""
    return _grouped(group, line_name)


def _grouped(tasks: Iterable[SceneTask], name: Callable[[SceneTask], str]) -> list[Line]:
    """Groups of tasks with the same name, in their order."""
    groups: dict[str, list[SceneTask]] = {}
    for task in tasks:
        groups.setdefault(name(task), []).append(task)
    return [tuple(group) for group in groups.values()]


def failed(line: Line, reason: str) -> list[SceneRecord]:
    """Records of scenes whose computation ended without any; scenes that were done before keep theirs."""
    return [
        read_record(task.folder) or SceneRecord(task.name, task.compute, FAILED, reason, (), float("nan"))
        for task in line
    ]
