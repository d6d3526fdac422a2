"""Where the time of a pitch goes, by Python's profiler, in a process of its own.

python -m evidence.benchmarks.gears.profile OUT.json ELEMENTS POSITIONS LEVELS, the last one True or False
"""

from __future__ import annotations

import cProfile
import json
import pstats
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from mpi4py import MPI

from evidence.benchmarks.gears.three_teeth import pair_scene
from evidence.processes import Command, module_run, run
from evidence.scenes import model_dofs
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.sweep.periodic_pitch import sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import initial_state
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.gear_problem import gear_problem


@dataclass(frozen=True)
class ProfiledPitch:
    """A pitch of Yang's pair at one friction coefficient.

    elements: across the contact width.
    positions: that are solved.
    levels: of the flanks, or one mesh.
    """

    elements: float
    positions: int
    levels: bool = False


FULL = {"profile": ProfiledPitch(1.7, 20), "profile_levels": ProfiledPitch(3.75, 6, levels=True)}
"""Name of the table -> what it is of."""
SMALL = {"profile": ProfiledPitch(1.0, 4), "profile_levels": ProfiledPitch(1.0, 2, levels=True)}
ONE_MESH_PARTS = (
    ("meshing", "gears/meshing/sector_meshes.py", "gear_mesh"),
    ("assembling: stiffness", "fem/body.py", "assemble"),
    ("assembling: Nitsche's constant term", "contact/nitsche/flux_recovery.py", "constant_term"),
    ("condensing: order of elimination", "fem/condensation/elimination_order.py", "dissect"),
    ("condensing: leaves, by MUMPS", "fem/condensation/mumps.py", "schur_complement"),
    ("condensing: adding updates up", "fem/condensation/nested_dissection.py", "add"),
    ("condensing: separators, by LAPACK", "fem/condensation/nested_dissection.py", "eliminate"),
    ("the ring of teeth", "gears/ring/ring_compliance.py", "of"),
    ("positions: search", "gears/contact/pair_contact.py", "gear_contact"),
    ("positions: compliance of the contact", "gears/contact/pair_contact.py", "system"),
    ("positions: what the window leaves out", "gears/contact/overlap_check.py", "overlap_outside"),
    ("positions: without friction", "contact/newton/equilibrium.py", "frictionless"),
    ("positions: with friction", "contact/newton/equilibrium.py", "frictional"),
    ("positions: friction history", "gears/sweep/friction_history.py", "previous_jumps"),
)
"""Name, file below solver/evolvent, and the function whose time with all that it calls it is; none calls another."""
LEVEL_PARTS = (
    ("meshing", "gears/meshing/levelled_meshes.py", "levelled_mesh"),
    ("the coarse sectors", "gears/two_level_gear.py", "coarse_gear"),
    ("patches", "contact/two_level/patch_response.py", "patch_response"),
    ("the levels from the patches", "gears/two_level/flank_refinement.py", "levels"),
    ("positions: search", "gears/contact/pair_contact.py", "gear_contact"),
    ("positions: where the window was not searched", "gears/contact/overlap_check.py", "unsearched_overlaps"),
    ("positions: rough compliance", "gears/two_level/rough_flanks.py", "nearly"),
    ("positions: products with the compliance", "gears/two_level/flank_window.py", "times"),
    ("positions: approximate inverses, made", "contact/newton/block_inverse.py", "__init__"),
    ("positions: approximate inverses, applied", "contact/newton/block_inverse.py", "solve"),
    ("positions: contact law, its forces", "contact/nitsche/contact_operator.py", "forces"),
    ("positions: tangents", "contact/newton/tangent.py", "of"),
    ("positions: friction history", "gears/sweep/friction_history.py", "previous_jumps"),
)
"""The same of flanks in levels."""


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


def rows(case: ProfiledPitch, folder: Path) -> Iterator[ProfileRow]:
    """Of a pitch at one friction coefficient. Raises RunFailed."""
    out = folder / "profile.json"
    words = module_run("evidence.benchmarks.gears.profile", out, case.elements, case.positions, case.levels)
    run(Command(words, folder, folder / "profile.log", time_limit=3600.0))
    yield from (ProfileRow(**row) for row in json.loads(out.read_text()))


def profiled(case: ProfiledPitch) -> list[ProfileRow]:
    """In this process."""
    scene = pair_scene(case.elements, f"sweep.positions={case.positions}", level="standard" if case.levels else "quick")
    problem, μ = gear_problem(scene), scene.contact.friction
    problem = replace(problem, mesh=replace(problem.mesh, two_level=case.levels))
    profiler = cProfile.Profile()
    profiler.enable()
    model = prepare_model(problem, MPI.COMM_SELF).model
    list(sweep_until_periodic(model, pitch_of(scene), μ, initial_state(μ), MPI.COMM_SELF))
    profiler.disable()
    return _parts(pstats.Stats(profiler), model_dofs(model), case)


def _parts(stats: pstats.Stats, dofs: int, case: ProfiledPitch) -> list[ProfileRow]:
    timed = stats.stats  # type: ignore[attr-defined]
    whole, parts = float(stats.total_tt), []  # type: ignore[attr-defined]
    for name, file, function in LEVEL_PARTS if case.levels else ONE_MESH_PARTS:
        times = [v for (path, _, called), v in timed.items() if path.endswith(f"/{file}") and called == function]
        calls, seconds = sum(v[1] for v in times), float(sum(v[3] for v in times))
        parts.append(ProfileRow(name, dofs, case.positions, seconds, seconds / whole, calls))
    rest = whole - sum(row.seconds for row in parts)
    return [*parts, ProfileRow("everything else", dofs, case.positions, rest, rest / whole, 1)]


def main() -> None:
    dolfinx_compat.silence_logs()
    out, elements, positions, levels = sys.argv[1:]
    case = ProfiledPitch(float(elements), int(positions), levels == str(True))
    Path(out).write_text(json.dumps([asdict(row) for row in profiled(case)]))


if __name__ == "__main__":
    main()
