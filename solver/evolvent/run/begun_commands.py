"""The command that has written to a folder, by the files that it has left, whole or not."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evolvent.results.tables.load_table import RUNS
from evolvent.run.folder_checks import STUDY

RESUME, OVERWRITE = " --resume", " --overwrite"


@dataclass(frozen=True)
class BegunCommand:
    """A command, and how it is called again where its files are not all there."""

    names: tuple[str, ...]
    """Names of the command; of several the first files are the same."""
    files: tuple[str, ...]
    """Patterns of its files, of which one is there as soon as it has written anything."""
    again: str
    """Options of the call that leaves all files."""

    def found(self, out: Path) -> str:
        """Name of the first of its files in a folder, empty where there is none."""
        there = (path for pattern in self.files for path in sorted(out.glob(pattern)))
        return next((path.relative_to(out).as_posix() for path in there), "")

    def remedy(self, out: Path) -> str:
        """Command to call for the pictures of the folder."""
        if self.names == ("study",):
            return (
                f"`evolvent study STUDY.toml --out {out}` draws its pictures again, `evolvent plot "
                f"{out / 'scenes/NAME'}` those of a scene"
            )
        calls = " or ".join(f"`evolvent {name} SCENE.toml --out {out}{self.again}`" for name in self.names)
        return f"run {calls} first"


BEGUN_COMMANDS = (
    BegunCommand(("study",), (STUDY,), ""),
    BegunCommand(("loads",), ("loads.csv", RUNS.format("*")), RESUME),
    BegunCommand(("fatigue",), ("fatigue.toml", "fatigue*.csv", "fatigue.json"), OVERWRITE),
    BegunCommand(("strength",), ("strength.toml", "strength.csv", "root_stress.csv", "gauges.csv"), OVERWRITE),
    BegunCommand(("transient",), ("transient.toml", "transient*.csv", "transient.json", "results/transient_*.npz"),
                 RESUME),
    BegunCommand(("dynamics",), ("dynamics.json", "response.csv"), RESUME),
    BegunCommand(("excitation", "dynamics"), ("excitation.*", "results/excitation*.npz"), RESUME),
    BegunCommand(("run",), ("results/state.npz", "results/wear.npz"), RESUME),
)
"""Commands with a folder; those whose files others write, too, come last."""


def begun_command(out: Path) -> BegunCommand | None:
    """The command that has begun to write to a folder; None where there are no files of any."""
    return next((each for each in BEGUN_COMMANDS if each.found(out)), None)
