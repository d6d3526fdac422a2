"""What a run has cost so far, its resumed parts together: wall time and memory, kept beside the results."""

from __future__ import annotations

import json
from dataclasses import asdict, astuple, dataclass, fields
from pathlib import Path

from evolvent.results.archive.archive import ArchiveError
from evolvent.results.archive.run_folder import RunFolder
from evolvent_meshes.files import open_file

FILE = Path("results/cost.json")


@dataclass(frozen=True)
class Timings:
    """Wall seconds of the parts of a run, summed where it was resumed; what a killed part did after the last position
    or the error bars that it kept is not counted."""

    mesh: float = 0.0
    """Meshing both gears."""
    assemble: float = 0.0
    """Their stiffness and Nitsche's constant term."""
    factor: float = 0.0
    """Condensing both gears and closing the rings of teeth."""
    positions: float = 0.0
    """All positions at all friction coefficients; of a wear study, all of its blocks."""
    error_bars: float = 0.0
    """The coarse companion."""
    output: float = 0.0
    """Tables, fields and pictures; drawn once more where a finished run is resumed."""
    total: float = 0.0
    """The whole run; of a worn pair, the study until then."""

    def __add__(self, other: Timings) -> Timings:
        return Timings(*(one + more for one, more in zip(astuple(self), astuple(other))))


@dataclass(frozen=True)
class Cost:
    """Wall time, and the largest resident memory summed over the ranks [MB]."""

    timings: Timings = Timings()
    memory_MB: float = 0.0

    def __add__(self, other: Cost) -> Cost:
        """Of two parts of a run, one after the other."""
        return Cost(self.timings + other.timings, max(self.memory_MB, other.memory_MB))


def keep_cost(folder: RunFolder, cost: Cost) -> None:
    """Writes OUT/results/cost.json. Raises WriteError, FolderError."""
    folder.write_text(FILE, json.dumps(asdict(cost), indent=1) + "\n")


def kept_cost(folder: RunFolder) -> Cost:
    """What `keep_cost` kept, nothing where it kept nothing. Raises ArchiveError where it cannot be read."""
    path = folder.out / FILE
    if not path.exists():
        return Cost()
    try:
        with open_file(path) as file:
            found = json.load(file)
        seconds = [float(found["timings"][field.name]) for field in fields(Timings)]
        return Cost(Timings(*seconds), float(found["memory_MB"]))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ArchiveError(
            f"{path}: wanted what the run has cost so far, found no such thing ({type(error).__name__}: {error}); "
            "remove the file, and the run's times begin anew"
        ) from error
