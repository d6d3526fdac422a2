"""Wall time and memory of a run, summed over its resumed parts and stored with the results."""

from __future__ import annotations

import json
from dataclasses import asdict, astuple, dataclass, fields, replace
from pathlib import Path

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.store import ArchiveError
from evolvent_meshes.files import open_file

FILE = Path("results/cost.json")
"""File of the cost below OUT."""
BEFORE = "run"
"""Command of a file without one: earlier versions wrote the cost of this command alone."""


@dataclass(frozen=True)
class Timings:
    """Wall time of each stage of a run [s], summed over the parts of a resumed run. Work of a killed part after its
    last archived position or error bars is not counted."""

    mesh: float = 0.0
    """Meshing of both gears."""
    assemble: float = 0.0
    """Assembly of stiffness and of Nitsche's constant term."""
    factor: float = 0.0
    """Condensation of both gears, and coupling of sectors to rings."""
    positions: float = 0.0
    """Solution of all positions at all friction coefficients, or of all blocks of a wear study."""
    error_bars: float = 0.0
    """Solution of the coarse companion."""
    output: float = 0.0
    """Tables, fields and pictures; they are written again where a finished run is resumed."""
    total: float = 0.0
    """The whole run; for a worn pair, the study until then."""

    def __add__(self, other: Timings) -> Timings:
        return Timings(*(one + more for one, more in zip(astuple(self), astuple(other))))

    def then_solved(self, seconds: float) -> Timings:
        """Wall time of a preparation, with that of the solution after it. seconds: of both."""
        return replace(self, positions=seconds - self.total, total=seconds)


@dataclass(frozen=True)
class Cost:
    """Cost of a run or of a part of it."""

    timings: Timings = Timings()
    """Wall time of each stage."""
    memory_MB: float = 0.0
    """Largest resident memory, summed over the ranks [MB]."""
    command: str = ""
    """Command that has computed; empty where nothing was computed."""

    def __add__(self, other: Cost) -> Cost:
        """Cost of two successive parts of a run."""
        memory = max(self.memory_MB, other.memory_MB)
        return Cost(self.timings + other.timings, memory, other.command or self.command)


def write_cost(folder: RunFolder, cost: Cost) -> None:
    """Writes OUT/results/cost.json. Raises WriteError, FolderError."""
    folder.write_text(FILE, json.dumps(asdict(cost), indent=1) + "\n")


def read_cost(folder: RunFolder) -> Cost:
    """The cost that `write_cost` wrote, zero where there is none. Raises ArchiveError where it cannot be read."""
    path = folder.out / FILE
    if not path.exists():
        return Cost()
    try:
        with open_file(path) as file:
            values = json.load(file)
        seconds = [float(values["timings"][field.name]) for field in fields(Timings)]
        return Cost(Timings(*seconds), float(values["memory_MB"]), str(values.get("command") or BEFORE))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ArchiveError(
            f"{path}: wanted what the run has cost so far, found no such thing ({type(error).__name__}: {error}); "
            "remove the file, and the run's times begin anew"
        ) from error
