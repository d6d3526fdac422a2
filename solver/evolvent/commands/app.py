"""The command line `evolvent`, also `python -m evolvent`: parses arguments, calls the API, returns an exit status.

0 done, 2 bad input, 3 not converged or out of balance, 1 anything else. Under mpirun all ranks take part in the
commands that say so; only rank 0 prints, but a rank that fails alone does, and ends all. Rank 0 alone does all else.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import typer

from evolvent.commands.command import Command
from evolvent.commands.computing import COMPUTING
from evolvent.commands.exit import (
    STATUSES,
    Exit,
    flushed,
    leave,
    silent_except_on_first,
    tolerate_terminal_encoding,
)
from evolvent.commands.looking import LOOKING
from evolvent.commands.options import UsageError, Version, usage_message, with_new_names
from evolvent.commands.scene_argument import warn
from evolvent.commands.study import STUDY
from evolvent.fem.backend.cache_folder import keep_fonts
from evolvent.fem.parallel.mpi_start import is_first

COMMANDS: tuple[Command, ...] = (*COMPUTING, STUDY, *LOOKING)
"""All commands, in the order of the help."""
app = typer.Typer(
    name="evolvent",
    help="Frictional contact of involute gear pairs by finite elements, from a scene file to pictures.",
    epilog=f"""\b
Examples:
  evolvent check demos/yang2022.toml
  evolvent run demos/yang2022.toml --out out/yang2022 --level quick
  mpirun -n 2 evolvent run demos/yang2022.toml --out out/yang2022
  evolvent plot out/yang2022

{STATUSES}""",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # examples keep their lines
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback()
def evolvent(version: Version = False) -> None: ...


for command in COMMANDS:
    app.command(command.name, epilog=command.epilog)(command.function)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line and returns the exit status. arguments: by default sys.argv[1:]."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    try:
        if not is_first() and given[:1] not in ([each.name] for each in COMMANDS if each.parallel):
            return Exit.DONE
        if arguments is None:
            tolerate_terminal_encoding()
        with silent_except_on_first():
            keep_fonts()
            return flushed(_status(given))
    except BrokenPipeError:
        return flushed(Exit.PIPE_CLOSED)
    except OSError as error:  # of help and version, which no command prints
        return flushed(leave(str(error), Exit.FAILED).exit_code)


def _status(given: list[str]) -> int:
    """The exit status of a command."""
    try:
        status = app(args=with_new_names(given, warn) or ["--help"], prog_name="evolvent", standalone_mode=False)
    except UsageError as error:
        return leave(usage_message(error), Exit.BAD_INPUT).exit_code
    except typer.Abort:
        return Exit.FAILED
    except SystemExit as end:
        if isinstance(end.__context__, BrokenPipeError):  # click's answer to it
            return Exit.PIPE_CLOSED
        return end.code if isinstance(end.code, int) else Exit.FAILED
    if not given:
        return Exit.BAD_INPUT  # nothing was asked for; versions of click disagree on the status of the help then
    return status if isinstance(status, int) else Exit.DONE


if __name__ == "__main__":
    sys.exit(main())
