"""Options that commands share, and what is wrong with options and arguments, said like what is wrong with a scene."""

from __future__ import annotations

import difflib
import re
from pathlib import Path
from typing import Annotated, Any, cast

import typer

from evolvent.scene.schema.errors import NOTHING, Problem, shown

UsageError: type[Exception] = cast(type[Exception], typer.BadParameter.__mro__[1])
"""What typer raises for an option or argument that it cannot use; it has no public name of its own."""


def usage_message(error: Any) -> str:
    """Key, found, allowed and remedy of a `UsageError`; the help as it is where nothing was given but the program."""
    if type(error).__name__ == "NoArgsIsHelpError" or "; allowed: " in error.message:
        return str(error.message)
    return str(_usage_problem(error))


def _usage_problem(error: Any) -> Problem:
    """In the words of this program."""
    text, context = " ".join(str(error.message).split()), getattr(error, "ctx", None)
    own = f"{context.info_name} " if context is not None and context.parent is not None else ""
    remedy = f"see `evolvent {own}--help`"
    if hasattr(error, "option_name"):
        return _option_problem(error, text, remedy)
    if (parameter := getattr(error, "param", None)) is not None:
        help_text = (parameter.help or "a value").split(";")[0].rstrip(".")
        return Problem(_name(parameter), text or NOTHING, help_text[0].lower() + help_text[1:], f"give one; {remedy}")
    if match := re.search(r"No such command [\"'](.*?)[\"']", text):
        names = list(context.command.commands) if context is not None else []
        return Problem("command", shown(match[1]), ", ".join(names), _meant(match[1], names) or remedy)
    if match := re.search(r"extra argument.*\((.*)\)$", text):
        return Problem("arguments", shown(match[1]), "those of the command alone", f"leave it out; {remedy}")
    return Problem("command line", text, "what --help tells", remedy)


def _option_problem(error: Any, text: str, remedy: str) -> Problem:
    """Of an unknown option, of one without its value, of a flag with one."""
    if hasattr(error, "possibilities"):
        parameters = error.ctx.command.params if error.ctx is not None else []
        names = [name for each in parameters for name in each.opts if name.startswith("-")]
        allowed = ", ".join(names) or "the options of the command"
        return Problem(error.option_name, "an unknown option", allowed, _meant(error.option_name, names) or remedy)
    if "requires" in text:
        return Problem(error.option_name, NOTHING, "a value behind the option", f"give one; {remedy}")
    return Problem(error.option_name, "a value", "the option alone", "leave the value out")


def _meant(name: str, names: list[str]) -> str:
    """The one that was meant by another, as a remedy; empty if there is none."""
    similar = difflib.get_close_matches(name, names, n=1)
    return f"did you mean {similar[0]}?" if similar else ""


def _name(parameter: Any) -> str:
    """--out, or SCENE.toml."""
    named = [each for each in parameter.opts if each.startswith("-")]
    return str(named[0] if named else parameter.metavar or parameter.name)


def given_path(text: str) -> Path:
    """A path that somebody wrote; an empty one would be the current folder. Raises typer.BadParameter."""
    if not text:
        raise typer.BadParameter("an empty text")
    return Path(text)


def given_number(text: str) -> float:
    """A number that somebody wrote. Raises typer.BadParameter."""
    try:
        return float(text)
    except ValueError:
        raise typer.BadParameter(f"{shown(text)}, no number") from None


SceneFile = Annotated[
    Path,
    typer.Argument(metavar="SCENE.toml", help="The scene file; docs/scene.md lists its keys.", parser=given_path),
]
Overrides = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Override a key of the scene; may be repeated."),
]
NoSkip = Annotated[
    list[str] | None,
    typer.Option("--no-skip", metavar="NAME", help="Compute the long way what is skipped; may be repeated."),
]
LevelOption = Annotated[
    str | None, typer.Option("--level", metavar="quick|standard|fine", help="Short for --set mesh.level=...")
]
Force = Annotated[bool, typer.Option("--force", help="Go on where the machine seems to have too little memory.")]
