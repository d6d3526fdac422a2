"""Scenes handed to worker processes: gears that several share are condensed once, scenes follow them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice

from distributed import Client, Future, KilledWorker, as_completed

from evolvent.run.study.misalignment_line import line_name, solve_line
from evolvent.run.study.results.scene_record import SceneRecord
from evolvent.run.study.scene_task import FAILED, SceneTask, condense, solve

MOST_WAITING = 1000
"""Largest number of tasks that are with the scheduler at once: each carries its scenes."""
Line = tuple[SceneTask, ...]
"""Scenes that one task computes."""


def finished(client: Client, tasks: Mapping[SceneTask, str]) -> Iterator[SceneRecord]:
    """Records of the scenes as they are computed, in any order. tasks: with the name of the gears that several share;
    empty: a scene has its own."""
    submitted = _submitted(client, _together(tasks))
    lines: dict[str, Line] = {}
    waiting = as_completed(loop=client.loop)

    def more(count: int) -> None:
        for line, future in islice(submitted, count):
            lines[future.key] = line
            waiting.add(future)

    more(MOST_WAITING)
    for done in waiting:
        yield from _records(lines.pop(done.key), done)
        done.release()
        more(1)


def _together(tasks: Mapping[SceneTask, str]) -> list[Line]:
    """The tasks, those that share gears together."""
    return _grouped(tasks, lambda task: tasks[task] or task.name)


def _grouped(tasks: Iterable[SceneTask], name: Callable[[SceneTask], str]) -> list[Line]:
    """Those of one name together, in their order."""
    groups: dict[str, list[SceneTask]] = {}
    for task in tasks:
        groups.setdefault(name(task), []).append(task)
    return [tuple(group) for group in groups.values()]


def _submitted(client: Client, groups: Sequence[Line]) -> Iterator[tuple[Line, Future]]:
    """Scenes that are computed together with their future; the scheduler keeps gears until the last scene with them is
    computed."""
    for group in groups:
        if len(group) == 1:
            yield group, client.submit(solve, group[0], key=f"scene-{group[0].name}", pure=False)
            continue
        gears = client.submit(condense, group, pure=False)
        for line in _grouped(group, line_name):
            yield line, client.submit(solve_line, line, gears, key=f"scenes-{line[0].name}", pure=False)


def _records(line: Line, done: Future) -> list[SceneRecord]:
    """What a worker has returned; failures where it died of the scenes, or ended with an error of the program."""
    error = done.exception()
    if error is None:
        found = done.result()
        return found if isinstance(found, list) else [found]
    if isinstance(error, KilledWorker):
        reason = "the worker process died each time that it computed this scene: too little memory?"
    else:
        reason = f"{type(error).__name__}: {error}"
    return [SceneRecord(task.name, task.compute, FAILED, reason, (), float("nan")) for task in line]
