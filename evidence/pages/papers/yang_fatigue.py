"""`python -m evidence.pages.papers.yang_fatigue --out DIR`: what friction changes of fatigue, for docs/fatigue.md.

Below a line contact of the same pressure; of Yang's pair from its contact solution; and how far fitted half-ellipses
stand for the pressures as solved, over the elements across the contact. Runs that an earlier call has ended are read
again. `python -m evidence.pages` then writes the page.
"""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from shutil import copy

import numpy as np

from evidence.checkout import DEMOS, DOCS
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evidence.pages.papers.kept_runs.runs import Runs, keep_figures, read
from evidence.processes import module_run
from evidence.tables import markdown
from evolvent.fem.material import Material, contact_modulus
from evolvent.scene.scene import load_scene
from evolvent.strength.fatigue.criterion import (
    CONTACT_PRESSURE,
    DANG_VAN,
    FATEMI_SOCIE,
    MAXIMUM_SHEAR,
    ORTHOGONAL_SHEAR,
    SURFACE,
    TENSION,
    VON_MISES,
    Criterion,
)
from evolvent.strength.fatigue.flank_fatigue import FatigueMaterial, FlankFatigue, flank_fatigue
from evolvent.strength.fatigue.flank_loads import FlankLoads
from evolvent.strength.results.friction_fatigue import changes

KEPT, PICTURE = "fatigue/friction.csv", "fatigue/yang.png"
COMMAND = "python -m evidence.pages.papers.yang_fatigue --out DIR"
UNCOATED, COATED, RATIO = 0.132, 0.107, 3.15
PEAK, STEEL = 1579.0, FatigueMaterial(0.3, 210e3 / 2.6, 2000.0, 0.3, 0.0, 1.0)
"""MPa: Hertz at the pitch point of Yang's pair. The paper has 20MnCrS5 (section 3.3), and neither treatment, hardness
nor yield stress: this is a hardened case."""
BULK = Material(210e3, 0.3)
DEPTHS = (0.0, 0.01, 0.02, 0.05, 0.1, 0.15, *np.linspace(0.2, 1.4, 25))
"""Half-widths."""
CRITERIA = CONTACT_PRESSURE, ORTHOGONAL_SHEAR, MAXIMUM_SHEAR, VON_MISES, DANG_VAN, FATEMI_SOCIE, TENSION
PAIR = "contact.friction=[0.132,0.107]", "fatigue.yield_stress_MPa=2000"
LEVELS = "quick", "standard", "fine"
COLUMNS = {"pair": "change_percent", "points": "change_at_points_percent"}
"""Of the largest values on the pinion, and the median at its points."""
Figures = dict[str, float]
CONSTANT = "dang_van_constant"
"""Dang Van's shear amplitude alone, as on a locus that is constant below a third of the fatigue limit in bending."""


def figures(runs: Runs) -> Named:
    """(name, value) of each figure. Raises RunFailed."""
    yield from _line_contact()
    yield from _pair(runs)
    yield from _fitted(runs)


def _line_contact() -> Named:
    """Uncoated over coated, below a line contact of the same pressure, and where it is largest uncoated."""
    pair = load_scene(DEMOS / "yang2022.toml").gear_pair()
    half_width = 2.0 * PEAK * float(pair.relative_curvature_radius(np.zeros(1))[0]) / contact_modulus(*2 * (BULK,))
    coated, uncoated = (_below_line(μ) for μ in (COATED, UNCOATED))
    for criterion in CRITERIA[1:]:
        for place in criterion.places:
            yield f"line_{criterion.name}_{place}", changes(uncoated, coated, criterion, place)[0]
            at = np.where(uncoated.at(place), uncoated.values[criterion][0], -1.0)
            yield f"line_{criterion.name}_{place}_um", 1e3 * half_width * DEPTHS[int(np.argmax(at))]
    coated, uncoated = (_below_line(μ, replace(STEEL, tension_factor=0.0)) for μ in (COATED, UNCOATED))
    for place in DANG_VAN.places:
        yield f"line_{CONSTANT}_{place}", changes(uncoated, coated, DANG_VAN, place)[0]


def _below_line(friction: float, steel: FatigueMaterial = STEEL) -> FlankFatigue:
    one = np.ones(1)
    loads = FlankLoads(np.zeros((1, 3), dtype=int), 0.0 * one, 0.0 * one, PEAK * one, one, friction * one)
    return flank_fatigue(loads, friction, DEPTHS, steel)


def _pair(runs: Runs) -> Named:
    """Uncoated over coated on the pinion of Yang's pair: of the largest values, and the median at its points."""
    folder = _fatigue(runs, "yang", "yang2022.toml", "output.error_bars=true", "output.pictures=true")
    copy(folder / "pictures/fatigue.png", DOCS / PICTURE)
    for row in read(folder / "fatigue.csv"):
        if row["gear"] != "pinion" or float(row["friction"]) != COATED:
            continue
        name = f"{row['criterion']}_{row['place']}"
        for of, column in COLUMNS.items():
            coated = 1.0 + float(row[column]) / 100.0
            yield f"{of}_{name}", 1.0 / coated
            yield f"{of}_{name}_error_percent", float(row[f"{column}_error"]) / coated**2
        yield f"roll_distance_{name}_mm", float(row["roll_distance_mm"])
    facts = json.loads((folder / "fatigue.json").read_text(encoding="utf-8"))[0]
    for name in (
        "points", "left_out_percent", "near_reversal_percent", "fitted_shear_median_percent",
        "fitted_shear_most_percent",
    ):
        yield f"pair_{name}", facts[name]


def _fitted(runs: Runs) -> Named:
    """Zhang's pair in plane strain at three levels: half-ellipses against the pressures as solved."""
    for level in LEVELS:
        folder = _fatigue(runs, f"zhang_{level}", "zhang2023.toml", "pinion.face_width_mm=25", "sweep.positions=12",
                          f"mesh.level={level}", "output.error_bars=false", "output.pictures=false")
        facts = json.loads((folder / "fatigue.json").read_text(encoding="utf-8"))[0]
        yield f"{level}_median_percent", facts["fitted_shear_median_percent"]
        yield f"{level}_most_percent", facts["fitted_shear_most_percent"]


def _fatigue(runs: Runs, name: str, scene: str, *settings: str) -> Path:
    set_to = [f"--set={each}" for each in (*PAIR, *settings)]
    words = module_run("evolvent", "fatigue", DEMOS / scene, "--quiet", "--overwrite", *set_to)
    return runs.ended(name, "fatigue.json", *words)[0]


def friction_table(docs: Path) -> str:
    """Uncoated over coated by each criterion, and the exponent that would make the paper's ratio of it."""
    f = kept.kept(docs / KEPT, COMMAND)
    rows = [_row(f, criterion, place) for criterion in CRITERIA for place in criterion.places]
    at = 1 + max(k for k, row in enumerate(rows) if row[0] == DANG_VAN.words)
    constant = f[f"line_{CONSTANT}_{SURFACE}"]
    rows.insert(at, ("the same, a = 0", SURFACE, "0", _percent(constant), _exponent(constant), *5 * ("–",)))
    head = (
        "criterion", "place", "depth [µm]", "line contact of the same pressure", "exponent for 3.15",
        "Yang's pinion, largest", "exponent for 3.15", "Yang's pinion, median of its points", "exponent for 3.15",
        "life ratio by its own exponent: largest, median",
    )
    return markdown(head, rows)


def _row(f: Figures, criterion: Criterion, place: str) -> tuple[str, ...]:
    name = f"{criterion.name}_{place}"
    line = f.get(f"line_{name}")
    cells = ["–", "–"] if line is None else [_percent(line), _exponent(line)]
    for of in COLUMNS:
        cells += _of_pair(f, of, criterion, place)
    largest, at_points = (f.get(f"{of}_{name}", math.nan) for of in COLUMNS)
    lives = [f"{largest**m:.2f}, {at_points**m:.2f} (m = {m:g})" for m, _ in criterion.slopes_at(place)]
    return criterion.words, place, f"{f.get(f'line_{name}_um', 0.0):.3g}", *cells, "; ".join(lives) or "–"


def _of_pair(f: Figures, of: str, criterion: Criterion, place: str) -> list[str]:
    """Change with its error, and exponent, on the pinion."""
    name = f"{of}_{criterion.name}_{place}"
    error = f[f"{name}_error_percent"]
    return [f"{_percent(f[name])[:-2]} ± {error:.1f} %", _exponent(f[name], error)]


def fitted_table(docs: Path) -> str:
    """Largest shear stress below the pressures as solved over that below the half-ellipses."""
    f = kept.kept(docs / KEPT, COMMAND)
    rows = [
        (f"Zhang, plane strain, {level}", _percent(1.0 + 0.01 * f[f"{level}_median_percent"]),
         f"{f[f'{level}_most_percent']:.1f} %")
        for level in LEVELS
    ]
    median = _percent(1.0 + 0.01 * f["pair_fitted_shear_median_percent"])
    rows.append(("Yang, standard", median, f"{f['pair_fitted_shear_most_percent']:.1f} %"))
    return markdown(("pair and level", "median", "nine in ten within"), rows)


def _percent(ratio: float) -> str:
    return f"{100.0 * (ratio - 1.0):+.1f} %"


def _exponent(ratio: float, error_percent: float = 0.0) -> str:
    """error_percent: of the ratio; what it does not resolve has no exponent."""
    if 100.0 * abs(ratio - 1.0) < error_percent:
        return "not resolved"
    if ratio <= 1.0 + 1e-3:
        return "none"
    exponent = math.log(RATIO) / math.log(ratio)
    return f"{exponent:.3g}" if exponent < 100.0 else f"{exponent:.0f}"


if __name__ == "__main__":
    keep_figures(__doc__, DOCS / KEPT, figures)
