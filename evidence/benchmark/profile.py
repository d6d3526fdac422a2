"""Where the time of a pitch goes, by Python's profiler, in a process of its own.

python -m evidence.benchmark.profile OUT.json ELEMENTS POSITIONS MU[,MU...]
"""

from __future__ import annotations

import cProfile
import json
import pstats
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mpi4py import MPI

from evidence.benchmark.gears import FRICTION, scene
from evidence.benchmark.runs import Command, run
from evidence.checkout import PYTHONPATH
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.sweep.periodic_pitch import sweep_closed
from evolvent.gears.sweep.pitch_sweep import initial_state
from evolvent.run.pitch_run import pitch_of
from evolvent.scene.gear_problem import gear_problem

ELEMENTS, POSITIONS = 1.7, 20
PARTS = (
    ("meshing", "sector_meshes.py", "gear_mesh"),
    ("assembling: stiffness", "body.py", "assemble"),
    ("assembling: Nitsche's constant term", "flux_recovery.py", "constant_term"),
    ("condensing: order of elimination", "elimination_order.py", "planned"),
    ("condensing: leaves, by MUMPS", "mumps.py", "schur_complement"),
    ("condensing: adding updates up", "nested_dissection.py", "add"),
    ("condensing: separators, by LAPACK", "nested_dissection.py", "eliminate"),
    ("the ring of teeth", "ring_compliance.py", "__init__"),
    ("positions: search", "pair_contact.py", "gear_contact"),
    ("positions: compliance of the contact", "pair_contact.py", "system"),
    ("positions: what the window leaves out", "overlap_check.py", "overlap_outside"),
    ("positions: without friction", "equilibrium.py", "frictionless"),
    ("positions: with friction", "equilibrium.py", "frictional"),
    ("positions: memory of friction", "friction_history.py", "recalled"),
)
"""What is told apart: a name, and the function whose time with all that it calls it is; none calls another."""


@dataclass(frozen=True)
class ProfileRow:
    """A part of a pitch: seconds with the profiler running, share of the whole, calls."""

    part: str
    dofs: int
    positions: int
    seconds: float
    share: float
    calls: int


def rows(folder: Path, elements: float = ELEMENTS, positions: int = POSITIONS) -> Iterator[ProfileRow]:
    """Of a pitch at one friction coefficient. Raises RunFailed."""
    out = folder / "profile.json"
    words = sys.executable, "-m", "evidence.benchmark.profile", str(out), str(elements), str(positions), str(FRICTION)
    run(Command(words, folder, folder / "profile.log", {"PYTHONPATH": PYTHONPATH}, time_limit=3600.0))
    yield from (ProfileRow(**row) for row in json.loads(out.read_text()))


def measured(elements: float, positions: int, frictions: str) -> list[ProfileRow]:
    """In this process."""
    own = scene(elements, f"contact.friction=[{frictions}]", f"sweep.positions={positions}")
    profiler = cProfile.Profile()
    profiler.enable()
    model = prepare_model(gear_problem(own), MPI.COMM_SELF).model
    μ = own.contact.friction
    list(sweep_closed(model, pitch_of(own), μ, initial_state(μ), MPI.COMM_SELF))
    profiler.disable()
    dofs = sum(len(body.mesh.points) * body.d for body in model.bodies)
    return _parts(pstats.Stats(profiler), dofs, positions)


def _parts(stats: pstats.Stats, dofs: int, positions: int) -> list[ProfileRow]:
    timed = stats.stats  # type: ignore[attr-defined]
    whole = float(stats.total_tt)  # type: ignore[attr-defined]
    found = []
    for name, file, function in PARTS:
        own = [v for (path, _, called), v in timed.items() if path.endswith(f"/solver/{file}") and called == function]
        calls, seconds = sum(v[1] for v in own), float(sum(v[3] for v in own))
        found.append(ProfileRow(name, dofs, positions, seconds, seconds / whole, calls))
    rest = whole - sum(row.seconds for row in found)
    return [*found, ProfileRow("everything else", dofs, positions, rest, rest / whole, 1)]


def main() -> None:
    dolfinx_compat.silence_logs()
    out, elements, positions, frictions = sys.argv[1:]
    found = measured(float(elements), int(positions), frictions)
    Path(out).write_text(json.dumps([vars(row) for row in found]))


if __name__ == "__main__":
    main()
