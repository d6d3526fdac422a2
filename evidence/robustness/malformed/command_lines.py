"""The commands that the program registers, with a sound value for each of their parameters.

Nothing here names a command: one that is registered later is tried as all others are. A parameter of a new kind needs a
sound value here and wrong ones in `wrong_values`, and is refused until it has them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import typer.main

from evolvent.commands.app import app

SOUND: Mapping[str, str] = {
    "SCENE.toml": "scene.toml", "STUDY.toml": "study.toml", "RECORD.csv...": "record.csv", "DIR": "run",
    "--out DIR": "out", "--out FILE.png": "teeth.png", "--out FILE.msh": "pair.msh",
    "--level line|quick|standard|fine": "quick", "--set KEY=VALUE": "load.torque_Nm=100", "--exact NAME": "window",
    "--percent LIST": "50,100", "--workers N": "1", "--scheduler ADDRESS": "tcp://127.0.0.1:1",
    "--cache-size GB": "1", "list|clear": "list",
    "--petsc-options OPTIONS": "-log_view", "--force-N": "500", "--pin-diameter-mm": "6", "--run-in-m": "500",
}
"""Kind of a parameter, as `Parameter.kind` has it -> a value that is right; files of these names are in the folder
where the commands are tried, of those of options there are none."""


@dataclass(frozen=True)
class Parameter:
    """An argument or an option of a command."""

    option: str
    """Long name of an option, `--out`; empty for an argument."""
    metavar: str
    """What the help calls its value; empty where it is called nothing, and for a flag."""
    required: bool
    flag: bool
    """Whether it takes no value."""

    @property
    def kind(self) -> str:
        """Name under which it has values: option and metavar."""
        return " ".join(part for part in (self.option, self.metavar) if part)

    @property
    def sound(self) -> str:
        """A value that is right. Raises ValueError for a kind that has none yet."""
        if self.kind not in SOUND:
            raise ValueError(f"wanted a sound value of the parameter {self.kind!r}; add one to {__name__}.SOUND")
        return SOUND[self.kind]

    def words(self, value: str) -> list[str]:
        """The words of a command line that give it this value."""
        return [f"{self.option}={value}"] if self.option else [value]


@dataclass(frozen=True)
class CommandLine:
    """A command of the program."""

    name: str
    parameters: tuple[Parameter, ...]

    def words(self, wrong: Parameter | None = None, value: str = "") -> list[str]:
        """A command line with all that is required. wrong: a parameter that takes `value` in place of a sound one."""
        words = [self.name]
        for each in self.parameters:
            if each == wrong:
                words += each.words(value)
            elif each.required:
                words += each.words(each.sound)
        return words


def command_lines() -> tuple[CommandLine, ...]:
    """All commands, in the order of the help."""
    registered = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    return tuple(CommandLine(name, tuple(map(_parameter, each.params))) for name, each in registered.items())


def _parameter(registered: Any) -> Parameter:
    """A parameter as Typer keeps it."""
    long = [name for name in registered.opts if name.startswith("--")]
    flag = bool(getattr(registered, "is_flag", False))
    return Parameter(long[0] if long else "", registered.metavar or "", bool(registered.required), flag)
