"""Scenes handed to worker processes: gears that several share are condensed once, scenes follow them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from distributed import Client, Future, KilledWorker, as_completed

from evolvent.run.study.results.scene_record import SceneRecord
from evolvent.run.study.scene_task import FAILED, SceneTask, condense, solve

MOST_WAITING = 1000
"""Largest number of scenes that are with the scheduler at once: each carries its scene."""


def finished(client: Client, tasks: Mapping[SceneTask, str]) -> Iterator[SceneRecord]:
    """Records of the scenes as they are computed, in any order. tasks: with the name of the gears that several share;
    empty: a scene has its own."""
    submitted = _submitted(client, _together(tasks))
    names: dict[str, SceneTask] = {}
    waiting = as_completed(loop=client.loop)
    for task, future in islice(submitted, MOST_WAITING):
        names[future.key] = task
        waiting.add(future)
    for done in waiting:
        task = names.pop(done.key)
        yield _record(task, done)
        done.release()
        for following, future in islice(submitted, 1):
            names[future.key] = following
            waiting.add(future)


def _together(tasks: Mapping[SceneTask, str]) -> list[tuple[SceneTask, ...]]:
    """The tasks, those that share gears together."""
    groups: dict[str, list[SceneTask]] = {}
    for task, gears in tasks.items():
        groups.setdefault(gears or task.name, []).append(task)
    return [tuple(group) for group in groups.values()]


def _submitted(client: Client, groups: Sequence[Sequence[SceneTask]]) -> Iterator[tuple[SceneTask, Future]]:
    """Each scene with its future; the scheduler keeps gears until the last scene with them is computed."""
    for group in groups:
        gears = client.submit(condense, group, pure=False) if len(group) > 1 else None
        for task in group:
            yield task, client.submit(solve, task, gears, key=f"scene-{task.name}", pure=False)


def _record(task: SceneTask, done: Future) -> SceneRecord:
    """What a worker has returned; a failure where it died of the scene, or ended with an error of the program."""
    error = done.exception()
    if error is None:
        return done.result()
    if isinstance(error, KilledWorker):
        reason = "the worker process died each time that it computed this scene: too little memory?"
    else:
        reason = f"{type(error).__name__}: {error}"
    return SceneRecord(task.name, task.compute, FAILED, reason, (), float("nan"))
