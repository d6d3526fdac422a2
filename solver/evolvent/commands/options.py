"""Options that commands share; messages on wrong options and arguments, in the form of those on a wrong scene."""

from __future__ import annotations

import difflib
import os
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, cast

import typer

from evolvent import __version__
from evolvent.scene.schema.errors import NOTHING, InputProblem, shown
from evolvent.scene.schema.loading import MOST_TORQUES
from evolvent.scene.schema.output import SKIP_NAMES

MOST_DIGITS, MOST_SHOWN = 9, 40
"""Largest number of digits of a number of worker processes, and of characters of an invalid one in a message."""
MOST_GIGABYTES = 1e6
"""Size of a cache that no disk has."""
CACHE_SIZE = "EVOLVENT_CACHE_GB"
"""Environment variable that evolvent.fem.cache.cache reads."""
MOST_PERCENT = 1000.0
"""Largest part of a scene's torque in a load list."""
UsageError: type[Exception] = cast(type[Exception], typer.BadParameter.__base__)
"""Exception of typer for an option or argument that it cannot use. Typer has no public name for this class."""
EXAMPLES = {"DIR": "out/mine", "FILE.msh": "pair.msh", "FILE.png": "teeth.png"}
"""Placeholder of the argument of --out in the help -> an example."""

WITHOUT_RESUME = {"study": "the same command goes on with the scenes that are missing"}
"""Command without --resume -> what it does with earlier results."""
RENAMED = {"--no-skip": "--exact"}
"""Old name of an option -> its present name."""


def with_new_names(arguments: Sequence[str], warn: Callable[[Sequence[str]], None]) -> list[str]:
    """The command line with the present names of its options. warn: is given a sentence on each old one."""
    names = [argument.partition("=")[0] for argument in arguments]
    warn([f"{name} is the old name of {RENAMED[name]}." for name in dict.fromkeys(names) if name in RENAMED])
    return [RENAMED.get(name, name) + each.removeprefix(name) for name, each in zip(names, arguments)]


def usage_message(error: Any) -> str:
    """Message of a `UsageError` with found, allowed and remedy; the help where the command line is empty."""
    context = getattr(error, "ctx", None)
    is_help = context is not None and error.message == context.get_help()
    if is_help or "; allowed: " in error.message:
        return str(error.message)
    return str(_usage_problem(error))


def _usage_problem(error: Any) -> InputProblem:
    """Typer's error as a problem with key, found, allowed and remedy."""
    text, context = " ".join(str(error.message).split()), getattr(error, "ctx", None)
    command = f"{context.info_name} " if context is not None and context.parent is not None else ""
    remedy = f"see `evolvent {command}--help`"
    if hasattr(error, "option_name"):
        return _option_problem(error, text, remedy)
    if (parameter := getattr(error, "param", None)) is not None:
        help_text = (parameter.help or "a value").split(";")[0].rstrip(".")
        allowed = help_text[0].lower() + help_text[1:]
        name = _name(parameter)
        example = EXAMPLES.get(parameter.metavar or "")
        give = f"write {name} {example}" if name == "--out" and example else "give one"
        return InputProblem(name, text or NOTHING, allowed, f"{give}; {remedy}")
    if match := re.search(r"No such command [\"'](.*?)[\"']", text):
        names = list(context.command.commands) if context is not None else []
        return InputProblem("command", shown(match[1]), ", ".join(names), _meant(match[1], names) or remedy)
    if match := re.search(r"extra argument.*\((.*)\)$", text):
        return InputProblem("arguments", shown(match[1]), "those of the command alone", f"leave it out; {remedy}")
    return InputProblem("command line", text, "what --help tells", remedy)


def _option_problem(error: Any, text: str, remedy: str) -> InputProblem:
    """The problem with an unknown option, an option without its value, or a flag with one."""
    if hasattr(error, "possibilities"):
        parameters = error.ctx.command.params if error.ctx is not None else []
        names = [name for each in parameters for name in each.opts if name.startswith("-")]
        allowed = ", ".join(names) or "the options of the command"
        name = error.ctx.info_name if error.ctx is not None else ""
        if error.option_name == "--resume":
            remedy = f"leave it out: {WITHOUT_RESUME.get(name, 'the command has nothing to go on from')}"
        else:
            remedy = _having(error.option_name, error.ctx) or _meant(error.option_name, names) or remedy
        return InputProblem(error.option_name, "an unknown option", allowed, remedy)
    if "requires" in text:
        return InputProblem(error.option_name, NOTHING, "a value behind the option", f"give one; {remedy}")
    return InputProblem(error.option_name, "a value", "the option alone", "leave the value out")


def _having(option: str, context: Any) -> str:
    """Remedy for an option that other commands have; empty where none has it. context: of the command."""
    every = getattr(getattr(getattr(context, "parent", None), "command", None), "commands", {})
    having = [name for name, each in every.items() if any(option in parameter.opts for parameter in each.params)]
    return f"leave it out, or take a command that has it: evolvent {', '.join(having)}" if having else ""


def _meant(name: str, names: list[str]) -> str:
    """The most similar of the names, as a remedy; empty if none is similar."""
    similar = difflib.get_close_matches(name, names, n=1)
    return f"did you mean {similar[0]}?" if similar else ""


def _name(parameter: Any) -> str:
    """The name of a parameter on the command line: --out, or SCENE.toml."""
    named = [each for each in parameter.opts if each.startswith("-")]
    return str(named[0] if named else parameter.metavar or parameter.name)


def given_path(text: str) -> Path:
    """A path from the command line; empty text would be the current folder. Raises typer.BadParameter."""
    if not text:
        raise typer.BadParameter("an empty text")
    return Path(text)


def given_number(text: str) -> float:
    """A number from the command line. Raises typer.BadParameter."""
    try:
        return float(text)
    except ValueError:
        raise typer.BadParameter(f"{shown(text)}, no number") from None


def given_count(text: str) -> int:
    """A number of worker processes from the command line. Raises typer.BadParameter."""
    if text.isascii() and text.isdigit() and len(text) <= MOST_DIGITS and int(text) > 0:
        return int(text)
    cores = len(os.sched_getaffinity(0))
    raise typer.BadParameter(
        f"--workers: found {text[:MOST_SHOWN]}; allowed: a whole number from 1 on; remedy: write --workers {cores}"
    )


def given_percents(text: str) -> tuple[float, ...]:
    """Percentages from the command line, "5,10,100". Raises typer.BadParameter."""
    parts = text.split(",")
    if len(parts) > MOST_TORQUES:
        raise typer.BadParameter(
            f"--percent: found {len(parts)} numbers; allowed: up to {MOST_TORQUES}, each of which costs a run; "
            "remedy: write --percent 25,50,100, and what lies between in further calls"
        )
    percents = tuple(given_number(part.strip()) for part in parts)
    wrong = [each for each in percents if not 0.0 < each <= MOST_PERCENT]  # NaN among them
    if wrong or len(set(percents)) < len(percents):
        allowed = f"different numbers above 0 up to {MOST_PERCENT:g}"
        raise typer.BadParameter(f"--percent: found {text}; allowed: {allowed}; remedy: write --percent 25,50,100")
    return percents


SceneFile = Annotated[
    Path,
    typer.Argument(metavar="SCENE.toml", help="The scene file; docs/scene.md lists its keys.", parser=given_path),
]
Overrides = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Override a key of the scene; may be repeated."),
]
ExactParts = Annotated[
    list[str] | None,
    typer.Option(
        "--exact",
        metavar="NAME",
        help=f"Compute this part without its simplification; may be repeated. Names: {', '.join(SKIP_NAMES)}.",
    ),
]


def torque_list(default: str) -> Any:
    """Option for the torques of a list. default: as the help shows it."""
    words = "In percent of the scene's torque; by default the loads that the scene lists, load.percents or load_case."
    return Annotated[
        Any, typer.Option("--percent", metavar="LIST", help=words, parser=given_percents, show_default=default)
    ]


def results_folder(help_text: str) -> Any:
    """The type of --out of a command that computes into a folder."""
    return Annotated[Path, typer.Option("--out", metavar="DIR", help=help_text, parser=given_path)]


ResultsFolder = Annotated[Path, typer.Option("--out", metavar="DIR", help="Where results go.", parser=given_path)]
Percents = Any
"""Torques of a list; its option is that of `torque_list`."""
PetscOptions = Annotated[
    str | None, typer.Option("--petsc-options", metavar="OPTIONS", help='For PETSc, such as "-log_view".')
]
LevelOption = Annotated[
    str | None,
    typer.Option(
        "--level",
        metavar="line|quick|standard|fine",
        help="Short for --set mesh.level=...; by default the scene's, which is standard where it names none.",
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Go on where the machine seems to have too little memory.")]
Resume = Annotated[
    bool, typer.Option("--resume", help="Continue a run that was stopped; with the same scene and --set.")
]
Overwrite = Annotated[
    bool, typer.Option("--overwrite", help="Remove an earlier run from DIR, once the gears are condensed.")
]


def given_gigabytes(text: str) -> float:
    """A size of the cache from the command line [GB]. Raises typer.BadParameter."""
    size = given_number(text)
    if not 0.0 <= size < MOST_GIGABYTES:
        allowed = f"a number from 0 to {MOST_GIGABYTES:g}"
        raise typer.BadParameter(f"--cache-size: found {text}; allowed: {allowed}; remedy: write --cache-size 20")
    return size


NoCache = Annotated[bool, typer.Option("--no-cache", help="Condense the gears anew, and do not keep them.")]
CacheSize = Annotated[
    Any,
    typer.Option("--cache-size", metavar="GB", help="Largest size of the cache of condensed gears.",
                 parser=given_gigabytes, show_default="a tenth of the free disk"),
]


def use_cache(no_cache: bool, size: float | None) -> None:
    """Lets this process and those that it starts use a cache of this size [GB]; None: as the environment says."""
    if no_cache or size is not None:
        os.environ[CACHE_SIZE] = "0" if no_cache else f"{size:g}"


Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print warnings only.")]


def _print_version(wanted: bool) -> None:
    """Prints the version and ends the program, if it is wanted."""
    if wanted:
        typer.echo(f"evolvent {__version__}")
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", is_eager=True, callback=_print_version, help="Print the version.")
]
