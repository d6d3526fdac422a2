"""How a command ends: one message on stderr and an exit status, on any number of ranks.

0 done, 2 bad input, 3 not converged or out of balance, 1 anything else. Rank 0 speaks; a rank that fails alone says so
and ends the run on all ranks.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
import time
import traceback
from collections.abc import Iterator
from enum import IntEnum

import typer
from mpi4py import MPI

from evolvent.run.stopping import stoppable
from evolvent.scene.schema.errors import SceneError
from evolvent_meshes.errors import EvolventError


class Exit(IntEnum):
    """Exit statuses."""

    DONE = 0
    FAILED = 1
    BAD_INPUT = 2
    NOT_CONVERGED = 3


@contextlib.contextmanager
def reported(parallel: bool = False, advice: str = "") -> Iterator[None]:
    """Turn exceptions and signals into one message on stderr and an exit status; in a parallel run end the other ranks
    too. advice: what is said beside a signal's name."""
    try:
        with stoppable(advice, _end_all if parallel else lambda: None):
            yield
    except (typer.Exit, typer.Abort, typer.BadParameter):
        raise
    except SceneError as error:  # the same on all ranks
        raise leave(str(error), Exit.BAD_INPUT) from error
    except KeyboardInterrupt as error:  # `stoppable` has said so
        if parallel:
            _end_all()
        raise typer.Exit(int(Exit.FAILED)) from error
    except Exception as error:
        status = Exit(error.exit_status) if isinstance(error, EvolventError) else Exit.FAILED
        plain = isinstance(error, (EvolventError, OSError, MemoryError))
        message = str(error) if plain else f"{_details(error)}\n{type(error).__name__}: {error}"
        _abort_others(parallel, message, status)
        raise leave(message, status) from error


def _details(error: Exception) -> str:
    """The traceback, and the one of the rank on which the error arose, which is its note."""
    return "\n".join(["".join(traceback.format_tb(error.__traceback__)).rstrip(), *getattr(error, "__notes__", ())])


def leave(message: str, status: Exit) -> typer.Exit:
    message = message.encode(errors="backslashreplace").decode()  # names of files may have bytes that are no text
    typer.echo(f"evolvent: {message}" if "\n" not in message else message, err=True)
    return typer.Exit(int(status))


def _end_all() -> None:
    """End all ranks, if there are several."""
    if MPI.COMM_WORLD.size > 1:
        MPI.COMM_WORLD.Abort(int(Exit.FAILED))


def _abort_others(parallel: bool, message: str, status: Exit) -> None:
    """End all ranks: one that waits in a collective call would wait for ever."""
    world = MPI.COMM_WORLD
    if not parallel or world.size == 1:
        return
    if world.rank > 0:
        time.sleep(1.0)  # if all ranks fail alike, rank 0 speaks for them
    print(f"evolvent, rank {world.rank} of {world.size}: {message}", file=sys.__stderr__, flush=True)
    world.Abort(int(status))


def write_whatever_the_terminal_shows() -> None:
    """Greek letters on a terminal without them come out as question marks, not as an error."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


@contextlib.contextmanager
def silent_unless_first() -> Iterator[None]:
    """Rank 0 speaks; the others' usage messages and reports would only repeat it."""
    if MPI.COMM_WORLD.rank == 0:
        yield
        return
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
        yield
