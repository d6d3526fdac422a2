"""docs/benchmark.md: tables and figures from the measured rows; nothing is typed in by hand."""

from __future__ import annotations

from pathlib import Path

from evidence.benchmarks.pages import accuracy, comparison, gear_pairs, root_stress
from evidence.benchmarks.pages.section import PICTURES
from evidence.report import header, write

COMMAND = "python -m evidence.benchmarks all --peers"
TERMS = """CPU seconds of the whole process with one thread, start of Python and its imports included, writing and
reading of meshes not; medians of runs side by side. *cold*: the first run on a kind of cells, which compiles its forms.
Errors are relative to the overkill solution of the same problem."""
SECTIONS = (*comparison.SECTIONS, *gear_pairs.COSTS, *accuracy.SECTIONS, *root_stress.SECTIONS,
    *gear_pairs.WEAR, *gear_pairs.MOTION)


def write_page(out: Path, measured: bool = True) -> Path:
    """The page and its figures, below this folder; parts that were not measured are left out. measured: whether this
    machine measured a part; else the page keeps the header of the machine that did. Raises OSError."""
    path = out / "benchmark.md"
    is_kept = path.exists() and not measured
    first = _header_of(path) if is_kept else header("Benchmarks", COMMAND)
    (out / PICTURES).mkdir(parents=True, exist_ok=True)
    for section in SECTIONS:
        section.draw(out / "benchmark", out / PICTURES)
    return write(path, [first, *parts(out / "benchmark")])


def _header_of(page: Path) -> str:
    """The header that a page has, by `evidence.report.header`."""
    return "\n\n".join(page.read_text(encoding="utf-8").split("\n\n")[:2])


def parts(tables: Path) -> list[str]:
    """The page below its header, from the tables in this folder."""
    return [TERMS, *(part for section in SECTIONS for part in section.parts(tables))]
