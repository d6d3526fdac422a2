"""Worker processes of a study on this machine, with checks of Zhang's pair, which take no time."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

import pytest

from evidence.robustness.study_programs import runs, until, workers_of
from evolvent.run.study import local_workers
from evolvent.run.study.local_workers import LocalWorkers, WorkersDie, _Group, _Worker
from evolvent.run.study.orders import Condense, Keep, Order, Solve
from evolvent.run.study.results.scene_record import scene_folder
from evolvent.run.study.scene_task import SceneTask
from tests.support.running.study_cases import TORQUES, scenes_of


@pytest.fixture
def tasks(tmp_path: Path) -> list[SceneTask]:
    """Three checks."""
    scenes = scenes_of(tmp_path, TORQUES)
    return [SceneTask(each.name, scene_folder(tmp_path, each.name), "check", each.scene) for each in scenes
            if each.scene is not None]


@pytest.fixture
def workers() -> Iterator[LocalWorkers]:
    """At most two, which are ended after the test."""
    with closing(LocalWorkers(2)) as made:
        yield made


def own(tasks: list[SceneTask]) -> dict[SceneTask, str]:
    """Tasks with gears of their own."""
    return dict.fromkeys(tasks, "")


def test_a_worker_that_dies_while_it_starts(
    workers: LocalWorkers, tasks: list[SceneTask], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first process is killed as soon as it is there: another one takes its place, and all scenes are done."""
    started: list[_Worker] = []

    class Killed(_Worker):
        def __init__(self) -> None:
            super().__init__()
            started.append(self)
            if len(started) == 1:
                self._process.kill()

    monkeypatch.setattr(local_workers, "_Worker", Killed)
    found = list(workers.finished(own(tasks)))
    assert {record.name for record in found} == {task.name for task in tasks}
    assert {record.status for record in found} == {"done"} and len(started) == 3


def test_a_worker_that_dies_at_the_last_scene(tasks: list[SceneTask], monkeypatch: pytest.MonkeyPatch) -> None:
    """Killed once no other scene is to be handed out: the scene is computed by the process that takes its place. Once,
    it was lost, and the study ended as if it were whole."""
    given: list[Order] = []
    heard_nothing: list[bool] = []

    class Killed(_Worker):
        def give(self, order: Order, group: _Group) -> None:
            given.append(order)
            if len(given) == len(tasks):
                self._process.kill()
                self._process.wait()
            super().give(order, group)

    def late(connections: list[Any]) -> list[Any]:
        """What is heard; of the death once the queue has been looked at again, as after an answer of another one."""
        if len(given) == len(tasks) and not heard_nothing:
            heard_nothing.append(True)
            return []
        return wait(connections)

    monkeypatch.setattr(local_workers, "_Worker", Killed)
    monkeypatch.setattr(local_workers, "wait", late)
    with closing(LocalWorkers(1)) as workers:
        found = list(workers.finished(own(tasks)))
    assert {record.name for record in found} == {task.name for task in tasks}
    assert {record.status for record in found} == {"done"} and len(given) == len(tasks) + 1


def test_workers_that_cannot_start(
    workers: LocalWorkers, tasks: list[SceneTask], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each process ends at once: an error that says how, not a study without an end."""
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(WorkersDie, match="ended while they started, the last one with exit status 1"):
        list(workers.finished(own(tasks)))


@pytest.mark.slow
def test_a_scene_that_kills_its_workers(
    workers: LocalWorkers, tasks: list[SceneTask], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each worker that is given the first scene is killed: at the fourth death that scene has failed with the signal's
    name; the others are done."""

    class Killed(_Worker):
        def give(self, order: Order, group: _Group) -> None:
            if isinstance(order, Solve) and order.line[0] is tasks[0]:
                self._process.kill()
                self._process.wait()
            super().give(order, group)

    monkeypatch.setattr(local_workers, "_Worker", Killed)
    found = {record.name: record for record in workers.finished(own(tasks))}
    assert [found[task.name].status for task in tasks] == ["failed", "done", "done"]
    assert found[tasks[0].name].reason.startswith("the worker process died each time that it computed this scene, at "
                                                  "last by SIGKILL")


def test_no_more_workers_than_scenes(tasks: list[SceneTask], monkeypatch: pytest.MonkeyPatch) -> None:
    """Three workers for one scene: one process."""
    started: list[_Worker] = []

    class Counted(_Worker):
        def __init__(self) -> None:
            super().__init__()
            started.append(self)

    monkeypatch.setattr(local_workers, "_Worker", Counted)
    with closing(LocalWorkers(3)) as many:
        assert len(list(many.finished(own(tasks[:1])))) == 1
    assert len(started) == 1


def test_shared_gears_are_condensed_once(tasks: list[SceneTask]) -> None:
    """Orders of scenes that share gears: the first worker condenses, the second waits, is sent the gears and solves;
    where a worker dies, its order comes again."""
    group = _Group(tuple(tasks), several_workers=True)
    condense = group.next_for(False)
    assert isinstance(condense, Condense) and condense.are_sent and group.next_for(False) is None
    group.again(condense)
    assert group.next_for(False) is condense
    group.condensed(b"gears")
    one, two = group.next_for(True), group.next_for(False)
    assert isinstance(one, Solve) and one.line == (tasks[0],) and two == Keep(b"gears")
    group.condensed(None)
    group.again(one)
    assert group.next_for(True) is one
    assert [group.next_for(True) for _ in range(3)][2] is None
    assert group.next_for(False) is None


def test_gears_that_cannot_be_condensed(tasks: list[SceneTask]) -> None:
    """All scenes that wait for them have failed with the reason, and nothing is left to do."""
    group = _Group(tuple(tasks), several_workers=True)
    condense = group.next_for(False)
    assert condense is not None
    found = group.given_up(condense, "no memory")
    assert [(record.name, record.reason) for record in found] == [(task.name, "no memory") for task in tasks]
    assert group.next_for(False) is None and group.next_for(True) is None


HOLDING = """
import sys, ctypes, os
from evolvent.run.study.worker_process import end_with
parent = os.getpid()
child = os.fork()
if child == 0:
    end_with(parent)
    ctypes.PyDLL(None).sleep(600)  # a library that does not return to Python
print(child, flush=True)
sys.stdin.read()
"""


def test_a_worker_ends_with_its_parent() -> None:
    """The parent is killed while the worker computes in a library: the worker ends, too."""
    with subprocess.Popen(
        [sys.executable, "-c", HOLDING], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as parent:
        assert parent.stdout is not None
        worker = int(parent.stdout.readline())
        assert runs(worker)
        parent.kill()
    until(lambda: not runs(worker), say="the end of the worker", patience=10.0)


def sockets_that_listen() -> set[str]:
    """Inodes of all TCP and UNIX sockets of this machine that processes can connect to."""
    found = set()
    for name in ("tcp", "tcp6"):
        rows = Path(f"/proc/net/{name}").read_text().splitlines()[1:]
        found |= {row.split()[9] for row in rows if row.split()[3] == "0A"}
    rows = Path("/proc/net/unix").read_text().splitlines()[1:]
    return found | {row.split()[6] for row in rows if int(row.split()[3], 16) & 0x10000}


def sockets_of(process: int) -> set[str]:
    """Inodes of the sockets of a process."""
    links = [os.readlink(path) for path in Path(f"/proc/{process}/fd").iterdir() if path.is_symlink()]
    return {link.removeprefix("socket:[").removesuffix("]") for link in links if link.startswith("socket:")}


def test_nobody_can_connect_to_a_worker(
    workers: LocalWorkers, tasks: list[SceneTask], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A worker beside a scene that it has computed, without what Open MPI opens: it has a socket, to its parent, and
    none that listens; so has this process."""
    monkeypatch.setenv("OMPI_MCA_btl", "self")
    monkeypatch.setenv("OMPI_MCA_ess_singleton_isolated", "1")
    before = sockets_of(os.getpid())
    records = workers.finished(own(tasks))
    next(records)
    processes = workers_of(os.getpid())
    assert processes
    mine = sockets_of(os.getpid()) - before
    for sockets in (mine, *map(sockets_of, processes)):
        assert sockets and not sockets & sockets_that_listen()


def test_an_interrupted_study_leaves_no_worker(tasks: list[SceneTask]) -> None:
    """What raises in the middle ends them."""

    def interrupted() -> None:
        with closing(LocalWorkers(2)) as made:
            next(made.finished(own(tasks)))
            assert workers_of(os.getpid())
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert not any(map(runs, workers_of(os.getpid())))
