"""Key figures of strength.csv in words, a line for each gear."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from pathlib import Path

from evolvent.strength.results.tables import COMPRESSION, STANDARD, STRENGTH, TENSION, StrengthRow
from evolvent_meshes.gears.member import Member


def summary_lines(folder: Path) -> Iterator[str]:
    """Stresses by the standard and by finite elements, of the latter with their error bars and, with the load at the
    outer point of single or double contact, with the share of the tooth and with all of it, from the folder's table."""
    rows = STRENGTH.read(folder)
    for member in Member:
        own = [row for row in rows if row.gear == member.label]
        yield f"{member.label}: {'; '.join([*_of_standard(own), *_of_elements(own)])}"


def _of_standard(rows: Iterable[StrengthRow]) -> Iterator[str]:
    for row in rows:
        if row.method.startswith(STANDARD):
            yield f"{row.method} {row.stress_MPa:.0f} MPa"


def _of_elements(rows: Iterable[StrengthRow]) -> Iterator[str]:
    for row in rows:
        if row.method in (TENSION, COMPRESSION):
            stress, error = row.stress_MPa, row.stress_MPa_error
            bar = "" if math.isnan(error) else f" ± {error:.0f}"
            yield f"{row.method} {stress:.0f}{bar} MPa (μ = {row.friction:g})"
        elif row.method.startswith(f"{TENSION}, "):
            share, whole = 100.0 * row.load_share, row.whole_load_MPa
            point, stress = row.method.removeprefix(f"{TENSION}, "), row.stress_MPa
            yield f"at the {point} {stress:.0f} MPa under {share:.0f} % of the load, {whole:.0f} MPa under all of it"
