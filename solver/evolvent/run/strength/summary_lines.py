"""What a reader looks for first in strength.csv, a line a gear."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from evolvent.strength.results.tables import COMPRESSION, STANDARD, STRENGTH, TENSION
from evolvent_meshes.gears.member import Member

Row = Mapping[str, str]


def summary_lines(folder: Path) -> Iterator[str]:
    """Stresses by the standard and by finite elements, of the latter with their error bars and, with the load at the
    outer point of single or double contact, with the share of the tooth and with all of it, from the folder's table."""
    with open(folder / STRENGTH, encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    for member in Member:
        own = [row for row in rows if row["gear"] == member.label]
        yield f"{member.label}: {'; '.join([*_of_standard(own), *_of_elements(own)])}"


def _of_standard(rows: Iterable[Row]) -> Iterator[str]:
    for row in rows:
        if row["method"].startswith(STANDARD):
            yield f"{row['method']} {float(row['stress_MPa']):.0f} MPa"


def _of_elements(rows: Iterable[Row]) -> Iterator[str]:
    for row in rows:
        if row["method"] in (TENSION, COMPRESSION):
            stress, error = float(row["stress_MPa"]), float(row["stress_MPa_error"])
            bar = "" if math.isnan(error) else f" ± {error:.0f}"
            yield f"{row['method']} {stress:.0f}{bar} MPa (μ = {float(row['friction']):g})"
        elif row["method"].startswith(f"{TENSION}, "):
            share, whole = 100.0 * float(row["load_share"]), float(row["whole_load_MPa"])
            point, stress = row["method"].removeprefix(f"{TENSION}, "), float(row["stress_MPa"])
            yield f"at the {point} {stress:.0f} MPa under {share:.0f} % of the load, {whole:.0f} MPa under all of it"
