"""The program of a worker process, `python -m evolvent.run.study.worker_process CONNECTION PARENT`.

CONNECTION is a descriptor that it inherits, PARENT the process that has started it: no other process can reach it.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import sys
from multiprocessing.connection import Connection

PARENT_DEATH_SIGNAL = 1
"""Number of the option PR_SET_PDEATHSIG of Linux' prctl."""


def end_with(parent: int) -> None:
    """Makes the system kill this process as soon as its parent has ended, even while a library computes."""
    ctypes.CDLL(None).prctl(PARENT_DEATH_SIGNAL, signal.SIGKILL)
    if os.getppid() != parent:  # it has ended before
        os._exit(1)


def serve(connection: Connection) -> None:
    """Reports that the worker process is ready, and answers orders until the connection is closed."""
    from evolvent.run.study.orders import Failure

    gears = None
    connection.send(None)
    with contextlib.suppress(EOFError):
        while True:
            order = connection.recv()
            try:
                gears, answer = order.carried_out(gears)
            except Exception as error:
                answer = Failure(f"{type(error).__name__}: {error}")
            connection.send(answer)


if __name__ == "__main__":
    descriptor, parent = map(int, sys.argv[1:])
    end_with(parent)
    os.set_inheritable(descriptor, False)  # Open MPI starts processes, which would keep the connection open
    serve(Connection(descriptor))
