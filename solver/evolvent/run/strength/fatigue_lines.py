"""What a reader looks for first in fatigue.csv, a line a friction coefficient."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.strength.fatigue.criterion import BELOW, CONTACT_PRESSURE, DANG_VAN, MAXIMUM_SHEAR, NEAR_SURFACE, SURFACE
from evolvent.strength.results.fatigue_rows import FATIGUE
from evolvent_meshes.gears.member import Member

SHOWN = (
    (CONTACT_PRESSURE, SURFACE, "contact pressure"),
    (MAXIMUM_SHEAR, BELOW, "maximum shear stress"),
    *((DANG_VAN, place, "Dang Van") for place in (*NEAR_SURFACE, BELOW)),
)
"""Criterion, place, name."""
FLAGS = {
    "at_zone_end": "beside the zone of a tip edge",
    "near_friction_reversal": "where friction reverses, so that the stress history does not hold",
    "at_depth_limit": "no maximum over the depth, at the first or last one from 0.2 half-widths down",
}
"""Column that says where a value does not hold -> words."""
NOTHING = (
    "nothing evaluated: wanted contact between the tip-edge zones, found none at these positions; take more of them "
    "(sweep.positions), or a pair with a longer path of contact"
)
Row = dict[str, str]


def fatigue_lines(folder: Path) -> Iterator[str]:
    """The largest values on the pinion with their error bars, and their changes over the first friction coefficient at
    the points of the flank, in the median, from the folder's table; and which of them do not hold."""
    with open(folder / FATIGUE, encoding="utf-8") as stream:
        rows = [row for row in csv.DictReader(stream) if row["gear"] == Member.PINION.label]
    known = {(row["friction"], row["criterion"], row["place"]): row for row in rows if _is_known(row["value"])}
    frictions = list(dict.fromkeys(row["friction"] for row in rows))
    for friction in frictions:
        shown = [
            (name, known[friction, criterion.name, place])
            for criterion, place, name in SHOWN
            if (friction, criterion.name, place) in known
        ]
        parts = [f"{_named(name, row)} {_value(row, friction != frictions[0])}" for name, row in shown]
        found = [", ".join(parts), *_flags(shown)] if parts else [NOTHING]
        yield f"μ = {float(friction):g}: {'; '.join(found)}"


def _is_known(text: str) -> bool:
    """Whether a number of the table is one."""
    return not math.isnan(float(text))


def _named(name: str, row: Row) -> str:
    """With the depth, where a criterion has one."""
    if row["criterion"] == CONTACT_PRESSURE.name:
        return name
    return f"{name} " + ("at the surface" if row["place"] == SURFACE else f"{float(row['depth_um']):.3g} µm deep")


def _value(row: Row, changed: bool) -> str:
    """With its error bar. changed: with its change too, where it is known."""
    value = plus_minus(float(row["value"]), float(row["value_error"] or "nan"), 0)
    changed &= _is_known(row["change_at_points_percent"])
    change = f" ({float(row['change_at_points_percent']):+.1f} %)" if changed else ""
    return f"{value} {row['unit']}{change}"


def _flags(shown: Sequence[tuple[str, Row]]) -> Iterator[str]:
    """Which values lie where they do not hold."""
    for column, words in FLAGS.items():
        flagged = [_named(name, row) for name, row in shown if row[column] == str(True)]
        if flagged:
            yield f"{words}: {'all of these' if len(flagged) == len(shown) else ', '.join(flagged)}"
