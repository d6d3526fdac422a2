"""`python -m evidence.benchmarks.line.edges [--small]`: positions at which edges of tips bear, resolved and as
line contact says, of random pairs without relief; for docs/line_contact.md.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from evidence.benchmarks.line.pairs import unrelieved
from evidence.checkout import DOCS
from evidence.tables import Table, write_rows
from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh, searched_positions
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.line.line_gears import MOST_ON_EDGES
from evolvent.gears.problem.gear_problem import MeshSettings
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_result import position_result
from evolvent.scene.scene import SceneError

PAIRS = {"spur": 100, "helical": 20}
POSITIONS = {"spur": 10, "helical": 5}


@dataclass(frozen=True)
class EdgeRow:
    """A random pair without relief."""

    kind: str
    """spur or helical."""
    pair: str
    positions: int
    bearing: int
    """Positions at which edges bear more than the limit of the load where the contact is resolved."""
    flagged: int
    """Positions at which they do as line contact says."""
    silent: int
    """Bearing positions that are not flagged."""
    largest_silent_percent: float
    """Largest part of the load that edges bear at these, resolved."""


TABLE = Table(EdgeRow)


def rows(kind: str, count: int) -> Iterator[EdgeRow]:
    """A row a pair of a kind, by seed."""
    seed = found = 0
    while found < count:
        seed += 1
        try:
            problem = unrelieved(seed, kind == "helical")
        except SceneError:
            continue
        found += 1
        angles = np.array(uniform_pitch(problem.pair.pinion.z, POSITIONS[kind]).angles)
        model = prepare_model(problem).model
        resolved = []
        for (each,) in searched_positions([model], angles):
            contact = position_result(model, each.contact, each.smooth, 0.0, each.stiffness, 0).contact
            force = contact.pressure * contact.weights
            resolved.append(float(force[contact.edge].sum() / force.sum()))
        lines = prepare_model(replace(problem, mesh=MeshSettings("line"), options=problem.options)).model
        mesh = loaded_mesh(lines, [problem.torque], angles)
        assert mesh.line is not None
        bears, flagged = np.array(resolved) > MOST_ON_EDGES, mesh.line.on_edges[:, 0] > MOST_ON_EDGES
        silent = bears & ~flagged
        largest = 100.0 * float(np.max(np.array(resolved)[silent], initial=0.0))
        name = f"{problem.pair.pinion.z}/{problem.pair.wheel.z}, {problem.pair.pinion.normal_module:g} mm"
        yield EdgeRow(kind, name, len(angles), int(bears.sum()), int(flagged.sum()), int(silent.sum()), largest)


def said(docs: Path) -> str:
    """Sentences of docs/line_contact.md."""
    measured = TABLE.read(docs / "line_contact" / "edges.csv")
    return "\n".join(_sentence(kind, of) for kind in PAIRS if (of := [row for row in measured if row.kind == kind]))


def _sentence(kind: str, measured: Sequence[EdgeRow]) -> str:
    count, bearing, flagged, silent = (
        sum(getattr(row, name) for row in measured) for name in ("positions", "bearing", "flagged", "silent")
    )
    worst = max(row.largest_silent_percent for row in measured)
    return (
        f"{len(measured)} random {kind} pairs without relief (`python -m evidence.benchmarks.line.edges`): "
        f"edges bear more than {100 * MOST_ON_EDGES:g} % of the load at {bearing} of {count} positions where the "
        f"contact is resolved, line contact flags {flagged}; {silent} that bear are not flagged"
        f"{f', with up to {worst:.2g} % of the load' if silent else ''}."
    )


def main() -> None:
    """Measures all pairs; the table is written after each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="two pairs of a kind, to see that everything works")
    parser.add_argument("--kind", choices=[*PAIRS], help="this kind alone; the other one keeps its rows")
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    path = given.out / "line_contact" / "edges.csv"
    measured = [row for row in TABLE.read(path) if given.kind not in (None, row.kind)]
    for kind in [given.kind] if given.kind else PAIRS:
        for row in rows(kind, 2 if given.small else PAIRS[kind]):
            measured.append(row)
            print(row, flush=True)
            write_rows(path, measured)


if __name__ == "__main__":
    main()
