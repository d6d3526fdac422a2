"""`python -m evidence.tutorial OUT PRINTED`: keeps what docs/tutorial.md shows of a run of demos/first_pair.toml at level
quick, its folder and the file with what it has printed. Also the generated parts of that page."""

from __future__ import annotations

import json
import math
import sys
from dataclasses import dataclass, fields
from pathlib import Path

from PIL import Image

from evidence.benchmark.tables import read_rows, write_rows
from evidence.report import COLOURS, table
from solver.estimated_errors import FigureErrors, plus_minus
from solver.overview import overview
from solver.scene import load_scene

ROOT = Path(__file__).resolve().parents[1]
KEPT = Path("pictures") / "tutorial"
PICTURES = (
    "01_loaded_pair",
    "02_flank_pressure",
    "03_stress_over_engagement",
    "08_load_sharing",
    "09_transmission_error",
    "10_hertz",
)
MACHINE = "  memory of this machine"
"""The line of `evolvent check` that differs from machine to machine."""


@dataclass(frozen=True)
class FigureRow:
    """A figure of summary.json at one friction coefficient, and its error bar (NaN: none)."""

    friction: float
    figure: str
    value: float
    bar: float


def keep(out: Path, printed: Path, docs: Path) -> None:
    """Figures and pictures of the run in `out`, and what it printed. Raises OSError."""
    (docs / KEPT / "run.txt").write_text(printed.read_text(encoding="utf-8"), encoding="utf-8")
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    rows = [
        FigureRow(each["friction"], field.name, _number(each[field.name]), _number(each["estimated_error"][field.name]))
        for each in summary["frictions"]
        for field in fields(FigureErrors)
    ]
    write_rows(docs / KEPT / "figures.csv", rows)
    for name in PICTURES:
        with Image.open(out / "pictures" / f"{name}.png") as image:
            small = image.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
            small.save(docs / KEPT / f"{name}.png", optimize=True)


def figures(docs: Path) -> str:
    """What the run found, with its error bars. Raises ValueError where no run was kept."""
    rows = read_rows(docs / KEPT / "figures.csv", FigureRow)
    if not rows:
        raise ValueError(f"{docs / KEPT}: wanted figures.csv, found none; `python -m evidence.tutorial OUT` writes it")
    frictions = list(dict.fromkeys(row.friction for row in rows))
    lines = [
        (f"`{name}`", *(_shown(row) for row in rows if row.figure == name))
        for name in dict.fromkeys(row.figure for row in rows)
    ]
    head = ("`frictions` in summary.json", *(f"μ = {friction:g}" for friction in frictions))
    return table(head, lines, right=range(1, len(head)))


def run(docs: Path) -> str:
    """What the run printed, as a block of a page."""
    return f"```text\n{(docs / KEPT / 'run.txt').read_text(encoding='utf-8').strip()}\n```"


def check(scene: Path) -> str:
    """What `evolvent check SCENE --level quick` prints, as a block of a page; without what depends on the machine."""
    lines = overview(load_scene(scene, ["mesh.level=quick"])).strip().splitlines()
    return "\n".join(["```text", *(line.rstrip() for line in lines if not line.startswith(MACHINE)), "```"])


def scene_text(scene: Path) -> str:
    """The scene, as a block of a page."""
    return f"```toml\n{scene.read_text(encoding='utf-8').strip()}\n```"


def _shown(row: FigureRow) -> str:
    digits = max(0, 2 - math.floor(math.log10(abs(row.value)))) if row.value else 1
    return plus_minus(row.value, row.bar, min(digits, 2))


def _number(value: float | None) -> float:
    return math.nan if value is None else value


if __name__ == "__main__":
    keep(Path(sys.argv[1]), Path(sys.argv[2]), ROOT / "docs")
