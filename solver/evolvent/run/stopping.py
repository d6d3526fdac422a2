"""SIGINT, SIGTERM and SIGHUP end a command in order: one message, also in the log, and soon, whatever it computes."""

from __future__ import annotations

import logging
import os
import signal
import socket
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from types import FrameType

from evolvent.run.run_log import LOGGER

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
PATIENCE = 3.0
"""Time until a process that does not return to Python is ended where it is [s]; files are written whole or not at all.
`docker stop` waits 10 s before it kills, `mpirun` 1 s."""
GLANCE = 0.3
"""Time that the main thread needs to log the signal itself where it computes in Python [s]."""


class Stopped(KeyboardInterrupt):
    """Request to end the process by a signal, which the message names."""


@contextmanager
def stoppable(advice: str, end: Callable[[], None]) -> Iterator[None]:
    """Raises Stopped in the main thread when a signal asks the process to end.

    advice: appended to the signal's name in the message. end: called before the process is ended where Stopped does not
    reach the main thread within `PATIENCE`. In other threads than the main one the context does nothing.
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
    except Stopped as stop:
        _release(stop)
        raise
    finally:
        done.set()
        signal.set_wakeup_fd(wakeup)
        for number, handler in before.items():
            signal.signal(number, handler)
        writer.close()
        watcher.join()
        reader.close()


def _release(stop: Stopped) -> None:
    """Releases what the signal left half built, without the complaints of its destructors.

    A constructor that a signal interrupts leaves an object without some of its attributes; Python prints a traceback
    where its destructor misses one, as that of `zipfile.ZipFile` does.
    """
    hook = sys.unraisablehook
    sys.unraisablehook = lambda _: None
    try:
        traceback.clear_frames(stop.__traceback__)
    finally:
        sys.unraisablehook = hook


def _message(number: int, advice: str) -> str:
    return f"stopped by {signal.Signals(number).name}{advice}"


def _raise(advice: str, number: int, frame: FrameType | None) -> None:
    """Handler of `SIGNALS` that raises Stopped."""
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)  # a second signal must not interrupt the cleaning up after the first
    raise Stopped(_message(number, advice))


def _watch(reader: socket.socket, done: threading.Event, advice: str, end: Callable[[], None]) -> None:
    """Prints the message at once, and ends the process if it does not end by itself.

    Runs in a thread of its own. The operating system writes the signal's number to the socket, also while the main
    thread computes outside Python.
    """
    while number := reader.recv(1):
        if number[0] in SIGNALS:
            message = _message(number[0], advice)
            with suppress(OSError):  # nobody reads it
                print(f"evolvent: {message}", file=sys.stderr, flush=True)
            if not done.wait(GLANCE) and (log := logging.getLogger(LOGGER)).hasHandlers():
                log.error("%s", message)  # in place of the main thread
            if not done.wait(PATIENCE):
                end()
                os._exit(1)
            return
