"""A command of the program, as `evolvent.commands.app` registers it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Command:
    """A name of the command line with the function behind it."""

    name: str
    """The first word of the command line."""
    function: Callable[..., None]
    """Function of the command. Its parameters are those of the command line, its docstring is the help."""
    epilog: str
    """The end of the help: examples and exit statuses."""
    parallel: bool = False
    """Whether all ranks of mpirun take part; else rank 0 does it alone."""
