"""Table of a pair's vibration over speed and torque."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass

from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.pair_model import Drive
from evolvent.dynamics.results.response import UM, responses, speed_of
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.tables import csv_text

TORQUE_MAP = "torque_map.csv"


@dataclass(frozen=True)
class MapRow:
    """A line of torque_map.csv: a speed, run up to or down to under a torque."""

    torque_Nm: float
    """On the gear that the scene names."""
    natural_speed_rpm: float
    """Of the pinion, at which the mesh frequency is the natural one at the mean tangent stiffness under this torque."""
    speed_rpm: float
    """Of the pinion."""
    way: str
    """up or down, as in response.csv."""
    repeats: int
    """Mesh periods after which the motion repeats; 0 where it does not within sixteen."""
    equivalent_amplitude_um: float
    """As in response.csv, like the next three."""
    elastic_equivalent_amplitude_um: float
    """Of s − e."""
    largest_force_N: float
    """Largest mesh force."""
    dynamic_factor: float
    """Largest mesh force over the static one under this torque."""
    separated_share: float
    """Share of the time in which no flanks touch."""
    back_contact_share: float
    """Share of the time in which the back flanks touch."""


def map_rows(torque: float, drive: Drive, swept: SpeedSweep) -> Iterator[MapRow]:
    """Under one torque [N·m]: up, then down, at ascending speeds."""
    found = responses(drive, swept)
    for way, runs in (("up", swept.up), ("down", swept.down)):
        for period, run, each in zip(swept.periods, runs, found[way]):
            yield MapRow(
                torque, drive.natural_speed, speed_of(drive, float(period)), way, run.repeats,
                UM * each.equivalent_amplitude, UM * each.elastic_equivalent_amplitude, each.largest_force,
                each.largest_force / drive.model.load, each.apart, each.behind,
            )


def write_torque_map(folder: RunFolder, rows: Iterable[MapRow]) -> None:
    """Writes torque_map.csv. Raises WriteError, FolderError."""
    folder.write_text(TORQUE_MAP, csv_text([asdict(row) for row in rows]))
