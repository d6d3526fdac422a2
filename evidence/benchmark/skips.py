"""What each skip saves: the same scene run with and without it, and by how much the answers differ.

Every run is a process of its own, so that its largest memory is its own; seconds are the run's, all parts.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from evidence.checkout import ROOT
from evolvent.scene.schema.output import SkipName
from evolvent.scene.skips import skip_named

SPUR, HELICAL = "demos/he2022.toml", "demos/yang2022.toml"
QUICK = (
    "mesh.level=quick", "output.pictures=false", "output.animation=false", "output.fields=false",
    "output.error_bars=false",
)  # fmt: skip
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
    Case("reuse", HELICAL, (*QUICK, ROUGH, FOUR)),
    Case("error-bars", HELICAL, (*QUICK, SMOOTH, FOUR)),
    Case("fields", SPUR, (*QUICK, SMOOTH)),
    Case("pictures", SPUR, (*QUICK, SMOOTH)),
)
"""One a skip. The one-sector row is in 2D: all teeth of the helical gears would not fit into a computer."""


@dataclass(frozen=True)
class Cost:
    """What a run took: wall and processor seconds, largest memory [MB], degrees of freedom of both sectors."""

    seconds: float
    processor_seconds: float
    memory_MB: float
    dofs: int


@dataclass(frozen=True)
class SkipRow:
    """A scene with a skip and without: wall seconds, memory [MB], largest relative difference of the answers, see
    `differences`, and what the skip states."""

    skip: str
    scene: str
    settings: str
    seconds: float
    long_seconds: float
    memory_MB: float
    long_memory_MB: float
    difference: float
    tolerance: float


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
        return max(self.transmission_error, self.max_pressure, self.torque_ratio, self.loss)


def rows(cases: Sequence[Case] = CASES) -> Iterator[SkipRow]:
    """Measures each case: minutes a row."""
    for case in cases:
        short, one = measured(case.scene, case.settings)
        long, other = measured(case.scene, case.settings, case.skip)
        yield SkipRow(
            case.skip, case.scene, " ".join(case.settings), short.seconds, long.seconds, short.memory_MB,
            long.memory_MB, differences(one, other).largest, skip_named(case.skip).tolerance,
        )  # fmt: skip


def measured(scene: str, settings: Sequence[str], *no_skip: SkipName) -> tuple[Cost, Summary]:
    """Runs a scene in a process of its own: what it took, and its summary. Raises CalledProcessError."""
    options = [f"--set={setting}" for setting in settings] + [f"--no-skip={name}" for name in no_skip]
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "evolvent", "run", scene, "--out", folder, "--quiet", *options]
        before = _processor_seconds()
        subprocess.run(command, cwd=ROOT, env=_environment(), check=True, capture_output=True, text=True)
        used = _processor_seconds() - before
        summary: Summary = json.loads((Path(folder) / "summary.json").read_text(encoding="utf-8"))
    return Cost(summary["timings_s"]["total"], used, summary["peak_memory_MB"], summary["dofs"]), summary


def _processor_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _environment() -> dict[str, str]:
    """One thread unless the caller wants more: threads of BLAS are another figure of the benchmark."""
    return {"OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg", **os.environ}


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
