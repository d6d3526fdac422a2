"""Where the time of a pitch goes, by Python's profiler, in a process of its own.

python -m evidence.benchmarks.gears.profile OUT.json ELEMENTS POSITIONS MU[,MU...]
"""

from __future__ import annotations

import cProfile
import json
import pstats
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from mpi4py import MPI

from evidence.benchmarks.gears.three_teeth import FRICTION, pair_scene
from evidence.processes import Command, module_run, run
from evidence.scenes import model_dofs
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.sweep.periodic_pitch import sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import initial_state
from evolvent.run.pitch_run import pitch_of
from evolvent.scene.gear_problem import gear_problem

FULL, SMALL = (1.7, 20), (1.0, 4)
"""Elements across the contact width, and positions."""
PARTS = (
    ("meshing", "gears/meshing/sector_meshes.py", "gear_mesh"),
    ("assembling: stiffness", "fem/body.py", "assemble"),
    ("assembling: Nitsche's constant term", "contact/nitsche/flux_recovery.py", "constant_term"),
    ("condensing: order of elimination", "fem/condensation/elimination_order.py", "dissect"),
    ("condensing: leaves, by MUMPS", "fem/condensation/mumps.py", "schur_complement"),
    ("condensing: adding updates up", "fem/condensation/nested_dissection.py", "add"),
    ("condensing: separators, by LAPACK", "fem/condensation/nested_dissection.py", "eliminate"),
    ("the ring of teeth", "gears/ring/ring_compliance.py", "__init__"),
    ("positions: search", "gears/contact/pair_contact.py", "gear_contact"),
    ("positions: compliance of the contact", "gears/contact/pair_contact.py", "system"),
    ("positions: what the window leaves out", "gears/contact/overlap_check.py", "overlap_outside"),
    ("positions: without friction", "contact/newton/equilibrium.py", "frictionless"),
    ("positions: with friction", "contact/newton/equilibrium.py", "frictional"),
    ("positions: friction history", "gears/sweep/friction_history.py", "previous_jumps"),
)
"""Name, file below solver/evolvent, and the function whose time with all that it calls it is; none calls another."""


@dataclass(frozen=True)
class ProfileRow:
    """A part of a pitch."""

    part: str
    dofs: int
    positions: int
    seconds: float
    """With the profiler running."""
    share: float
    """Of the whole."""
    calls: int


def rows(size: tuple[float, int], folder: Path) -> Iterator[ProfileRow]:
    """Of a pitch at one friction coefficient. Raises RunFailed."""
    out = folder / "profile.json"
    words = module_run("evidence.benchmarks.gears.profile", out, *size, FRICTION)
    run(Command(words, folder, folder / "profile.log", time_limit=3600.0))
    yield from (ProfileRow(**row) for row in json.loads(out.read_text()))


def profiled(elements: float, positions: int, frictions: str) -> list[ProfileRow]:
    """In this process."""
    scene = pair_scene(elements, f"contact.friction=[{frictions}]", f"sweep.positions={positions}")
    profiler = cProfile.Profile()
    profiler.enable()
    model = prepare_model(gear_problem(scene), MPI.COMM_SELF).model
    μ = scene.contact.friction
    list(sweep_until_periodic(model, pitch_of(scene), μ, initial_state(μ), MPI.COMM_SELF))
    profiler.disable()
    return _parts(pstats.Stats(profiler), model_dofs(model), positions)


def _parts(stats: pstats.Stats, dofs: int, positions: int) -> list[ProfileRow]:
    timed = stats.stats  # type: ignore[attr-defined]
    whole, parts = float(stats.total_tt), []  # type: ignore[attr-defined]
    for name, file, function in PARTS:
        times = [v for (path, _, called), v in timed.items() if path.endswith(f"/{file}") and called == function]
        calls, seconds = sum(v[1] for v in times), float(sum(v[3] for v in times))
        parts.append(ProfileRow(name, dofs, positions, seconds, seconds / whole, calls))
    rest = whole - sum(row.seconds for row in parts)
    return [*parts, ProfileRow("everything else", dofs, positions, rest, rest / whole, 1)]


def main() -> None:
    dolfinx_compat.silence_logs()
    out, elements, positions, frictions = sys.argv[1:]
    Path(out).write_text(json.dumps([asdict(row) for row in profiled(float(elements), int(positions), frictions)]))


if __name__ == "__main__":
    main()
