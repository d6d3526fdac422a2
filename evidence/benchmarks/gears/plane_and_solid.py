"""A spur pair in 2D against the same pair in 3D at equal error in transmission error.

He's pair, frictionless, 20 positions. In 3D the ends of the face are free, so the two transmission errors have
different limits: each mesh is held against its own. The limit in 2D is that of a fine mesh; in 3D it is that times the
ratio 3D/2D of one section with many layers, a ratio that changes by less than 3e-4 from section to section. The 3D mesh
is the smallest of a list whose error is not larger than that of the 2D mesh.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from math import nan

import numpy as np

from evidence.scenes import spur_pair
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.condensed_gear import condensed_gear
from evolvent.gears.gear_load import GearLoad
from evolvent.gears.gear_model import GearModel
from evolvent.gears.meshing.element_sizes import sector_resolutions
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.run.call import peak_memory_MB
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.sector import sector_mesh

POSITIONS = 20


@dataclass(frozen=True)
class SpurMesh:
    """A mesh of He's pair."""

    elements: float
    """Across the Hertz width 2b_H."""
    layers: int = 0
    """Over the face width; 0 in 2D."""
    fine_body: bool = False
    """Without the skip coarse-body."""

    def scene(self) -> Scene:
        """He's pair with this section."""
        off = ['exact.parts=["coarse-body"]'] if self.fine_body else []
        return spur_pair("mesh.level=quick", f"mesh.elements_per_contact_width={self.elements}", *off)


@dataclass(frozen=True)
class Solved:
    """What a pitch took."""

    transmission_error: float
    """Mean of the pitch [µm]."""
    seconds: float
    """CPU time of all."""
    memory_MB: float
    """Largest resident memory."""


@dataclass(frozen=True)
class SpurRow:
    """A 2D mesh and the cheapest 3D mesh, `volume`, whose error is not larger: CPU seconds, memory, relative error of
    the transmission error. NaN where no 3D mesh of the list has it."""

    elements: float
    fine_body: int
    seconds: float
    memory_MB: float
    error: float
    volume_elements: float
    layers: int
    volume_seconds: float
    volume_memory_MB: float
    volume_error: float


PLANES = (SpurMesh(1.0), SpurMesh(1.7), SpurMesh(1.7, fine_body=True))
VOLUMES = (
    *(SpurMesh(elements, layers) for elements in (1.0, 1.7) for layers in (1, 2, 3, 4, 6, 8)),
    *(SpurMesh(elements, layers, fine_body=True) for elements in (1.0, 1.7) for layers in (2, 3, 4, 6, 8, 12)),
)
REFERENCE = SpurMesh(6.0, fine_body=True)
ENDS = SpurMesh(1.0, layers=8), SpurMesh(1.0)
"""A section with many layers, and the same in 2D: what the free ends do."""


def rows(planes: tuple[SpurMesh, ...] = PLANES, volumes: tuple[SpurMesh, ...] = VOLUMES) -> Iterator[SpurRow]:
    """One for each of the 2D meshes."""
    limit = solved(REFERENCE).transmission_error
    ends = solved(ENDS[0]).transmission_error / solved(ENDS[1]).transmission_error
    ascending = sorted(volumes, key=_size)
    for plane in planes:
        flat = solved(plane)
        error = abs(flat.transmission_error / limit - 1.0)
        head = (plane.elements, int(plane.fine_body), flat.seconds, flat.memory_MB, error)
        for mesh in ascending:
            solid = solved(mesh)
            if (volume_error := abs(solid.transmission_error / (limit * ends) - 1.0)) <= error:
                yield SpurRow(*head, mesh.elements, mesh.layers, solid.seconds, solid.memory_MB, volume_error)
                break
        else:
            yield SpurRow(*head, nan, 0, nan, nan, nan)


def _size(mesh: SpurMesh) -> int:
    """Nodes of the pinion's sector."""
    scene = mesh.scene()
    section = sector_mesh(scene.gear_pair().pinion, sector_resolutions(gear_problem(scene))[0], "quadrilateral")
    return len(section.points) * (2 * mesh.layers + 1)


@cache
def solved(mesh: SpurMesh) -> Solved:
    """In a process of its own, so that its memory is its own."""
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        return pool.submit(_solve, mesh).result()


def _solve(mesh: SpurMesh) -> Solved:
    dolfinx_compat.silence_logs()
    begin = time.process_time()
    model = _model(mesh)
    pitch = uniform_pitch(model.pair.pinion.z, POSITIONS)
    swept = [p.results[0].transmission_error for p in sweep_pitch(model, pitch, [0.0], initial_state([0.0]))]
    return Solved(1e3 * float(np.mean(swept)), time.process_time() - begin, peak_memory_MB())


def _model(mesh: SpurMesh) -> GearModel:
    """As `prepare_model` makes it, but for the number of layers."""
    scene = mesh.scene()
    pair, teeth = scene.gear_pair(), gear_problem(scene).contact_teeth
    bodies = []
    for member, resolution in zip(Member, sector_resolutions(gear_problem(scene))):
        layered = replace(resolution, face_elements=max(mesh.layers, 1))
        cells = sector_mesh(pair.gears[member], layered, "hexahedron" if mesh.layers else "quadrilateral")
        material, carries = scene.materials()[member], member == Member.PINION
        bodies.append(condensed_gear(pair.gears[member], cells, material, teeth, member, carries_pressure=carries))
    torque = 1e3 * scene.load.torque_Nm / (1.0 if mesh.layers else pair.face_width)
    window = gear_problem(scene).window_half_width
    return GearModel(pair, (bodies[0], bodies[1]), teeth, GearLoad(torque), window)
