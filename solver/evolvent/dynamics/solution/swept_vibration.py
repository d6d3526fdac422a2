"""Motions of an oscillator over the speed as tables, of a gear pair as on a given mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evolvent.dynamics.mesh_oscillator import MeshOscillator
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.results.response import BranchRow, ResponseRow, branch_rows, jumps, response_rows, responses
from evolvent.dynamics.results.response_errors import WAYS, unknown_errors
from evolvent.gears.problem.iso_dynamic_factor import MethodB
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import number, numbers, refuse

SLOWEST = 1e-3
"""Least speed [r/min]."""


@dataclass(frozen=True, eq=False)
class SweptVibration:
    """Motions of a pair that runs slowly up through n speeds, and down again."""

    rows: tuple[ResponseRow, ...]
    """Motion at each speed, running up, then down; the columns of response.csv. Error bars are NaN."""
    branch: tuple[BranchRow, ...]
    """All steady states, stable or not, in their order along the branch."""
    natural_speed: float
    """Speed of the pinion at which the mesh frequency is the natural frequency [r/min]."""
    jumps_up: tuple[float, ...]
    """Speeds at which a pair that runs up leaves the branch of steady states [r/min]."""
    jumps_down: tuple[float, ...]
    """Speeds at which a pair that runs down leaves the branch of steady states [r/min]."""

    @property
    def speeds(self) -> Floats:
        """Speeds (n,) of the pinion [r/min]."""
        return self.curve("speed_rpm")

    def curve(self, column: str, way: str = "up") -> Floats:
        """A column of `rows` over the speeds (n,), such as "equivalent_amplitude_um" or "dynamic_factor". way: "up" or
        "down". Raises InputError for one that there is not."""
        known = list(ResponseRow.__dataclass_fields__)
        if column not in known:
            refuse("column", f"one of {', '.join(known)}", column, "take one of these")
        if way not in WAYS:
            refuse("way", 'running "up" or "down"', way, "take one of these")
        return np.array([getattr(row, column) for row in self.rows if row.way == way])

    def save(self, path: Path | str) -> Path:
        """Writes `rows` to a CSV file, and returns its path; creates missing folders. Raises InputError for another
        ending, WriteError."""
        from evolvent.results.solution.user_files import save_rows

        return save_rows(path, self.rows)


def swept_tables(pair: MeshOscillator, swept: SpeedSweep, iso: MethodB | None) -> SweptVibration:
    """Tables of a sweep. iso: of the pair; None where no gears are known."""
    found, up, down = responses(pair, swept), jumps(pair, swept.up), jumps(pair, swept.down[::-1])
    errors = unknown_errors(len(swept.periods), len(up), len(down))
    rows = tuple(response_rows(pair, swept, found, iso, errors))
    return SweptVibration(rows, tuple(branch_rows(pair, swept)), pair.natural_speed, up, down)


def checked_speeds(speeds: Sequence[float] | Floats) -> Floats:
    """Speeds as an array. Raises InputError unless there are two at least, ascending from above 0."""
    numbers("speeds", speeds)
    for speed in speeds:
        number("speeds", speed, "numbers above 0, in r/min", "take positive ones", lambda n: n >= SLOWEST)
    values = np.asarray(speeds, dtype=float)
    if len(values) < 2 or not (np.diff(values) > 0.0).all():
        refuse("speeds", "two or more, ascending", speeds, "write np.linspace(first, last, count)")
    return values
