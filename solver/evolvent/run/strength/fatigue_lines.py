"""What a reader looks for first in fatigue.csv, a line a friction coefficient."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.strength.fatigue.criterion import BELOW, CONTACT_PRESSURE, DANG_VAN, MAXIMUM_SHEAR, NEAR, SURFACE
from evolvent.strength.results.fatigue_rows import FATIGUE
from evolvent_meshes.gears.member import Member

SHOWN = (
    (CONTACT_PRESSURE, SURFACE, "contact pressure"),
    (MAXIMUM_SHEAR, BELOW, "maximum shear stress below the surface"),
    (DANG_VAN, NEAR, "Dang Van near the surface"),
)
"""Criterion, place, name."""


def fatigue_lines(folder: Path) -> Iterator[str]:
    """The largest values on the pinion with their error bars, and their changes over the first friction coefficient at
    the points of the flank, in the median, from the folder's table."""
    with open(folder / FATIGUE, encoding="utf-8") as stream:
        rows = [row for row in csv.DictReader(stream) if row["gear"] == Member.PINION.label]
    frictions = list(dict.fromkeys(row["friction"] for row in rows))
    for friction in frictions:
        parts = []
        for criterion, place, name in SHOWN:
            known = (friction, criterion.name, place)
            for row in rows:
                if (row["friction"], row["criterion"], row["place"]) == known:
                    value = plus_minus(float(row["value"]), float(row["value_error"] or "nan"), 0)
                    more = "" if friction == frictions[0] else f" ({float(row['change_at_points_percent']):+.1f} %)"
                    parts.append(f"{name} {value} {row['unit']}{more}")
        yield f"μ = {float(friction):g}: {', '.join(parts)}"
