"""Table of a pair's spectrum over the speed: the lines of its mesh force and of its transmission error."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.oscillator.response import Response
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.pair_model import Drive
from evolvent.dynamics.results.response import UM
from evolvent.results.tables.table import Table


@dataclass(frozen=True)
class SpectrumRow:
    """A line of spectrum.csv: a line of the spectrum at a speed."""

    speed_rpm: float
    """Speed of the pinion."""
    way: str
    """Direction in which the pair has come to the speed: up or down, as in response.csv."""
    order: float
    """Frequency over that of the mesh: whole up to 8; halves of a motion that repeats after two meshes, and so on. One
    that does not repeat has lines a sixteenth apart, of sixteen mesh periods without a window."""
    frequency_Hz: float
    """Frequency of the line: order times speed of the pinion times its number of teeth."""
    force_N: float
    """Amplitude of the mesh force, damping included."""
    transmission_error_um: float
    """Amplitude of s, the dynamic transmission error with the unloaded one in it."""


SPECTRUM = Table("spectrum.csv", SpectrumRow)


def spectrum_rows(drive: Drive, swept: SpeedSweep, found: dict[str, list[Response]]) -> Iterator[SpectrumRow]:
    """Rows of spectrum.csv: up, then down, at ascending speeds, each with ascending orders."""
    for way, responses in found.items():
        for period, each in zip(swept.periods, responses, strict=True):
            speed, lines = MeshSpeed.of_period(period, drive.teeth).rpm, each.spectrum
            for order, force, total in zip(lines.orders, lines.force, lines.total):
                yield SpectrumRow(
                    speed_rpm=speed, way=way, order=float(order), frequency_Hz=float(order / period),
                    force_N=float(force), transmission_error_um=UM * float(total),
                )
