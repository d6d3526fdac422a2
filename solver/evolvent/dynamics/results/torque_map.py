"""Table of a pair's vibration over speed and torque."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.pair_model import Drive
from evolvent.dynamics.results.response import UM, responses
from evolvent.results.tables.table import Table


@dataclass(frozen=True)
class MapRow:
    """A line of torque_map.csv: a speed, run up to or down to under a torque."""

    torque_Nm: float
    """Torque on the gear that the scene names."""
    natural_speed_rpm: float
    """Speed of the pinion at which the mesh frequency is the natural frequency at the mean stiffness in motion under
    this torque."""
    speed_rpm: float
    """Speed of the pinion."""
    way: str
    """Direction in which the pair has come to the speed: up or down, as in response.csv."""
    repeats: int
    """Mesh periods after which the motion repeats; 0 where it does not within sixteen."""
    equivalent_amplitude_um: float
    """√ΣA_r² of the first three mesh harmonics of s, as in response.csv."""
    elastic_equivalent_amplitude_um: float
    """√ΣA_r² of the first three mesh harmonics of s − e, as in response.csv."""
    largest_force_N: float
    """Largest mesh force, damping included, as in response.csv."""
    dynamic_factor: float
    """Largest mesh force over the static one under this torque."""
    separated_share: float
    """Share of the time in which no flanks touch."""
    back_contact_share: float
    """Share of the time in which the back flanks touch."""
    bodies: str
    """elastic or rigid gear bodies, as in dynamics.json."""


TORQUE_MAP = Table("torque_map.csv", MapRow)


def map_rows(torque: float, drive: Drive, swept: SpeedSweep) -> Iterator[MapRow]:
    """Rows of torque_map.csv under one torque [N·m]: up, then down, at ascending speeds."""
    found = responses(drive, swept)
    for way, runs in (("up", swept.up), ("down", swept.down)):
        for period, run, each in zip(swept.periods, runs, found[way]):
            yield MapRow(
                torque_Nm=torque, natural_speed_rpm=drive.natural_speed,
                speed_rpm=MeshSpeed.of_period(period, drive.teeth).rpm, way=way, repeats=run.repeats,
                equivalent_amplitude_um=UM * each.equivalent_amplitude,
                elastic_equivalent_amplitude_um=UM * each.elastic_equivalent_amplitude,
                largest_force_N=each.largest_force, dynamic_factor=each.largest_force / drive.model.load,
                separated_share=each.separated_share, back_contact_share=each.back_contact_share,
                bodies=drive.settings.bodies_named,
            )
