"""Key figures of fatigue.csv in words, a line for each friction coefficient."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.strength.fatigue.criterion import BELOW, CONTACT_PRESSURE, DANG_VAN, MAXIMUM_SHEAR, NEAR_SURFACE, SURFACE
from evolvent.strength.results.fatigue_rows import FATIGUE, FatigueRow
from evolvent_meshes.gears.member import Member

SHOWN = (
    (CONTACT_PRESSURE, SURFACE, "contact pressure"),
    (MAXIMUM_SHEAR, BELOW, "maximum shear stress"),
    *((DANG_VAN, place, "Dang Van") for place in (*NEAR_SURFACE, BELOW)),
)
"""Criterion, place and name of each value that is printed."""
FLAGS = {
    "at_zone_end": "beside the zone of a tip edge",
    "near_friction_reversal": "where friction reverses, so that the stress history does not hold",
    "at_depth_limit": "no maximum over the depth, at the first or last one from 0.2 half-widths down",
}
"""Column that marks values which do not hold -> words."""
NOTHING = (
    "nothing evaluated: wanted contact between the tip-edge zones, found none at these positions; take more of them "
    "(sweep.positions), or a pair with a longer path of contact"
)


def fatigue_lines(folder: Path) -> Iterator[str]:
    """The largest values on the pinion with their error bars, and their changes over the first friction coefficient at
    the points of the flank, in the median, from the folder's table; and which of them do not hold."""
    rows = [row for row in FATIGUE.read(folder) if row.gear == Member.PINION.label]
    known = {(row.friction, row.criterion, row.place): row for row in rows if not math.isnan(row.value)}
    frictions = list(dict.fromkeys(row.friction for row in rows))
    for friction in frictions:
        changed = friction != frictions[0]
        shown = [
            (name, _with_flags(row, changed))
            for criterion, place, name in SHOWN
            if (row := known.get((friction, criterion.name, place))) is not None
        ]
        parts = [f"{_named(name, row, changed)} {_value(row, changed)}" for name, row in shown]
        found = [", ".join(parts), *_flags(shown, changed)] if parts else [NOTHING]
        yield f"μ = {friction:g}: {'; '.join(found)}"


def _with_flags(row: FatigueRow, changed: bool) -> FatigueRow:
    """A row with the flags of the point that is printed. changed: whether the point of comparison is printed."""
    if not _at_point(row, changed):
        return row
    return replace(
        row, at_zone_end=row.point_at_zone_end, near_friction_reversal=row.point_near_friction_reversal
    )


def _named(name: str, row: FatigueRow, changed: bool) -> str:
    """Name of a value with its depth, where its criterion has one. changed: as of `_value`."""
    if row.criterion == CONTACT_PRESSURE.name:
        return name
    depth = row.point_depth_um if _at_point(row, changed) else row.depth_um
    return f"{name} " + ("at the surface" if row.place == SURFACE else f"{depth:.3g} µm deep")


def _value(row: FatigueRow, changed: bool) -> str:
    """A value with its error bar. changed: print the value at the point of the flank where it is largest at the first
    coefficient, with its change there and in the median over points, where they are known."""
    at_point = _at_point(row, changed)
    value = plus_minus(row.point_value if at_point else row.value, row.value_error, 0)
    there = [f"{row.change_percent:+.1f} % at this point"] if at_point else []
    known = changed and not math.isnan(row.change_at_points_percent)
    median = [f"{row.change_at_points_percent:+.1f} % in the median"] if known else []
    return f"{value} {row.unit}" + (f" ({', '.join([*there, *median])})" if there or median else "")


def _at_point(row: FatigueRow, changed: bool) -> bool:
    """Whether a row has a value at the point at which friction coefficients are compared, and that is to be printed."""
    return changed and not math.isnan(row.change_percent)


def _flags(shown: Sequence[tuple[str, FatigueRow]], changed: bool) -> Iterator[str]:
    """Notes on values that do not hold where they lie. changed: as of `_value`."""
    for column, words in FLAGS.items():
        flagged = [_named(name, row, changed) for name, row in shown if getattr(row, column)]
        if flagged:
            yield f"{words}: {'all of these' if len(flagged) == len(shown) else ', '.join(flagged)}"
