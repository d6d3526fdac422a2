"""Error bars of the transient contact of He's pair against true errors: `python -m
evidence.benchmarks.accuracy.transient_bars --out DIR`; with the same folder again, motions are not computed again.
What the bars cost is measured after that (`transient_bar_costs`). `python -m evidence.pages` then writes
docs/transient.md.

Level quick with 20 positions a mesh period, against level standard with 160 and four natural modes of each harmonic.
The speeds lie at superharmonic resonances, beside the resonance and at it, where with little damping the teeth part and
meet.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evidence.benchmarks.accuracy import transient_bar_costs
from evidence.checkout import DEMOS, DOCS
from evidence.tables import markdown, read_csv, read_rows, write_rows
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS
from evolvent.dynamics.results.transient.rows import TRANSIENT, TRANSIENT_TEETH
from evolvent.run.call import Options
from evolvent.run.compute import compute
from evolvent.run.kinds.transient import Transient
from evolvent.scene.scene import load_scene
from evolvent_meshes.arrays import Floats

KEPT, COMMAND = "benchmark/transient_bars.csv", "python -m evidence.benchmarks.accuracy.transient_bars --out DIR"
RESONANCE = 4200
"""[r/min]."""
TRIED = "mesh.level=quick", "sweep.positions=20"
REFERENCE = (
    "mesh.level=standard", "sweep.positions=160", "transient.modes_per_harmonic=4", "output.error_bars=false",
)
VARIANTS = {
    "dynamics.damping_ratio=0.03": (1200, 1600, 2000, 3300, RESONANCE),
    "dynamics.damping_ratio=0.015": (RESONANCE,),
}
"""What differs from the demo -> speeds [r/min]."""
FIGURES = "dynamic_factor", "peak_to_peak_um", "max_pressure_MPa"
COLUMNS = (
    (TRANSIENT.name, "pinion_angle_deg", ("transmission_error_um", "mesh_force_N", "max_pressure_MPa")),
    (TRANSIENT_TEETH.name, "tooth_angle_deg", ("normal_force_N", "max_pressure_MPa")),
)
"""Table, its place, and its columns with error bars."""


@dataclass(frozen=True)
class HitRow:
    """How many bars of a figure hold its true error."""

    variant: str
    """What differs from the demo."""
    speed: float
    """[r/min]."""
    separated: float
    """Share of the mesh period in which nothing touches, of the reference."""
    figure: str
    """As in transient.json, or table and column."""
    inside: int
    """Bars that hold it."""
    count: int
    """Bars."""
    median_bar: float
    """Over the mean of the figure."""
    median_error: float
    """Likewise; the true one."""


@dataclass(frozen=True, eq=False)
class Bars:
    """A figure with its error bars, (n,) each."""

    value: Floats
    error: Floats
    """Its bar."""
    best: Floats
    """Of the reference; NaN where it has none."""

    def row(self, variant: str, fact: dict[str, Any], figure: str) -> HitRow:
        """fact: of the reference. Where value or reference are not known, there is nothing to hold; a bar that is not
        known where both are holds nothing."""
        known = np.isfinite(self.value) & np.isfinite(self.best)
        true = np.abs(self.value - self.best)[known]
        bar, size = self.error[known], float(np.abs(self.value[known]).mean())
        return HitRow(
            variant, fact["speed_rpm"], fact["separated"], figure, int(np.sum(true <= bar)), int(known.sum()),
            float(np.median(bar)) / size, float(np.median(true)) / size,
        )


def computed(settings: Sequence[str], variant: str, folder: Path, speeds: Sequence[float]) -> Path:
    """The demo at all speeds, in this folder."""
    more = f"transient.speeds_rpm={list(speeds)}", "transient.mesh_periods=300", "output.animation=false"
    scene = load_scene(DEMOS / "he2022_dynamics.toml", [*settings, *more, "output.pictures=false", variant])
    compute(Transient.of(scene), folder, Options(resume=True, quiet=True))
    return folder


def hit_rows(variant: str, tried: Path, best: Path) -> Iterator[HitRow]:
    """One a speed and figure, from the tables in both folders. The reference has the places of what is tried among its
    own."""
    facts = [json.loads((folder / TRANSIENT_FACTS.name).read_text(encoding="utf-8")) for folder in (tried, best)]
    tables = {name: [read_csv(folder / name) for folder in (tried, best)] for name, _, _ in COLUMNS}
    for own, exact in zip(*facts):
        for figure in FIGURES:
            values = (np.array([known], dtype=float) for known in (own[figure], own[f"{figure}_error"], exact[figure]))
            yield Bars(*values).row(variant, exact, figure)
        for name, place, columns in COLUMNS:
            lines = [[line for line in table if float(line["speed_rpm"]) == own["speed_rpm"]] for table in tables[name]]
            for column in columns:
                known = {round(float(line[place]), 6): float(line[column]) for line in lines[1]}
                wanted = np.array([known.get(round(float(line[place]), 6), np.nan) for line in lines[0]])
                value, bar = (
                    np.array([float(line[key]) for line in lines[0]]) for key in (column, f"{column}_error")
                )
                yield Bars(value, bar, wanted).row(variant, exact, f"{name}: {column}")


def measure(out: Path, variants: Mapping[str, Sequence[float]] = VARIANTS) -> Iterator[HitRow]:
    """All variants."""
    for number, (variant, speeds) in enumerate(variants.items()):
        tried, best = (out / f"{name}_{number}" for name in ("tried", "reference"))
        own, exact = computed(TRIED, variant, tried, speeds), computed(REFERENCE, variant, best, speeds)
        yield from hit_rows(variant, own, exact)


def table(rows: Iterable[HitRow]) -> str:
    """In Markdown."""
    head = "variant", "r/min", "separated %", "figure", "inside", "median bar %", "median error %"
    return markdown(head, [
        (row.variant, f"{row.speed:g}", f"{100 * row.separated:.0f}", row.figure, f"{row.inside} of {row.count}",
         f"{100 * row.median_bar:.1f}", f"{100 * row.median_error:.1f}")
        for row in rows
    ])


def inside(rows: Iterable[HitRow]) -> str:
    """How many bars hold, of how many."""
    every = list(rows)
    return f"{sum(row.inside for row in every)} of {sum(row.count for row in every)}"


def said(docs: Path) -> str:
    """What was kept: of figures, of all values of the tables' columns, of forces near resonance."""
    rows = read_rows(docs / KEPT, HitRow)
    if not rows:
        raise ValueError(f"{docs}: wanted {KEPT}, found none; `{COMMAND}` writes it")
    parts = [row for row in rows if row.figure not in FIGURES]
    forces = [row for row in parts if row.speed == RESONANCE and "force" in row.figure]
    figures = inside(row for row in rows if row.figure in FIGURES)
    return (
        f"The bars hold the true error of {figures} figures in `transient.json`, and of {inside(parts)} values in the "
        f"tables; wanted 90 %. The exception are forces at single positions at the resonance, {inside(forces)}: there "
        "they chatter in steps of a quarter, too."
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    runs = parser.parse_args().out
    found = list(measure(runs))
    write_rows(DOCS / KEPT, found)
    print(table(found))
    transient_bar_costs.keep(runs / "costs")
    print(transient_bar_costs.said(DOCS))
