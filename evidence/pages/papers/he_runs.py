"""The runs of He's pair that docs/he2022.md tells of, as processes, and their tables."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evidence.checkout import ROOT
from evidence.processes import Command, module_run, run
from evolvent_meshes.arrays import Floats

VIBRATION, WEAR = "demos/he2022_dynamics.toml", "demos/he2022_wear.toml"
TIME_LIMIT = 3600.0  # s
FEW = "sweep.positions=10", "dynamics.speeds=40", "mesh.level=quick", "dynamics.torque_percents=[25,100,200]"
"""Settings with which the runs take seconds."""


@dataclass(frozen=True)
class HeRuns:
    """Where the runs go, and how many positions and speeds they have."""

    out: Path
    """A folder for each."""
    settings: tuple[str, ...] = ()
    """Of all of them, behind their own."""

    def run(self, command: str, name: str, scene: str | Path, *settings: str) -> Path:
        """`evolvent COMMAND SCENE --out OUT/name`, without error bars; what an earlier call has solved there is gone on
        from. Raises RunFailed."""
        self.out.mkdir(parents=True, exist_ok=True)
        folder = self.out / name
        set_to = [f"--set={setting}" for setting in ("output.error_bars=false", *settings, *self.settings)]
        go_on = "--resume" if (folder / "results").exists() else "--overwrite"
        words = module_run("evolvent", command, scene, "--out", folder, "--quiet", go_on, *set_to)
        run(Command(words, ROOT, self.out / f"{name}.log", time_limit=TIME_LIMIT))
        return folder


@dataclass(frozen=True, eq=False)
class Vibration:
    """What `evolvent dynamics` has written."""

    facts: dict[str, Any]
    """dynamics.json."""
    rows: list[dict[str, str]]
    """response.csv."""

    @staticmethod
    def read(folder: Path) -> Vibration:
        """From its folder."""
        return Vibration(read_json(folder / "dynamics.json"), read_csv(folder / "response.csv"))

    def over_speed(self, name: str, way: str) -> Floats:
        """A column running up, or down."""
        return np.array([float(row[name]) for row in self.rows if row["way"] == way])

    def largest(self, name: str) -> float:
        """Of a column, both ways."""
        return max(float(self.over_speed(name, way).max()) for way in ("up", "down"))

    def peak(self, name: str, low: float, high: float, way: str = "up") -> float:
        """The speed between two [r/min] at which a column is largest; NaN where that is at an end: no peak."""
        speed, values = self.over_speed("speed_rpm", way), self.over_speed(name, way)
        inside = np.flatnonzero((speed > low) & (speed < high))
        if len(inside) < 3 or (at := int(np.argmax(values[inside]))) in (0, len(inside) - 1):
            return float("nan")
        return float(speed[inside][at])


def read_json(path: Path) -> dict[str, Any]:
    """An object."""
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


def read_csv(path: Path) -> list[dict[str, str]]:
    """Its rows."""
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))
