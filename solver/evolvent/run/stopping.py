"""SIGINT, SIGTERM and SIGHUP end a command cleanly: said once, in the log too, and soon, whatever is being computed."""

from __future__ import annotations

import logging
import os
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
PATIENCE = 3.0
"""Seconds until a process that is deep in a factorisation is ended where it stands: what it keeps, it keeps whole.
Those who ask wait longer (docker stop: 10 s) or hardly (mpirun: 1 s)."""


GLANCE = 0.3  # seconds that the main thread, where it computes in Python, needs to say so in the log


class Stopped(KeyboardInterrupt):
    """The process was asked to end; the message names the signal."""


@contextmanager
def stoppable(advice: str, end: Callable[[], None]) -> Iterator[None]:
    """Raises Stopped in the main thread when a signal asks the process to end.

    advice: what is said beside the signal's name. end: ends the process where Stopped does not reach the main thread
    within PATIENCE. Does nothing in other threads than the main one.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    reader, writer = socket.socketpair()
    writer.setblocking(False)
    done = threading.Event()
    watcher = threading.Thread(target=_watch, args=(reader, done, advice, end), daemon=True)
    before = {number: signal.signal(number, partial(_raise, advice)) for number in SIGNALS}
    wakeup = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
    watcher.start()
    try:
        yield
    finally:
        done.set()
        signal.set_wakeup_fd(wakeup)
        for number, handler in before.items():
            signal.signal(number, handler)
        writer.close()
        watcher.join()
        reader.close()


def _raise(advice: str, number: int, frame: FrameType | None) -> None:
    for own in SIGNALS:
        signal.signal(own, signal.SIG_IGN)  # a second one must not cut short what the first one has begun
    raise Stopped(f"stopped by {signal.Signals(number).name}{advice}")


def _watch(reader: socket.socket, done: threading.Event, advice: str, end: Callable[[], None]) -> None:
    """Says at once that the process will end, and ends it if it has not ended by itself. The operating system writes
    the signal's number, also while the main thread computes outside Python."""
    while number := reader.recv(1):
        if number[0] in SIGNALS:
            message = f"stopped by {signal.Signals(number[0]).name}{advice}"
            print(f"evolvent: {message}", file=sys.stderr, flush=True)
            if not done.wait(GLANCE) and (log := logging.getLogger("evolvent")).hasHandlers():
                log.error("%s", message)  # in place of the main thread
            if not done.wait(PATIENCE):
                end()
                os._exit(1)
            return
