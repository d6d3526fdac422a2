"""What error bars of transient contact cost: processor time of a case with and without them, one after the other, each
one process with one thread. `python -m evidence.benchmarks.accuracy.transient_bar_costs --out DIR` measures it alone,
`transient_bars` with the rest. `python -m evidence.pages` then writes docs/transient.md.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from evidence.checkout import DEMOS, DOCS, ROOT
from evidence.processes import Command, module_run, run, run_arguments
from evidence.tables import read_rows, write_rows
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS

KEPT = "benchmark/transient_bar_costs.csv"
COMMAND = "python -m evidence.benchmarks.accuracy.transient_bar_costs --out DIR"
TIME_LIMIT = 7200.0  # s
UNDRAWN = "output.pictures=false", "output.animation=false"


@dataclass(frozen=True)
class CostCase:
    """A scene that is run."""

    name: str
    """Of the folders of its runs."""
    words: str
    """In the page: what it is."""
    scene: str
    """In demos/."""
    settings: tuple[str, ...]
    """What differs from the scene."""


CASES = (
    CostCase("spur", "He's pair in plane strain at three speeds", "he2022_dynamics.toml", (
        "mesh.level=quick", "sweep.positions=20", "transient.speeds_rpm=[1500,2200,4000]",
    )),
    CostCase("helical", "Yang's helical pair with 6 mm of face width at one speed and one friction coefficient",
             "yang2022.toml", (
        "mesh.level=quick", "sweep.positions=20", "transient.speeds_rpm=[1500]", "contact.friction=[0.1]",
        "pinion.face_width_mm=6", "wheel.face_width_mm=6",
    )),
)
"""One in plane strain, one in space with friction."""


@dataclass(frozen=True)
class CostRow:
    """Processor time of a case, from the scene to its tables, start of Python included."""

    case: str
    """As the page says it."""
    without_bars: float
    """[s]."""
    with_bars: float
    """[s]."""

    @property
    def ratio(self) -> float:
        """With error bars over without."""
        return self.with_bars / self.without_bars


def cost_rows(out: Path, cases: Sequence[CostCase] = CASES) -> Iterator[CostRow]:
    """One a case. Its first run does not count: it compiles the forms of its cells, where no run before it has.
    Raises RunFailed, and ValueError where a case has no error bars, whose cost would be that of a failure."""
    folder = out.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for case in cases:
        _seconds(case, folder, "compiling", bars=False)
        without, barred = _seconds(case, folder, "without", bars=False), _seconds(case, folder, "with", bars=True)
        _require_bars(folder / f"{case.name}_with")
        yield CostRow(case.words, without, barred)


def _seconds(case: CostCase, out: Path, which: str, bars: bool) -> float:
    """Processor time of `evolvent transient`, in a folder that is computed anew."""
    folder = out / f"{case.name}_{which}"
    settings = *case.settings, *UNDRAWN, f"output.error_bars={str(bars).lower()}"
    arguments = run_arguments(str(DEMOS / case.scene), folder, settings, "--overwrite")
    words = module_run("evolvent", "transient", *arguments)
    return run(Command(words, ROOT, folder.with_suffix(".log"), time_limit=TIME_LIMIT)).cpu


def _require_bars(folder: Path) -> None:
    """Raises ValueError where a figure of a run has none."""
    for fact in TRANSIENT_FACTS.read(folder):
        if math.isnan(fact.dynamic_factor_error):
            found = f"none at {fact.speed_rpm:g} r/min, μ = {fact.friction:g}"
            raise ValueError(f"{folder}: wanted error bars, found {found}; its log says why")


def keep(out: Path) -> None:
    """Measures all cases and keeps them for the page. Raises RunFailed, ValueError, OSError."""
    write_rows(DOCS / KEPT, list(cost_rows(out)))


def said(docs: Path) -> str:
    """What was kept, in a sentence. Raises ValueError where nothing was."""
    rows = read_rows(docs / KEPT, CostRow)
    if not rows:
        raise ValueError(f"{docs}: wanted {KEPT}, found none; `{COMMAND}` writes it")
    each = [
        f"{row.case} takes {row.without_bars:.0f} s of processor time without and {row.with_bars:.0f} s with them, "
        f"**{row.ratio:.1f} times** as much"
        for row in rows
    ]
    return f"With error bars a case takes longer (level quick, 20 positions): {'; '.join(each)}."


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    keep(parser.parse_args().out)
    print(said(DOCS))
