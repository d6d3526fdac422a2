"""Worker processes of a study: Dask's, on this machine or those of a running scheduler."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import dask
from distributed import Client, LocalCluster
from distributed.comm import connect

from evolvent_meshes.errors import InputError

PATIENCE = 15.0
"""Time in which a scheduler has to answer, and to have a worker [s]."""
DEATHS = 3
"""Largest number of deaths of a worker process at one scene: then the scene is given up."""
TOKEN = ".evolvent-study"
"""File that workers must see in the study's folder."""


@contextmanager
def local_workers(count: int) -> Iterator[Client]:
    """Context with worker processes on this machine. Each computes one scene at a time, on one core, and is replaced
    where it dies; all end with this process.

    Processes are spawned, not forked: each initialises MPI for itself.
    """
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    settings = {
        "distributed.scheduler.allowed-failures": DEATHS,
        "distributed.worker.multiprocessing-method": "spawn",
        "distributed.nanny.pre-spawn-environ": {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
    }
    with ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="evolvent-study-"))
        stack.enter_context(dask.config.set(settings))
        cluster = LocalCluster(
            n_workers=count, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0", memory_limit=0,
            local_directory=folder, silence_logs=logging.CRITICAL, host="127.0.0.1",
        )  # fmt: skip
        stack.enter_context(contextlib.closing(cluster))
        yield stack.enter_context(contextlib.closing(Client(cluster, set_as_default=False)))


@contextmanager
def scheduled_workers(address: str, out: Path) -> Iterator[Client]:
    """Context with the workers of a running scheduler, which must see the study's folder under the same path.

    Raises InputError where the scheduler does not answer, has no workers, or has such as cannot compute scenes.
    """
    try:
        asyncio.run(_reached(address))  # a client that finds none would leave a traceback behind
    except (OSError, TimeoutError, ValueError) as error:
        raise InputError(
            f"--scheduler: found {address!r}, which does not answer within {PATIENCE:g} s "
            f"({str(error) or type(error).__name__}); allowed: the address of a running Dask scheduler; remedy: start "
            "`dask scheduler` and `dask worker ADDRESS --nworkers 2 --nthreads 1`, and give the address that the "
            "scheduler prints, such as tcp://10.0.0.1:8786"
        ) from error
    with contextlib.closing(Client(address, timeout=PATIENCE, set_as_default=False)) as client:
        _check_workers(client, address, out)
        yield client


async def _reached(address: str) -> None:
    """Raises OSError, TimeoutError or ValueError where no Dask scheduler answers at the address."""
    comm = await connect(address, timeout=PATIENCE)
    await comm.close()


def _check_workers(client: Client, address: str, out: Path) -> None:
    """Raises InputError where scenes cannot be computed."""
    with contextlib.suppress(TimeoutError):
        client.wait_for_workers(1, timeout=PATIENCE)
    threads = client.nthreads()
    start = f"dask worker {address} --nworkers 2 --nthreads 1"
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
