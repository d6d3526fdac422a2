"""Error bars of the vibration of He's pair against true errors: `python -m evidence.benchmarks.accuracy.vibration_bars
--out DIR`; with the same folder again, positions are not solved again.

Level quick with 20 and 40 positions, against level standard with 80, at 60 speeds up and down, on rigid bodies. Rows
within two steps of the speed from a jump of either run count apart: there a figure is that of one motion or of another.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evidence.checkout import DEMOS
from evidence.tables import markdown
from evolvent.dynamics.results.response import DYNAMICS, RESPONSE
from evolvent.run.call import Options
from evolvent.run.compute import compute
from evolvent.run.kinds.dynamics import Dynamics
from evolvent.scene.scene import load_scene
from evolvent_meshes.arrays import Floats

FIGURES = "equivalent_amplitude_um", "dynamic_factor"
SPEEDS = "dynamics.speeds=60", "dynamics.speed_rpm=[500,6000]", 'dynamics.bodies="rigid"'
VARIANTS = ("dynamics.damping_ratio=0.03", "dynamics.damping_ratio=0.08", 'dynamics.mesh="tangent"')
COUNTS, REFERENCE = (20, 40), 80
BESIDE = 2.0
"""Steps of the speed from a jump within which rows count apart."""


@dataclass(frozen=True)
class HitRow:
    """How many bars of a figure hold its true error."""

    variant: str
    """What differs from the demo."""
    positions: int
    """Of the pitch."""
    figure: str
    """As in response.csv."""
    away: str
    """Away from jumps: inside, of all."""
    beside: str
    """Beside jumps, likewise."""
    median_bar: float
    """Over the figure, away from jumps."""
    median_error: float
    """Likewise; the true one."""


@dataclass(frozen=True, eq=False)
class Swept:
    """What a run has written."""

    columns: dict[str, Floats]
    """Name -> (n,) of response.csv, both ways."""
    jumps: Floats
    """(k,) of both ways [r/min]."""


def swept(level: str, positions: int, variant: str, out: Path) -> Swept:
    """The demo at 60 speeds, in a folder of its own below `out`; only the reference is without error bars."""
    settings = f'mesh.level="{level}"', f"sweep.positions={positions}", "output.animation=false"
    bars = f"output.error_bars={str(level == 'quick').lower()}"
    scene = load_scene(DEMOS / "he2022_dynamics.toml", [*settings, bars, *SPEEDS, variant])
    folder = out / f"{level}_{positions}"
    compute(Dynamics.of(scene), folder, Options(resume=True, quiet=True))
    rows, known = RESPONSE.read(folder), DYNAMICS.read(folder)
    names = "speed_rpm", *(name for figure in FIGURES for name in (figure, f"{figure}_error"))
    columns = {name: np.array([getattr(row, name) for row in rows]) for name in names}
    return Swept(columns, np.array([*known.jumps_up_rpm, *known.jumps_down_rpm]))


def hit_rows(variant: str, positions: int, tried: Swept, best: Swept) -> Iterator[HitRow]:
    """One a figure."""
    speeds, jumps = tried.columns["speed_rpm"], np.append([np.inf], [*tried.jumps, *best.jumps])
    away = np.abs(speeds[:, None] - jumps).min(axis=1) > BESIDE * (speeds[1] - speeds[0])
    for figure in FIGURES:
        value, bar = tried.columns[figure], tried.columns[f"{figure}_error"]
        error = np.abs(value - best.columns[figure])
        hits = [f"{int((error <= bar)[part].sum())} of {int(part.sum())}" for part in (away, ~away)]
        sizes = [float(np.median((each / value)[away])) for each in (bar, error)]
        yield HitRow(variant, positions, figure, hits[0], hits[1], *sizes)


def measure(out: Path, variants: Sequence[str] = VARIANTS) -> Iterator[HitRow]:
    """All variants and numbers of positions."""
    for variant in variants:
        best = swept("standard", REFERENCE, variant, out)
        for positions in COUNTS:
            yield from hit_rows(variant, positions, swept("quick", positions, variant, out), best)


def table(rows: Iterable[HitRow]) -> str:
    """In Markdown."""
    head = "variant", "positions", "figure", "inside", "inside beside jumps", "median bar %", "median error %"
    return markdown(head, [
        (row.variant, str(row.positions), row.figure, row.away, row.beside, f"{100 * row.median_bar:.2f}",
         f"{100 * row.median_error:.2f}")
        for row in rows
    ])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    print(table(measure(parser.parse_args().out)))
