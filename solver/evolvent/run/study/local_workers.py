"""Worker processes on this machine: started here, each reached by a pair of connected sockets without an address."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from multiprocessing import Pipe
from multiprocessing.connection import wait

from evolvent.run.study.orders import Answer, Condense, Failure, Keep, Order, Solve
from evolvent.run.study.results.scene_record import SceneRecord
from evolvent.run.study.scene_task import SceneTask
from evolvent.run.study.task_groups import DEATHS, Line, failed, lines, sharing
from evolvent_meshes.errors import EvolventError

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
STARTS = 10
"""Largest number of worker processes in a row that may end while they start."""
GRACE = 5.0
"""Time [s] that an idle worker process has to end by itself."""


class WorkersDie(EvolventError):
    """Worker processes ended before they could compute anything."""


class LocalWorkers:
    """Worker processes, each of which computes one scene at a time on one core, and is replaced where it ends
    unexpectedly. None outlives this process. count: largest number of processes; there are no more than tasks."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._workers: list[_Worker] = []
        self._groups: deque[_Group] = deque()
        self._failed_starts = 0

    def finished(self, tasks: Mapping[SceneTask, str]) -> Iterator[SceneRecord]:
        """Records of the scenes as they are computed, in any order; see `SceneWorkers`. Raises WorkersDie, OSError."""
        self._groups.extend(_Group(each, self._count > 1) for each in sharing(tasks))
        count = min(self._count, sum(len(each.solving) for each in self._groups))
        for _ in range(count):
            self._workers.append(_Worker())
        while self._is_unfinished():
            for worker in self._workers:
                if worker.is_ready and worker.order is None:
                    self._occupy(worker)
            heard = wait([each.connection for each in self._workers])
            for worker in [each for each in self._workers if each.connection in heard]:
                yield from self._hear(worker)

    def close(self) -> None:
        """Ends the processes; a scene that one computes stays unfinished."""
        for worker in self._workers:
            worker.close()
        for worker in self._workers:
            worker.ended()

    def _is_unfinished(self) -> bool:
        """Whether a scene is to be handed out, or is being computed by a worker. Removes groups without such scenes."""
        while self._groups and not self._groups[0].solving:
            self._groups.popleft()
        return bool(self._groups) or any(each.order is not None for each in self._workers)

    def _occupy(self, worker: _Worker) -> None:
        """Gives a worker its next order, first on the gears that it holds."""
        for group in ([worker.keeps] if worker.keeps is not None else []) + list(self._groups):
            if (order := group.next_for(worker.keeps is group)) is not None:
                worker.give(order, group)
                return

    def _hear(self, worker: _Worker) -> list[SceneRecord]:
        """Records that a worker sends, or those of scenes given up as it ended unexpectedly. Raises WorkersDie."""
        try:
            answer = worker.connection.recv()
        except (EOFError, OSError):
            return self._replaced(worker)
        order, group, worker.order = worker.order, worker.group, None
        if order is None or group is None:
            worker.is_ready, self._failed_starts = True, 0
            return []
        if isinstance(answer, Failure):
            return group.given_up(order, answer.reason)
        if isinstance(order, Solve):
            return list(answer)
        worker.keeps = group
        group.condensed(answer)
        return []

    def _replaced(self, worker: _Worker) -> list[SceneRecord]:
        """Replaces a worker process that has ended unexpectedly. Its order is tried again up to three times."""
        worker.close()
        how = worker.ended()
        self._workers.remove(worker)
        self._failed_starts += not worker.is_ready
        if self._failed_starts > STARTS:
            raise WorkersDie(
                f"found that {self._failed_starts} worker processes one after the other ended while they started, the "
                f"last one {how}; wanted processes that can compute scenes: is there too little memory? then take "
                "fewer --workers"
            )
        self._workers.append(_Worker())
        if worker.order is None or worker.group is None:
            return []
        if worker.order.deaths < DEATHS:
            worker.group.again(replace(worker.order, deaths=worker.order.deaths + 1))
            if worker.group not in self._groups:  # it had left the queue, with all of its scenes handed out
                self._groups.appendleft(worker.group)
            return []
        reason = f"the worker process died each time that it computed this scene, at last {how}: too little memory?"
        return worker.group.given_up(worker.order, reason)


class _Worker:
    """A worker process and its present order."""

    def __init__(self) -> None:
        self.connection, theirs = Pipe()
        path = os.pathsep.join(filter(None, sys.path))
        module = [sys.executable, "-P", "-m", "evolvent.run.study.worker_process"]
        with theirs:
            self._process = subprocess.Popen(
                [*module, str(theirs.fileno()), str(os.getpid())],
                env={**os.environ, **ONE_THREAD, "PYTHONPATH": path}, stdin=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()], process_group=0,  # Control-C is for this process
            )
        self.is_ready = False
        """Whether the process has started."""
        self.order: Order | None = None
        """Order that the process is carrying out."""
        self.group: _Group | None = None
        """Scenes that the order belongs to."""
        self.keeps: _Group | None = None
        """Scenes whose condensed gears the process holds."""

    def give(self, order: Order, group: _Group) -> None:
        """Sends an order. That the process has ended shows when its connection is read next."""
        self.order, self.group = order, group
        if not isinstance(order, Solve) or not order.on_kept_gears:
            self.keeps = None
        with suppress(OSError):
            self.connection.send(order)

    def close(self) -> None:
        """Ends the process: at once where it computes, else by itself."""
        self.connection.close()
        if self.order is not None or not self.is_ready:
            self._process.kill()

    def ended(self) -> str:
        """Waits for the end of the process; returns how it ended, in words."""
        try:
            status = self._process.wait(GRACE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            status = self._process.wait()
        return f"by {signal.Signals(-status).name}" if status < 0 else f"with exit status {status}"


class _Group:
    """Scenes that share gears, or a single one, without those that were handed out."""

    def __init__(self, tasks: Line, several_workers: bool) -> None:
        self._shares = len(tasks) > 1
        self.solving = deque(Solve(line, self._shares) for line in lines(tasks))
        """Orders that are still to be handed out."""
        self._condense = Condense(tasks, several_workers and len(self.solving) > 1)
        self._keep: Keep | None = None
        """Order for other workers to hold the condensed gears."""
        self._is_condensing = False

    def next_for(self, keeps_gears: bool) -> Order | None:
        """The next order for a worker; None where there is none, or another worker condenses the gears. keeps_gears:
        whether the worker has them."""
        if not self.solving or (self._shares and not keeps_gears and self._keep is None and self._is_condensing):
            return None
        if not self._shares or keeps_gears:
            order = self.solving.popleft()
            self._keep = self._keep if self.solving else None  # as large as both gears' matrices
            return order
        if self._keep is not None:
            return self._keep
        self._is_condensing = True
        return self._condense

    def condensed(self, gears: Answer) -> None:
        """Takes over gears that a worker has condensed; None where it was sent them."""
        if isinstance(gears, bytes):
            self._is_condensing = False
            self._keep = Keep(gears) if gears else None

    def again(self, order: Order) -> None:
        """Puts back an order at which a worker process ended unexpectedly."""
        if isinstance(order, Solve):
            self.solving.appendleft(order)
        elif isinstance(order, Condense):
            self._condense, self._is_condensing = order, False
        else:
            self._keep = order

    def given_up(self, order: Order, reason: str) -> list[SceneRecord]:
        """Records of scenes that cannot be computed: those of the order, or all that wait for the gears."""
        if isinstance(order, Solve):
            return failed(order.line, reason)
        waiting, self._is_condensing = list(self.solving), False
        self.solving.clear()
        return [record for each in waiting for record in failed(each.line, reason)]
