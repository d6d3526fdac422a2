"""A pitch of the gear pair by Evolvent, a process of its own that says where its time went.

python -m evidence.benchmark.pitch OUT.json ELEMENTS LEVEL POSITIONS MU[,MU...] [key=value ...]

POSITIONS 0: both sectors are only assembled and factored, each once, as a program without condensation begins. All
ranks write what they took together: seconds are those of the slowest one.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI

from evidence.benchmark.gears import scene
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.condensation.schur_complement import Factor
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_closed
from evolvent.gears.sweep.pitch_sweep import SweptPosition, initial_state
from evolvent.run.context import peak_memory_MB
from evolvent.run.pitch_run import pitch_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class PitchFacts:
    """What a pitch took, on the slowest rank. start [s]: CPU, of Python and its imports; mesh, assemble, condense [s]:
    wall. positions: wall seconds of each that was solved, `counted` of them the pitch, the others, with friction,
    again. iterations: Newton's, of all friction coefficients together. transmission_error: [mm] at the first one, at
    each position of the pitch. memory_MB and cpu [s]: of all ranks together."""

    dofs: int
    ranks: int
    start: float
    mesh: float
    assemble: float
    condense: float
    positions: tuple[float, ...]
    counted: int
    iterations: tuple[int, ...]
    transmission_error: tuple[float, ...]
    memory_MB: float
    cpu: float

    @property
    def without_meshing(self) -> float:
        """Wall seconds of all but meshing, the start of Python included."""
        return self.start + self.assemble + self.condense + sum(self.positions)


def measured(own: Scene) -> PitchFacts:
    """The pitch of a scene, solved."""
    comm, start = MPI.COMM_WORLD, time.process_time()
    preparation = prepare_model(gear_problem(own), comm)
    pitch, state = pitch_of(own), initial_state(own.contact.friction)
    seconds: list[float] = []
    swept: list[SweptPosition] = []
    begin = time.perf_counter()
    for found in sweep_closed(preparation.model, pitch, own.contact.friction, state, comm):
        seconds.append(time.perf_counter() - begin)
        swept.append(found)
        begin = time.perf_counter()
    meshes = [body.mesh for body in preparation.model.bodies]
    assemble_share = preparation.assemble_seconds / (preparation.assemble_seconds + preparation.condense_seconds)
    return PitchFacts(
        dofs=sum(len(mesh.points) * mesh.dimension for mesh in meshes),
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


def factored(own: Scene) -> PitchFacts:
    """Both sectors assembled and factored once."""
    start, began = time.process_time(), time.perf_counter()
    meshes = [gear_mesh(gear_problem(own), member) for member in Member]
    meshed = time.perf_counter()
    assembling = factoring = 0.0
    for mesh, material in zip(meshes, own.materials()):
        begin = time.perf_counter()
        body = assemble(Body(mesh, material, supports=(Fixed("bore"),)))
        K = body.stiffness[body.free][:, body.free].tocsr()
        middle = time.perf_counter()
        Factor(K).solve(np.ones(K.shape[0]))  # the first solution is what makes it factor
        assembling, factoring = assembling + middle - begin, factoring + time.perf_counter() - middle
    dofs = sum(len(mesh.points) * mesh.dimension for mesh in meshes)
    mesh_seconds = meshed - began
    return PitchFacts(
        dofs, 1, start, mesh_seconds, assembling, factoring, (), 0, (), (), peak_memory_MB(), _cpu()
    )


def _cpu() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def read_facts(path: Path) -> PitchFacts:
    """What a run wrote."""
    found = json.loads(path.read_text())
    values: dict[str, Any] = {name: tuple(v) if isinstance(v, list) else v for name, v in found.items()}
    return PitchFacts(**values)


def main() -> None:
    dolfinx_compat.silence_logs()
    out, elements, level, positions, frictions, *settings = sys.argv[1:]
    wanted = f"contact.friction=[{frictions}]", f"sweep.positions={max(2, int(positions))}"
    own = scene(float(elements), *wanted, *settings, level=level)
    facts = measured(own) if int(positions) else factored(own)
    if MPI.COMM_WORLD.rank == 0:
        Path(out).write_text(json.dumps(asdict(facts)))


if __name__ == "__main__":
    main()
