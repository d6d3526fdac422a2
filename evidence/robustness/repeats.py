"""`python -m evidence.robustness.repeats --out DIR`: to how many digits the figures of small scenes repeat.

Each command is run in several processes, with the kernels of OpenBLAS for older and newer processors, and with memory
that is displaced by an allocation before all others: sums round differently there. Compared are all numbers of all CSV
and JSON files that the command writes. Keeps DIR's figures in docs/stress/repeats.csv, from which `make pages` writes
the table of docs/checks.md.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from evidence.checkout import DEMOS, DOCS, ROOT
from evidence.processes import Command, run
from evidence.tables import Column, Table, write_rows

KERNELS = ("Haswell", "Sandybridge", "Nehalem")
"""Kernels of OpenBLAS, for processors of 2013, 2011 and 2008; a newer processor runs them all."""
SHIFTS = (0, 4112)
"""Bytes allocated before all else, no multiple of a cache line."""
SHIFTED = """import ctypes, sys
ctypes.CDLL(None).malloc({shift})
from evolvent.commands.app import main
sys.exit(main(sys.argv[1:]))
"""
SMALL = ("mesh.level='quick'", "sweep.positions=8", "output.pictures=false", "output.animation=false")
CASES: Mapping[str, tuple[str, str, tuple[str, ...]]] = {
    "`run`, spur": ("run", "he2022.toml", ("contact.friction=[0.0, 0.1]",)),
    "`run`, helical": ("run", "yang2022.toml", ("contact.friction=[0.1]", "mesh.elements_per_contact_width=1.1")),
    "`dynamics`": ("dynamics", "he2022_dynamics.toml", ("dynamics.speeds=40",)),
    "`transient`": ("transient", "he2022_dynamics.toml", ("transient.speeds_rpm=[3000]",)),
    "`strength`": ("strength", "zhang2023.toml", ("contact.friction=0.0",)),
    "`fatigue`": ("fatigue", "he2022.toml", ("contact.friction=[0.0, 0.1]",)),
}
"""Name -> command, scene of demos/, settings beside `SMALL`."""
KEPT = Path("stress/repeats.csv")
NO_FIGURES = ("seconds", "timings_s", "cost", "memory", "residual", "iterations", "balance_error", "momentum_error",
              "reaction_error", "energy_error", "versions")
"""Parts of the names of what is no figure of a gear pair: the clock, and what rounding leaves over."""


@dataclass(frozen=True)
class RepeatRow:
    """How well the figures of a command repeat."""

    command: str
    processes: int
    """Number of runs that are compared."""
    figures: int
    """Number of columns and keys with numbers."""
    largest: float
    """Largest difference of a figure between two runs, over the figure's largest value."""
    figure: str
    """The figure that has it."""
    bar: float
    """Largest such difference of an error bar, which is a difference of two solutions; NaN without error bars."""


TABLE = Table(
    RepeatRow,
    (
        Column("command", "command", words=True),
        Column("runs", "processes"),
        Column("figures", "figures"),
        Column("largest difference", "largest", ".0e"),
        Column("of", "figure", words=True),
        Column("of error bars", "bar", ".0e"),
    ),
)
Figures = dict[str, list[float]]
"""File and column -> its numbers, in the order of the rows."""


def figures(folder: Path) -> Figures:
    """All numbers of the CSV and JSON files of a folder."""
    found: Figures = {}
    for path in sorted(folder.glob("*.csv")):
        with open(path, newline="", encoding="utf-8") as stream:
            for row in csv.DictReader(stream):
                _add(found, ((f"{path.name}: {name}", value) for name, value in row.items()))
    for path in sorted(folder.glob("*.json")):
        _add(found, _leaves(json.loads(path.read_text(encoding="utf-8")), f"{path.name}: "))
    return {name: values for name, values in found.items() if not any(part in name for part in NO_FIGURES)}


def _leaves(value: object, name: str) -> Iterator[tuple[str, object]]:
    """Dotted name and value of everything in nested lists and dictionaries; entries of a list share a name."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _leaves(inner, f"{name}{'' if name.endswith(': ') else '.'}{key}")
    elif isinstance(value, list):
        for inner in value:
            yield from _leaves(inner, name)
    else:
        yield name, value


def _add(found: Figures, values: Iterable[tuple[str, object]]) -> None:
    """Adds the values that are numbers, not whole ones."""
    for name, value in values:
        try:
            number = float(str(value))
        except ValueError:
            continue
        if not isinstance(value, (bool, int)) and math.isfinite(number):
            found.setdefault(name, []).append(number)


def is_bar(name: str) -> bool:
    """Whether a figure is an error bar; a transmission error is none."""
    return "_error" in name.replace("transmission_error", "")


def differences(runs: list[Figures]) -> dict[str, float]:
    """Figure -> largest difference between two runs over its largest value; infinite where a run lacks values of it."""
    found: dict[str, float] = {}
    for name in sorted(set().union(*runs)):
        columns = [each.get(name, []) for each in runs]
        if len({len(column) for column in columns}) > 1:
            found[name] = math.inf
            continue
        size = max(map(abs, columns[0]), default=0.0)
        largest = max((max(values) - min(values) for values in zip(*columns)), default=0.0)
        found[name] = largest / size if size else (math.inf if largest else 0.0)
    return found


def measured(name: str, out: Path) -> RepeatRow:
    """A command run with all kernels and shifts, into folders of `out`. Raises RunFailed."""
    command, scene, settings = CASES[name]
    runs = []
    for kernel, shift in product(KERNELS, SHIFTS):
        folder = out / f"{command}_{Path(scene).stem}_{kernel}_{shift}"
        words = [command, str(DEMOS / scene), "--out", str(folder), "--quiet"]
        words += [f"--set={setting}" for setting in (*SMALL, *settings)]
        python = (sys.executable, "-c", SHIFTED.format(shift=shift))
        run(Command((*python, *words), ROOT, folder.with_suffix(".log"), {"OPENBLAS_CORETYPE": kernel}))
        runs.append(figures(folder))
    found = differences(runs)
    bars = set(filter(is_bar, found))
    worst = max(found.keys() - bars, key=found.__getitem__)
    bar = max((found[figure] for figure in bars), default=math.nan)
    return RepeatRow(name, len(runs), len(found) - len(bars), found[worst], worst, bar)


def said(docs: Path) -> str:
    """The table of docs/checks.md. Raises ValueError where nothing was measured."""
    if not (rows := TABLE.read(docs / KEPT)):
        raise ValueError(f"{docs}: wanted {KEPT}, found none; `python -m evidence.robustness.repeats --out DIR` has it")
    return TABLE.markdown(rows)


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="where the commands are run; a new folder")
    out = parser.parse_args().out.resolve()
    out.mkdir(parents=True)
    rows = []
    for name in CASES:
        rows.append(measured(name, out))
        print(rows[-1], flush=True)
    write_rows(DOCS / KEPT, rows)


if __name__ == "__main__":
    main()
