"""Programs of an earlier commit and of this one, each in processes of its own with its own cache."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from evidence.checkout import ROOT, python_path
from evidence.processes import Command, Cost, run

TIME_LIMIT = 3600.0  # s


@dataclass(frozen=True)
class Checkout:
    """A checkout of the project."""

    root: Path
    python: Path
    """Interpreter with its dependencies."""
    cache: Path
    """Folder for compiled forms and condensed gears."""

    @staticmethod
    def earlier(root: Path, cache: Path) -> Checkout:
        """An earlier commit, with the environment that `make setup` makes."""
        return Checkout(root, root / ".venv/bin/python", cache)

    @staticmethod
    def this(cache: Path) -> Checkout:
        """This one, with the present interpreter."""
        return Checkout(ROOT, Path(sys.executable), cache)

    def run(self, log: Path, module: str, *arguments: object, ranks: int) -> Cost:
        """Runs a module of the checkout in its root. Raises RunFailed."""
        words = (str(self.python), "-m", module, *map(str, arguments))
        variables = {"PYTHONPATH": python_path(self.root), "XDG_CACHE_HOME": str(self.cache), "EVOLVENT_CACHE_GB": "20"}
        return run(Command(words, self.root, log, variables, ranks, TIME_LIMIT))

    @property
    def condensed(self) -> Path:
        """Folder of the cache for condensed gears."""
        return self.cache / "evolvent" / "condensed"

    def forget_gears(self) -> None:
        """Removes the condensed gears of the cache, not its compiled forms."""
        for entry in self.condensed.glob("*"):
            entry.unlink()

    @property
    def commit(self) -> str:
        """Abbreviated name of its commit."""
        words = "git", "-C", str(self.root), "rev-parse", "--short", "HEAD"
        return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()
