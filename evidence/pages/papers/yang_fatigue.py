"""`python -m evidence.pages.papers.yang_fatigue`: what friction changes below a line contact, for docs/fatigue.md.

`python -m evidence.pages` then writes the page.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from evidence.checkout import DOCS
from evidence.pages.papers import kept
from evidence.pages.papers.kept import Named
from evidence.tables import markdown
from evolvent.strength.fatigue.criteria import (
    dang_van,
    fatemi_socie,
    largest_shear,
    orthogonal_shear_range,
    von_mises,
)
from evolvent.strength.fatigue.half_plane import HertzTractions, plane_strain
from evolvent_meshes.arrays import Floats

KEPT = "fatigue/line_contact.csv"
COMMAND = "python -m evidence.pages.papers.yang_fatigue"
COATED, UNCOATED, RATIO = 0.107, 0.132, 3.15
PEAK, YIELD, SHEAR_MODULUS, POISSON = 1579.0, 900.0, 210e3 / 2.6, 0.3
"""MPa: Hertz at the pitch point of Yang's pair, a case-hardened core's yield stress, steel."""
PRESSURE_FACTOR, NORMAL_FACTOR = 0.3, 1.0
"""a of Dang Van and k of Fatemi and Socie, usual for steels."""
DEPTHS = np.linspace(0.2, 1.4, 49)
"""Half-widths."""
CRITERIA: dict[str, Callable[[Floats], float]] = {
    "orthogonal_shear": orthogonal_shear_range,
    "largest_shear": lambda history: float(largest_shear(history).max()),
    "von_mises": lambda history: float(von_mises(history).max()),
    "dang_van": lambda history: dang_van(history, PRESSURE_FACTOR),
    "fatemi_socie": lambda history: fatemi_socie(history, SHEAR_MODULUS, YIELD, NORMAL_FACTOR),
    "tension": lambda history: float(history[:, 0, 0].max()),
}
WORDS = {
    "orthogonal_shear": "range of orthogonal shear", "largest_shear": "largest shear", "von_mises": "von Mises",
    "dang_van": f"Dang Van, a = {PRESSURE_FACTOR:g}", "fatemi_socie": f"Fatemi-Socie, k = {NORMAL_FACTOR:g}",
    "tension": "tension along the flank",
}  # fmt: skip


def figures() -> Named:
    """(name, value): each criterion at the surface and largest below it, uncoated over coated."""
    x = np.linspace(-5.0, 5.0, 1601)
    for name, criterion in CRITERIA.items():
        found = {}
        for μ in (COATED, UNCOATED):
            loads = HertzTractions(1.0, PEAK, μ)
            at = [criterion(plane_strain(loads.stress(x, np.full_like(x, z)), POISSON)) for z in (0.0, *DEPTHS)]
            found[μ] = at[0], max(at[1:])
        for place, index in (("surface", 0), ("below", 1)):
            # tension below the surface is small, whatever it changes by
            if found[COATED][index] > 0.0 and (name, place) != ("tension", "below"):
                yield f"{name}_{place}", found[UNCOATED][index] / found[COATED][index]


def table(docs: Path) -> str:
    """Change of each criterion, and the exponent that would make the paper's ratio of it."""
    f = kept.kept(docs / KEPT, COMMAND)
    rows = []
    for name, words in WORDS.items():
        cells = [words]
        for place in ("surface", "below"):
            ratio = f.get(f"{name}_{place}")
            cells += ["–", "–"] if ratio is None else [f"{100.0 * (ratio - 1.0):+.1f} %", _exponent(ratio)]
        rows.append(tuple(cells))
    head = ("criterion", "at the surface", "exponent for 3.15", "below, 0.2 to 1.4 half-widths", "exponent for 3.15")
    return markdown(head, rows)


def _exponent(ratio: float) -> str:
    if ratio <= 1.0 + 1e-3:
        return "none"
    return f"{math.log(RATIO) / math.log(ratio):.3g}"


if __name__ == "__main__":
    print(kept.keep(DOCS / KEPT, figures()))
