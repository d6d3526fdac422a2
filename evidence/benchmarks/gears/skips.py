"""What each skip saves: the same scene run with and without it, and by how much the results differ.

Every run is a process of its own, so that its largest memory is its own; seconds are those of the whole run.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

from evidence.checkout import ROOT
from evidence.processes import environment, module_run, run_arguments
from evidence.scenes import PLAIN
from evolvent.scene.schema.output import SkipName
from evolvent.scene.skips import skip_named

SPUR, HELICAL = "demos/he2022.toml", "demos/yang2022.toml"
QUICK = ("mesh.level=quick", *PLAIN)
SMOOTH, ROUGH = "contact.friction=0", "contact.friction=[0, 0.1, 0.3]"
FOUR = "sweep.positions=4"
Summary = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """A skip, and the scene on which it is measured."""

    skip: SkipName
    scene: str
    settings: tuple[str, ...]


CASES = (
    Case("plane", SPUR, (*QUICK, SMOOTH, FOUR)),
    Case("friction-terms", HELICAL, (*QUICK, SMOOTH, FOUR)),
    Case("one-pitch", HELICAL, (*QUICK, "contact.friction=[0.0, 0.3]", "sweep.positions=10")),
    Case("one-sector", SPUR, (*QUICK, SMOOTH, FOUR)),
    Case("far-teeth", HELICAL, (*QUICK, ROUGH, FOUR)),
    Case("window", HELICAL, (*QUICK, SMOOTH, FOUR)),
    Case("deflected-flanks", HELICAL, (*QUICK, ROUGH, FOUR)),
    Case("coarse-body", HELICAL, (*QUICK, SMOOTH, FOUR)),
    Case("two-level", HELICAL, ("mesh.level=standard", *PLAIN, SMOOTH, FOUR)),
    Case("reuse", HELICAL, (*QUICK, ROUGH, FOUR)),
    Case("error-bars", HELICAL, (*QUICK, SMOOTH, FOUR)),
    Case("fields", SPUR, (*QUICK, SMOOTH)),
    Case("pictures", SPUR, (*QUICK, SMOOTH)),
)
"""One a skip. The one-sector row is in 2D: all teeth of the helical gears would not fit into a computer."""


@dataclass(frozen=True)
class SkipRow:
    """A scene with a skip and without."""

    skip: str
    scene: str
    settings: str
    seconds: float
    """Wall time with the skip; `long_seconds` without."""
    long_seconds: float
    memory_MB: float
    long_memory_MB: float
    difference: float
    """Largest relative one of the results, see `Differences`."""
    tolerance: float
    """That the skip states."""


@dataclass(frozen=True)
class Differences:
    """Largest difference of two runs over their common positions, each over the figure's largest value; the loss is a
    share of the input power as it is."""

    transmission_error: float
    max_pressure: float
    torque_ratio: float
    loss: float

    @property
    def largest(self) -> float:
        """Of all figures."""
        return max(astuple(self))


def rows(cases: Sequence[Case] = CASES) -> Iterator[SkipRow]:
    """Measures each case: minutes a row."""
    for case in cases:
        short, long = summary_of(case), summary_of(case, f"--exact={case.skip}")
        yield SkipRow(
            case.skip, case.scene, " ".join(case.settings), short["timings_s"]["total"], long["timings_s"]["total"],
            short["peak_memory_MB"], long["peak_memory_MB"], differences(short, long).largest,
            skip_named(case.skip).tolerance,
        )


def summary_of(case: Case, *options: str) -> Summary:
    """Runs the scene in a process of its own: its summary.json. Raises CalledProcessError."""
    with tempfile.TemporaryDirectory() as folder:
        command = module_run("evolvent", "run", *run_arguments(case.scene, Path(folder), case.settings, *options))
        subprocess.run(command, cwd=ROOT, env=environment(), check=True, capture_output=True, text=True)
        summary: Summary = json.loads((Path(folder) / "summary.json").read_text(encoding="utf-8"))
    return summary


def differences(one: Summary, other: Summary) -> Differences:
    """Of two summaries. Positions are compared where the teeth stand alike: at the same angle within the pitch."""
    pitch = 360.0 / one["scene"]["pinion"]["teeth"]
    wanted = {_place(row, pitch): row for row in one["positions"]}
    pairs = [(wanted[place], row) for row in other["positions"] if (place := _place(row, pitch)) in wanted]

    def largest(name: str) -> float:
        known = [(a[name], b[name]) for a, b in pairs if a[name] is not None and b[name] is not None]
        return max(abs(a - b) for a, b in known) / max(abs(a) for a, _ in known)

    ratio = max(abs(_torque_ratio(a) / _torque_ratio(b) - 1.0) for a, b in pairs)
    loss = max(abs(a["loss_percent"] - b["loss_percent"]) for a, b in pairs) / 100.0
    return Differences(largest("transmission_error_um"), largest("max_pressure_MPa"), ratio, loss)


def _place(row: dict[str, float], pitch: float) -> tuple[float, float]:
    """(angle within the pitch [°], μ) of a position."""
    return round(row["pinion_angle_deg"] % pitch, 6) % round(pitch, 6), row["friction"]


def _torque_ratio(row: dict[str, float]) -> float:
    return row["torque_gear_Nm"] / row["torque_pinion_Nm"]
