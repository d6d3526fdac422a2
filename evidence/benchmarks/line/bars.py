"""What rows of line contact beside the resolved contact are beyond their bars, in words for docs/line_contact.md."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

PEAK_BAR_PERCENT, PEAK_BAR_UM = 1.0, 0.02
"""Bars of the peak-to-peak transmission error, of which the larger one counts."""


class PeakToPeak(Protocol):
    """Row of a table with a peak-to-peak transmission error and its deviation."""

    @property
    def peak_to_peak_um(self) -> float: ...
    @property
    def peak_to_peak_off_um(self) -> float: ...


def beyond_bars(rows: Sequence[PeakToPeak], bars: Sequence[tuple[str, str, float]]) -> str:
    """Words on the deviations of rows beyond their bars: of peak to peak, and of some figures with columns and bars."""
    peaks = [(abs(row.peak_to_peak_off_um), row.peak_to_peak_um) for row in rows]
    off = [100.0 * by / whole if by > PEAK_BAR_UM else 0.0 for by, whole in peaks]
    parts = [_part("peak to peak", off, PEAK_BAR_PERCENT)]
    parts += [_part(name, [abs(getattr(row, column)) for row in rows], bar) for name, column, bar in bars]
    return "; ".join(filter(None, parts))


def _part(name: str, off: list[float], bar: float) -> str:
    """Words on the deviations [%] beyond a bar; empty where there is none."""
    over = [each for each in off if each > bar]
    return f"{name} {len(over)}, by up to {max(over):.2g} for {bar:g} %" if over else ""
