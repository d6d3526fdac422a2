"""The workers of a running Dask scheduler: gears that several scenes share are condensed once, scenes follow them."""

from __future__ import annotations

import asyncio
import contextlib
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import islice
from pathlib import Path

from distributed import Client, Future, KilledWorker, as_completed
from distributed.comm import connect
from distributed.security import Security

from evolvent.run.study.misalignment_line import solve_line
from evolvent.run.study.results.scene_record import SceneRecord
from evolvent.run.study.scene_task import SceneTask, condense, solve
from evolvent.run.study.task_groups import Line, failed, lines, sharing
from evolvent_meshes.errors import InputError

PATIENCE = 15.0
"""Time in which a scheduler has to answer, and to have a worker [s]."""
MOST_SHOWN = 200
"""Largest number of characters of an address or a reason in a message."""
MOST_WAITING = 1000
"""Largest number of tasks that are submitted to the scheduler at once: each carries its scenes."""
TOKEN = ".evolvent-study"
"""Name of the file by which it is tested that workers see the study's folder."""


@contextmanager
def scheduled_workers(address: str, out: Path) -> Iterator[ScheduledWorkers]:
    """Context with the workers of a running scheduler, which must see the study's folder under the same path. Where the
    address begins with tls:// certificates are those of Dask's own configuration.

    Raises InputError where the scheduler cannot be reached, has no workers, or has such as cannot compute scenes.
    """
    begin = time.monotonic()
    try:
        asyncio.run(_reached(address))  # a client that finds none would leave a traceback behind
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except Exception as error:  # each of Dask's protocols has its own, from a missing package to a refused certificate
        answer = "" if time.monotonic() - begin < PATIENCE else f"no answer within {PATIENCE:g} s: "
        raise InputError(
            f"--scheduler: found {address[:MOST_SHOWN]!r}, which cannot be reached "
            f"({answer}{str(error)[:MOST_SHOWN] or type(error).__name__}); allowed: the address of a running Dask "
            "scheduler, for tls:// with the certificates in Dask's configuration; remedy: start `python -m dask "
            "scheduler` and `python -m dask worker ADDRESS --nworkers 2 --nthreads 1`, and give the address that the "
            "scheduler prints, such as tcp://10.0.0.1:8786"
        ) from error
    with contextlib.closing(client):
        _check_workers(client, address, out)
        yield ScheduledWorkers(client)


class ScheduledWorkers:
    """Workers of a scheduler that a client is connected to."""

    def __init__(self, client: Client) -> None:
        self._client = client

    def finished(self, tasks: Mapping[SceneTask, str]) -> Iterator[SceneRecord]:
        """Records of the scenes as they are computed, in any order; see `SceneWorkers`."""
        submitted = self._submitted(sharing(tasks))
        handed: dict[str, Line] = {}
        waiting = as_completed(loop=self._client.loop)

        def more(count: int) -> None:
            for line, future in islice(submitted, count):
                handed[str(future.key)] = line
                waiting.add(future)

        more(MOST_WAITING)
        for done in waiting:
            yield from _records(handed.pop(str(done.key)), done)
            done.release()
            more(1)

    def _submitted(self, groups: Sequence[Line]) -> Iterator[tuple[Line, Future]]:
        """Scenes that are computed together with their future; the scheduler keeps gears until the last scene with them
        is computed."""
        for group in groups:
            if len(group) == 1:
                yield group, self._client.submit(solve, group[0], key=f"scene-{group[0].name}", pure=False)
                continue
            gears = self._client.submit(condense, group, pure=False)
            for line in lines(group):
                yield line, self._client.submit(solve_line, line, gears, key=f"scenes-{line[0].name}", pure=False)


def _records(line: Line, done: Future) -> list[SceneRecord]:
    """Records that a worker returned; failures where its process ended unexpectedly, or with an error of the program.
    """
    error = done.exception()
    if error is None:
        found = done.result()
        return found if isinstance(found, list) else [found]
    if isinstance(error, KilledWorker):
        return failed(line, "the worker process died each time that it computed this scene: too little memory?")
    return failed(line, f"{type(error).__name__}: {error}")


async def _reached(address: str) -> None:
    """Raises what Dask does where no scheduler answers at the address."""
    comm = await connect(address, timeout=PATIENCE, **Security().get_connection_args("client"))
    await comm.close()


def _check_workers(client: Client, address: str, out: Path) -> None:
    """Raises InputError where the workers cannot compute scenes."""
    with contextlib.suppress(TimeoutError):
        client.wait_for_workers(1, timeout=PATIENCE)
    threads = client.nthreads()
    start = f"python -m dask worker {address} --nworkers 2 --nthreads 1"
    if not threads:
        raise InputError(
            f"--scheduler: found a scheduler at {address} without workers; allowed: one with workers; remedy: start "
            f"some with `{start}`, where Evolvent is installed"
        )
    if many := {worker: count for worker, count in threads.items() if count != 1}:
        worker, count = next(iter(many.items()))
        raise InputError(
            f"--scheduler: found the worker {worker} with {count} threads; allowed: one thread a worker, as a process "
            f"computes one scene at a time; remedy: start workers with `{start}`"
        )
    with _token(out) as content:
        seen = client.run(_seen, str(out / TOKEN), on_error="return")
    for worker, found in seen.items():
        if isinstance(found, BaseException):
            raise InputError(
                f"--scheduler: found the worker {worker}, on which Evolvent cannot be used ({found}); allowed: workers "
                "with this version of Evolvent; remedy: start them in the same environment as this command"
            )
        if found != content:
            raise InputError(
                f"--out: found {out}, which the worker {worker} does not see; allowed: a folder that all workers share "
                "under the same path; remedy: name one on a shared file system"
            )


@contextmanager
def _token(out: Path) -> Iterator[str]:
    """Context with a file in the folder, and its content."""
    path, content = out / TOKEN, f"{os.getpid()} {os.urandom(8).hex()}"
    path.write_text(content)
    try:
        yield content
    finally:
        path.unlink(missing_ok=True)


def _seen(path: str) -> str:
    """Content of a file as a worker sees it, empty where it does not. Raises ImportError without Evolvent."""
    import evolvent.run.study.scene_task  # noqa: F401  fails here where it would fail later

    try:
        return Path(path).read_text()
    except OSError:
        return ""
