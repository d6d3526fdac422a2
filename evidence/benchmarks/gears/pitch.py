"""A pitch of the gear pair by Evolvent in a process of its own, and where its time went.

python -m evidence.benchmarks.gears.pitch OUT.json ELEMENTS LEVEL POSITIONS MU[,MU...] [key=value ...]

POSITIONS 0: both sectors are only assembled and factored, each once, as a program without condensation begins. One
mesh a sector, unless levels=true is among the settings.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from mpi4py import MPI

from evidence.benchmarks.gears.three_teeth import FRICTION, pair_scene
from evidence.processes import Command, Cost, module_run, run
from evidence.scenes import model_dofs
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.condensation.schur_complement import Factor
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.meshing.sector_sizes import one_mesh_sizes
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import SweptPosition, initial_state
from evolvent.run.call import peak_memory_MB
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member

LEVELS = "levels=true"


@dataclass(frozen=True)
class PitchFacts:
    """What a pitch took, on the slowest rank."""

    dofs: int
    """Of both sectors, of one fine mesh each: the equivalent ones where flanks have levels."""
    ranks: int
    start: float
    """CPU time of Python and its imports [s]."""
    mesh: float
    """Wall time [s], as of the parts below."""
    assemble: float
    condense: float
    positions: tuple[float, ...]
    """Of each position that was solved: those of the pitch, then, with friction, some again."""
    counted: int
    """Positions of the pitch."""
    iterations: tuple[int, ...]
    """Of Newton's method at each position, all friction coefficients together."""
    transmission_error: tuple[float, ...]
    """At the first friction coefficient, at each position of the pitch [mm]."""
    memory_MB: float
    """Of all ranks together, as `cpu` [s]."""
    cpu: float

    @property
    def factoring(self) -> float:
        """Wall time of assembling and condensing, or of assembling and factoring [s]."""
        return self.assemble + self.condense

    @property
    def without_meshing(self) -> float:
        """Wall seconds of all but meshing, the start of Python included."""
        return self.start + self.factoring + sum(self.positions)

    @property
    def one_position(self) -> float:
        """Wall seconds of a run of a single position, all but meshing."""
        return self.start + self.factoring + self.positions[0]

    @property
    def mean_error(self) -> float:
        """Mean transmission error of the pitch [mm]."""
        return float(np.mean(self.transmission_error))


def pitch_cost(
    folder: Path, elements: float, positions: int, *settings: str, level: str = "quick",
    frictions: str = str(FRICTION), ranks: int = 1, variables: Mapping[str, str] = MappingProxyType({}),
) -> tuple[Cost, PitchFacts]:
    """A pitch in a process of its own, and what it took. Raises RunFailed."""
    out = folder / "pitch.json"
    words = module_run("evidence.benchmarks.gears.pitch", out, elements, level, positions, frictions, *settings)
    cost = run(Command(words, folder, folder / "pitch.log", variables, ranks, 3600.0))
    return cost, read_facts(out)


def read_facts(path: Path) -> PitchFacts:
    """What a process wrote. Raises OSError."""
    read: dict[str, Any] = json.loads(path.read_text())
    values: dict[str, Any] = {name: tuple(v) if isinstance(v, list) else v for name, v in read.items()}
    return PitchFacts(**values)


def solved(scene: Scene, levels: bool = False) -> PitchFacts:
    """The pitch of a scene, solved in this process. levels: of the flanks, whatever the size."""
    comm, start = MPI.COMM_WORLD, time.process_time()
    problem = gear_problem(scene)
    problem = replace(problem, mesh=replace(problem.mesh, two_level=levels))
    preparation = prepare_model(problem, comm)
    pitch, state = pitch_of(scene), initial_state(scene.contact.friction)
    seconds: list[float] = []
    swept: list[SweptPosition] = []
    begin = time.perf_counter()
    for position in sweep_until_periodic(preparation.model, pitch, scene.contact.friction, state, comm):
        seconds.append(time.perf_counter() - begin)
        swept.append(position)
        begin = time.perf_counter()
    assemble_share = preparation.assemble_seconds / (preparation.assemble_seconds + preparation.condense_seconds)
    return PitchFacts(
        dofs=sum(size.dofs for size in one_mesh_sizes(problem)) if levels else model_dofs(preparation.model),
        ranks=comm.size,
        start=start,
        mesh=preparation.mesh_seconds,
        assemble=preparation.seconds * assemble_share,
        condense=preparation.seconds * (1.0 - assemble_share),
        positions=tuple(seconds),
        counted=len(pitch.angles),
        iterations=tuple(sum(r.iterations for r in p.results) for p in swept),
        transmission_error=tuple(p.results[0].transmission_error for p in one_pitch(swept)),
        memory_MB=comm.allreduce(peak_memory_MB()),
        cpu=comm.allreduce(_cpu()),
    )


def factored(scene: Scene) -> PitchFacts:
    """Both sectors assembled and factored once, in this process."""
    start, began = time.process_time(), time.perf_counter()
    meshes = [gear_mesh(gear_problem(scene), member) for member in Member]
    meshing = time.perf_counter() - began
    assembling = factoring = 0.0
    for mesh, material in zip(meshes, scene.materials()):
        begin = time.perf_counter()
        body = assemble(Body(mesh, material, supports=(Fixed("bore"),)))
        K = body.stiffness[body.free][:, body.free].tocsr()
        middle = time.perf_counter()
        Factor(K).solve(np.ones(K.shape[0]))  # the first solution is what makes it factor
        assembling, factoring = assembling + middle - begin, factoring + time.perf_counter() - middle
    dofs = sum(len(mesh.points) * mesh.dimension for mesh in meshes)
    return PitchFacts(dofs, 1, start, meshing, assembling, factoring, (), 0, (), (), peak_memory_MB(), _cpu())


def _cpu() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def main() -> None:
    dolfinx_compat.silence_logs()
    out, elements, level, positions, frictions, *settings = sys.argv[1:]
    wanted = [f"contact.friction=[{frictions}]", f"sweep.positions={max(2, int(positions))}"]
    wanted += [each for each in settings if each != LEVELS]
    scene = pair_scene(float(elements), *wanted, level=level)
    facts = solved(scene, LEVELS in settings) if int(positions) else factored(scene)
    if MPI.COMM_WORLD.rank == 0:
        Path(out).write_text(json.dumps(asdict(facts)))


if __name__ == "__main__":
    main()
