"""How a command ends: one message on stderr and an exit status, on any number of ranks.

0 done, 2 bad input, 3 not converged or out of balance, 1 anything else; an EvolventError carries its own status. Only
rank 0 prints, but a rank that fails alone prints its own message and ends all ranks.
"""

from __future__ import annotations

import contextlib
import io
import os
import select
import signal
import sys
import time
import traceback
from collections.abc import Iterator
from enum import IntEnum

import typer

from evolvent.fem.parallel.mpi_start import is_first, launched, world
from evolvent.run.stopping import stoppable
from evolvent.scene.schema.errors import SceneError
from evolvent_meshes.errors import EvolventError


class Exit(IntEnum):
    """Exit statuses."""

    DONE = 0
    FAILED = 1
    BAD_INPUT = 2
    NOT_CONVERGED = 3
    PIPE_CLOSED = 128 + signal.SIGPIPE
    """Nobody reads what is printed, as after `| head`: that of a program that the signal ends."""


STATUSES = "Exit status: 0 done, 2 bad input, 3 not converged or out of balance, 1 anything else."
"""The last line of a help."""


@contextlib.contextmanager
def reported(parallel: bool = False, advice: str = "") -> Iterator[None]:
    """Context that turns exceptions and signals into one message on stderr and an exit status.

    parallel: all ranks take part; then a failure ends the others too. advice: appended to the name of a signal.
    Raises typer.Exit.
    """
    try:
        with stoppable(advice, _end_all if parallel else lambda: None):
            yield
    except (typer.Exit, typer.Abort, typer.BadParameter):
        raise
    except SceneError as error:  # raised on all ranks: they end by themselves
        raise leave(str(error), Exit.BAD_INPUT, problems=True) from error
    except KeyboardInterrupt as error:  # `stoppable` has printed the message
        if parallel:
            _end_all()
        raise typer.Exit(int(Exit.FAILED)) from error
    except Exception as error:
        if isinstance(error, BrokenPipeError) and output_is_closed():
            if parallel:
                _end_all()
            raise typer.Exit(int(Exit.PIPE_CLOSED)) from error
        status = Exit(error.exit_status) if isinstance(error, EvolventError) else Exit.FAILED
        expected = isinstance(error, (EvolventError, OSError, MemoryError))
        message = str(error) if expected else f"{_traceback(error)}\n{type(error).__name__}: {error}"
        _abort_others(parallel, message, status)
        raise leave(message, status) from error


def _traceback(error: Exception) -> str:
    """The traceback, followed by that of the rank on which the error arose, which the error carries as a note."""
    return "\n".join(["".join(traceback.format_tb(error.__traceback__)).rstrip(), *getattr(error, "__notes__", ())])


def leave(message: str, status: Exit, problems: bool = False) -> typer.Exit:
    """Prints the message on stderr; returns what to raise for the exit status. problems: each line is one by itself."""
    message = message.encode(errors="backslashreplace").decode()  # names of files may hold bytes that are not UTF-8
    named = problems or "\n" not in message
    typer.echo("\n".join(f"evolvent: {line}" for line in message.split("\n")) if named else message, err=True)
    return typer.Exit(int(status))


def _end_all() -> None:
    """Ends all ranks, if there are several."""
    if launched() and world().size > 1:
        world().Abort(int(Exit.FAILED))


def _abort_others(parallel: bool, message: str, status: Exit) -> None:
    """Prints the message and ends all ranks: one that waits in a collective call would wait for ever."""
    if not parallel or not launched() or world().size == 1:
        return
    if world().rank > 0:
        time.sleep(1.0)  # if all ranks fail alike, only rank 0 prints
    print(f"evolvent, rank {world().rank} of {world().size}: {message}", file=sys.__stderr__, flush=True)
    world().Abort(int(status))


def output_is_closed() -> bool:
    """Whether standard output or error is a pipe that nobody reads."""
    for stream in _streams():
        poll = select.poll()
        poll.register(stream.fileno(), 0)
        if any(event & select.POLLERR for _, event in poll.poll(0)):
            return True
    return False


def flushed(status: int) -> int:
    """The exit status once all is printed: `PIPE_CLOSED` where nobody reads it, 1 where it cannot be written. What is
    left is discarded, for Python would try again at its end, and complain."""
    for stream in _streams():
        try:
            stream.flush()
        except OSError as error:
            closed = isinstance(error, BrokenPipeError)
            status = int(Exit.PIPE_CLOSED) if closed else status or int(Exit.FAILED)
            with open(os.devnull, "wb") as nowhere:
                os.dup2(nowhere.fileno(), stream.fileno())
    return status


def _streams() -> list[io.TextIOWrapper]:
    """Standard output and error, where they are open files."""
    return [stream for stream in (sys.stdout, sys.stderr) if isinstance(stream, io.TextIOWrapper) and not stream.closed]


def tolerate_terminal_encoding() -> None:
    """Prints question marks instead of Greek letters on a terminal without them, instead of raising an error."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


@contextlib.contextmanager
def silent_except_on_first() -> Iterator[None]:
    """Context in which only rank 0 prints: messages of the other ranks would repeat its own."""
    if is_first():
        yield
        return
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
        yield
