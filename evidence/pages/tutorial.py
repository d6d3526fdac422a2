"""`python -m evidence.pages.tutorial OUT [PRINTED]`: keeps the figures of a run of demos/first_pair.toml for
docs/tutorial.md.

Where a file with the run's printed output is given, that output and the run's pictures are kept, too. The generated
parts of docs/tutorial.md are made from what was kept.
"""

from __future__ import annotations

import json
import math
import sys
from dataclasses import dataclass, fields
from pathlib import Path

from PIL import Image

from evidence.checkout import DOCS
from evidence.tables import markdown, read_rows, write_rows
from evolvent.check.check_report import overview
from evolvent.results.archive.error_bar_data import FigureErrors, plus_minus
from evolvent.results.drawing.style import palette, reduced
from evolvent.scene.scene import load_scene

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
    """A figure of summary.json at one friction coefficient.

    bar: its error bar; NaN: none.
    """

    level: str
    friction: float
    figure: str
    value: float
    bar: float


def keep_figures(out: Path, docs: Path) -> None:
    """Of the run in `out`, in place of those at the same mesh level. Raises OSError."""
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    level, path = summary["scene"]["mesh"]["level"], docs / KEPT / "figures.csv"
    rows = [
        FigureRow(level, each["friction"], name, _number(each[name]), _number(each["estimated_error"][name]))
        for each in summary["frictions"]
        for name in (field.name for field in fields(FigureErrors))
    ]
    write_rows(path, [*rows, *(row for row in read_rows(path, FigureRow) if row.level != level)])


def keep_pictures(out: Path, printed: Path, docs: Path) -> None:
    """Of the run in `out`, and what it printed. Raises OSError."""
    (docs / KEPT / "run.txt").write_text(printed.read_text(encoding="utf-8"), encoding="utf-8")
    for name in PICTURES:
        with Image.open(out / "pictures" / f"{name}.png") as image:
            small(image).save(docs / KEPT / f"{name}.png", optimize=True)


def small(image: Image.Image) -> Image.Image:
    """With a palette that keeps the colours of maps."""
    full = image.convert("RGB")
    return reduced(full, palette(full))


def figures(docs: Path) -> str:
    """What the runs found, with their error bars. Raises ValueError where none was kept."""
    rows = read_rows(docs / KEPT / "figures.csv", FigureRow)
    if not rows:
        raise ValueError(
            f"{docs / KEPT}: wanted figures.csv, found none; `python -m evidence.pages.tutorial OUT` writes it"
        )
    kept = {(row.level, row.friction, row.figure): row for row in rows}
    columns = sorted({(row.level, row.friction) for row in rows})
    lines = [
        (f"`{name}`", *(_shown(kept.get((*column, name))) for column in columns))
        for name in dict.fromkeys(row.figure for row in rows)
    ]
    head = ("`frictions` in summary.json", *(f"`{level}`, μ = {friction:g}" for level, friction in columns))
    return markdown(head, lines, right=range(1, len(head)))


def run(docs: Path) -> str:
    """What the run printed, as a block of a page."""
    return f"```text\n{(docs / KEPT / 'run.txt').read_text(encoding='utf-8').rstrip()}\n```"


def check(scene: Path) -> str:
    """What `evolvent check SCENE --level quick` prints, as a block of a page; without what depends on the machine."""
    lines = overview(load_scene(scene, ["mesh.level=quick"])).strip().splitlines()
    return "\n".join(["```text", *(line.rstrip() for line in lines if not line.startswith(MACHINE)), "```"])


def scene_text(scene: Path) -> str:
    """The scene, as a block of a page."""
    return f"```toml\n{scene.read_text(encoding='utf-8').rstrip()}\n```"


def _shown(row: FigureRow | None) -> str:
    """Value and bar; a run of before a figure was there has none."""
    if row is None:
        return "–"
    digits = max(0, 2 - math.floor(math.log10(abs(row.value)))) if row.value else 1
    return plus_minus(row.value, row.bar, min(digits, 2))


def _number(value: float | None) -> float:
    return math.nan if value is None else value


if __name__ == "__main__":
    keep_figures(Path(sys.argv[1]), DOCS)
    if len(sys.argv) > 2:
        keep_pictures(Path(sys.argv[1]), Path(sys.argv[2]), DOCS)
