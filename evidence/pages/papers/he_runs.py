"""The runs of He's pair that docs/he2022.md tells of, as processes, and their tables."""

from __future__ import annotations

import csv
import json
import math
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evidence.checkout import ROOT
from evidence.pages.papers.kept_runs.kept import Named
from evidence.processes import Command, module_run, run
from evolvent.scene.scene import Scene
from evolvent_meshes.arrays import Floats

COMMAND = "python -m evidence.pages.papers.he_figures --out DIR"
VIBRATION, WEAR = "demos/he2022_dynamics.toml", "demos/he2022_wear.toml"
TIME_LIMIT = 3600.0  # s
RIGID = 'dynamics.bodies="rigid"'
SURFACE = "surface"
"""Name of the run whose contact other ones over the speed go on from."""
PAPER_RPM = 3500.0
"""Measured resonance."""
FEW = "sweep.positions=10", "dynamics.speeds=40", "mesh.level=quick", "dynamics.torque_percents=[25,100,200]"
"""Settings with which the runs take seconds."""


@dataclass(frozen=True)
class HeRuns:
    """Where the runs go, and how many positions and speeds they have."""

    out: Path
    """A folder for each."""
    settings: tuple[str, ...] = ()
    """Of all of them, behind their own."""

    def run(self, command: str, name: str, scene: str | Path, *settings: str, after: str = "") -> Path:
        """`evolvent COMMAND SCENE --out OUT/name`, without error bars; what an earlier call has solved there is gone on
        from. after: a run of the same contact, from whose positions a new one goes on. Raises RunFailed."""
        self.out.mkdir(parents=True, exist_ok=True)
        folder = self.out / name
        if after and not folder.exists():
            shutil.copytree(self.out / after, folder)
        set_to = [f"--set={setting}" for setting in ("output.error_bars=false", *settings, *self.settings)]
        go_on = "--resume" if (folder / "results").exists() else "--overwrite"
        words = module_run("evolvent", command, scene, "--out", folder, "--quiet", go_on, *set_to)
        run(Command(words, ROOT, self.out / f"{name}.log", time_limit=TIME_LIMIT))
        return folder

    def vibration(self, name: str, *settings: str) -> Vibration:
        """The unworn pair over the speed, on the contact of the run `SURFACE`."""
        return Vibration.read(self.run("dynamics", name, VIBRATION, *settings, after=SURFACE))


@dataclass(frozen=True, eq=False)
class Vibration:
    """What `evolvent dynamics` has written."""

    facts: dict[str, Any]
    """dynamics.json."""
    rows: list[dict[str, str]]
    """response.csv."""
    histories: list[dict[str, str]]
    """histories.csv; empty where no speed asks for it."""

    @staticmethod
    def read(folder: Path) -> Vibration:
        """From its folder."""
        path = folder / "histories.csv"
        histories = read_csv(path) if path.exists() else []
        return Vibration(read_json(folder / "dynamics.json"), read_csv(folder / "response.csv"), histories)

    def motion(self, speed: float, way: str) -> dict[str, Floats]:
        """Numbers of a motion over time: name of the column -> (n,). speed: [r/min], of those with histories."""
        own = [row for row in self.histories if (float(row["speed_rpm"]), row["way"]) == (speed, way)]
        names = "phase", "transmission_error_um", "force_N", "contact"
        return {name: np.array([float(row[name]) for row in own]) for name in names}

    def over_speed(self, name: str, way: str) -> Floats:
        """A column running up, or down."""
        return np.array([float(row[name]) for row in self.rows if row["way"] == way])

    def at(self, name: str, speed: float) -> float:
        """A column running up at one of the speeds [r/min]."""
        return float(self.over_speed(name, "up")[self.over_speed("speed_rpm", "up") == speed][0])

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

    def figures(self, name: str) -> Named:
        """Natural speed, jumps (the fastest and how many), superharmonics by the order of s that resonates, running
        up."""
        natural = float(self.facts["natural_speed_rpm"])
        yield f"{name}_natural_rpm", natural
        for way in ("up", "down"):
            jumps = self.facts[f"jumps_{way}_rpm"]
            yield f"{name}_jump_{way}_rpm", float(max(jumps, default=math.nan))
            yield f"{name}_jumps_{way}", float(len(jumps))
        yield f"{name}_amplitude_um", self.largest("equivalent_amplitude_um")
        yield f"{name}_force_ratio", self.largest("dynamic_factor")
        yield f"{name}_separated_percent", 100.0 * self.largest("separated_share")
        share = self.facts["heaviest_torque_share"]
        yield f"{name}_heaviest_torque_share", math.nan if share is None else share
        for order in (2, 3, 4):
            at = self.peak(f"harmonic_{order}_um", 0.85 * natural / order, 1.15 * natural / order)
            yield f"{name}_order_{order}_rpm", at
            yield f"{name}_order_{order}_off_percent", 100.0 * (at * order / natural - 1.0)


def natural_square(scene: Scene) -> float:
    """ω² [1/s²] at which the natural speed is the paper's."""
    return (2.0 * math.pi * PAPER_RPM * scene.pinion.teeth / 60.0) ** 2


def in_series(wanted: float, stiffness: float) -> float:
    """The stiffness which, in series with another one, makes it a wanted one, all in the same unit."""
    return 1.0 / (1.0 / wanted - 1.0 / stiffness)


def series_setting(stiffness: float) -> str:
    """Setting of a stiffness in series with the mesh [N/µm]."""
    return f"dynamics.series_stiffness_N_per_um={stiffness:.6g}"


def read_json(path: Path) -> dict[str, Any]:
    """An object."""
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


def read_csv(path: Path) -> list[dict[str, str]]:
    """Its rows."""
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))
