"""Every command with malformed input: what is tried, and how each trial ends.

Commands are called in this process, each in the same folder, which holds sound files of every kind and things that are
no files. None may compute, write a file, show a traceback or take longer than `PATIENCE`.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import re
import shutil
import signal
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import cycle
from pathlib import Path

from evidence.checkout import DEMOS
from evidence.robustness.malformed.command_lines import CommandLine, Parameter, command_lines
from evidence.robustness.malformed.wrong_values import SPOILT, WRONG, scene_settings, spoilt_at_random, study_lines
from evolvent.commands.app import main
from evolvent.commands.exit import Exit

PATIENCE = 20.0
"""Seconds after which a command hangs."""
SCENE = (DEMOS / "he2022_dynamics.toml").read_bytes()
STUDY = b"""scene = "scene.toml"
compute = "check"

[set]
sweep.positions = 8

[grid]
load.torque_Nm = [100.0, 200.0]
"""
RECORD = "sliding_distance_m,depth_um\n" + "".join(f"{100 * n},{n}\n" for n in range(1, 20))
SEEDS = 10
"""Files of a command that are spoilt at random."""
PROGRESS = re.compile(r" +[\d.]+ s  ")
"""How a line begins that shows how far a command is."""
SPOILABLE = {"SCENE.toml": SCENE, "STUDY.toml": STUDY}
"""Kind of a parameter that names a file which is read -> a sound one."""


@dataclass(frozen=True)
class Trial:
    """A command line that must be refused."""

    command: str
    wrong: str
    """What is wrong with it."""
    words: tuple[str, ...]
    """The command line."""
    spoilt: tuple[str, bytes] | None = None
    """Name and content of a file that takes the place of a sound one."""


class Verdict(Enum):
    """How a trial ended; all but the first are failures of the program."""

    REFUSED = "refused with a message"
    ACCEPTED = "accepted"
    TRACEBACK = "ended with a traceback"
    STATUS = "ended with another status than 2"
    UNCLEAR = "refused without saying what was found and what to do"
    WROTE = "changed files"
    HUNG = "did not end"


@dataclass(frozen=True)
class Outcome:
    """What a command did with malformed input."""

    command: str
    wrong: str
    verdict: Verdict
    message: str
    """What it printed on stderr."""
    seconds: float


class _Hangs(BaseException):
    """Raised in a command that takes too long; no handler of the command may take it for one of its own errors."""


def trials(commands: Iterable[CommandLine] = ()) -> Iterator[Trial]:
    """All trials of these commands, by default of all that there are."""
    chosen = tuple(commands) or command_lines()
    for command in chosen:
        yield from _command_line_trials(command)
        yield from _file_trials(command)
    yield from _setting_trials(chosen)


def _command_line_trials(command: CommandLine) -> Iterator[Trial]:
    """Wrong values, missing and unknown parameters."""
    sound = command.words()
    yield Trial(command.name, "an unknown option", (*sound, "--no-such-option"))
    if not any(parameter.metavar.endswith("...") for parameter in command.parameters):
        yield Trial(command.name, "an argument too many", (*sound, "more"))
    for parameter in command.parameters:
        if parameter.flag:
            yield Trial(command.name, f"{parameter.option} with a value", (*sound, f"{parameter.option}=yes"))
            continue
        if parameter.required:
            words = [word for word in sound if word not in parameter.words(parameter.sound)]
            yield Trial(command.name, f"no {parameter.kind}", tuple(words))
        for value in _wrong_values(parameter):
            words = command.words(parameter, value)
            words += [] if parameter.required else parameter.words(value)
            yield Trial(command.name, f"{parameter.kind}: {value[:40]!r}", tuple(words))


def _wrong_values(parameter: Parameter) -> tuple[str, ...]:
    """Values that a parameter refuses. Raises ValueError for a kind that has none yet."""
    if parameter.kind not in WRONG:
        raise ValueError(f"wanted wrong values of the parameter {parameter.kind!r}; add some to wrong_values.WRONG")
    return WRONG[parameter.kind]


def _file_trials(command: CommandLine) -> Iterator[Trial]:
    """Files that are spoilt in a known way, and at random."""
    for parameter in command.parameters:
        if (sound := SPOILABLE.get(parameter.kind)) is None:
            continue
        spoilt = {what: spoil(sound) for what, spoil in SPOILT.items()}
        spoilt |= {f"spoilt at random, seed {seed}": spoilt_at_random(sound, seed) for seed in range(SEEDS)}
        for what, content in spoilt.items():
            yield Trial(command.name, f"{parameter.kind}: {what}", tuple(command.words()), (parameter.sound, content))


def _setting_trials(commands: tuple[CommandLine, ...]) -> Iterator[Trial]:
    """Each key of a scene and of a study with values that it cannot have; the commands that read them take turns."""
    reading = {kind: [each for each in commands if any(parameter.kind == kind for parameter in each.parameters)]
               for kind in SPOILABLE}
    for command, setting in zip(cycle(reading["SCENE.toml"]), scene_settings()):
        yield Trial(command.name, setting[:80], (*command.words(), f"--set={setting}"))
    for command, line in zip(cycle(reading["STUDY.toml"]), study_lines()):
        yield Trial(command.name, line[:80].strip(), tuple(command.words()), ("study.toml", line.encode() + STUDY))


def outcomes(folder: Path, tried: Iterable[Trial]) -> Iterator[Outcome]:
    """How each trial ends, in a folder that is made for it."""
    _make(folder)
    for trial in tried:
        found = outcome(folder, trial)
        if found.verdict is not Verdict.REFUSED or trial.spoilt is not None:
            _make(folder)
        yield found


def outcome(folder: Path, trial: Trial) -> Outcome:
    """How one trial ends in a folder that `_make` has filled."""
    if trial.spoilt is not None:
        name, content = trial.spoilt
        (folder / name).write_bytes(content)
    before, begin = _files(folder), time.perf_counter()
    status, message = _called(folder, trial.words)
    seconds = time.perf_counter() - begin
    return Outcome(trial.command, trial.wrong, _verdict(status, message, before != _files(folder)), message, seconds)


def _verdict(status: int | None, message: str, wrote: bool) -> Verdict:
    """status: None of a command that did not end."""
    if status is None:
        return Verdict.HUNG
    if "Traceback" in message or 'File "' in message:
        return Verdict.TRACEBACK
    if status == Exit.DONE:
        return Verdict.ACCEPTED
    if status != Exit.BAD_INPUT:
        return Verdict.STATUS
    if wrote:
        return Verdict.WROTE
    lines = [line for line in message.splitlines() if not PROGRESS.match(line)]
    clear = bool(lines) and all(line.startswith("evolvent: ") and "found " in line for line in lines)
    return Verdict.REFUSED if clear else Verdict.UNCLEAR


def _called(folder: Path, words: tuple[str, ...]) -> tuple[int | None, str]:
    """Exit status, None if it does not end, and what a command printed on stderr."""
    errors, here = io.StringIO(), Path.cwd()
    before = signal.signal(signal.SIGALRM, _hangs)
    signal.setitimer(signal.ITIMER_REAL, PATIENCE)
    os.chdir(folder)
    try:
        with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()):
            status: int | None = main(words)
    except _Hangs:
        status = None
    except Exception as error:
        status, _ = Exit.FAILED, errors.write(f"Traceback: {type(error).__name__}: {error}")
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
        os.chdir(here)
    return status, errors.getvalue()


def _hangs(*_: object) -> None:
    raise _Hangs


def _make(folder: Path) -> None:
    """A folder with a sound file of every kind, and with what is no file."""
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "folder").mkdir(parents=True)
    for name, content in (("scene.toml", SCENE), ("study.toml", STUDY), ("record.csv", RECORD.encode())):
        (folder / name).write_bytes(content)
    os.mkfifo(folder / "pipe")
    (folder / "dangling").symlink_to("nowhere/at/all")
    (folder / "loop").symlink_to("loop")


def _files(folder: Path) -> dict[str, tuple[int, int, str]]:
    """Mode, time of the last change and digest of everything below a folder; pipes and links are not followed."""
    return {
        str(path.relative_to(folder)): (
            (state := path.lstat()).st_mode, state.st_mtime_ns,
            hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() and not path.is_symlink() else "",
        )
        for path in sorted(folder.rglob("*"))
    }
