"""CalculiX's side: implicit dynamics by Hilber, Hughes and Taylor with penalty contact of surface to surface.

Its plane elements do not take an initial velocity (2.20: they stay where they are). So the meshes are one cell deep,
C3D8 of 1 mm, and held across: the elements and the consistent mass of the plane problem. The method's α is that of
Evolvent's spectral radius at infinite frequency (Chung and Hulbert, J. Appl. Mech. 60 (1993) 371-375).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from evidence.benchmarks.blow.problem import SPEED, STEEL, Blow, ForceCourse
from evidence.benchmarks.peers.calculix import element_faces
from evidence.processes import Command, RunFailed, run
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData

SIDES = (3, 4, 5, 6)
"""CalculiX's faces of a C3D8 on the edges of the quadrilateral below it."""
NUMBER = r"([-+.\dE]+|NaN)"
FORCE = re.compile(rf"statistics for slave set.*?total surface force[^\n]*\s+{NUMBER}\s+{NUMBER}", re.DOTALL)
ENERGY = re.compile(rf"total (?:kinetic|internal) energy for set[^\n]*\s+{NUMBER}")
FREQUENCY = re.compile(rf"^ +\d+ +{NUMBER} +{NUMBER} +{NUMBER} +{NUMBER}$", re.MULTILINE)


def by_calculix(blow: Blow, penalty: float, folder: Path) -> ForceCourse:
    """penalty: pressure over overlap [N/mm³]. As far as CalculiX comes: it ends where its iterations diverge."""
    try:
        written = _printed(list(_deck(blow, penalty)), folder / f"blow_{penalty:g}")
    except RunFailed:
        written = (folder / f"blow_{penalty:g}.dat").read_text(encoding="utf-8")
    return read_course(written, blow)


def read_course(printed: str, blow: Blow) -> ForceCourse:
    """From a .dat file."""
    force = np.abs([float(y) for _, y in FORCE.findall(printed)])
    energy = sum(float(part) for part in ENERGY.findall(printed)[-4:])
    return ForceCourse(blow.time_step, force, energy / blow.energy)


def natural_frequencies(blow: Blow, count: int, folder: Path) -> Floats:
    """The lowest ones of the block that is held, (count,) [rad/s]. Raises RunFailed."""
    lines = [*_body_lines(blow), "N0,1,2", "*STEP", "*FREQUENCY", f"{count}", "*END STEP"]
    printed = _printed(lines, folder / "frequencies")
    return np.array([float(ω) for _, ω, _, _ in FREQUENCY.findall(printed)][:count])


def _printed(lines: list[str], job: Path) -> str:
    """What a run prints in its .dat file. Raises RunFailed."""
    job.with_suffix(".inp").write_text("\n".join(lines) + "\n", encoding="utf-8")
    run(Command(("ccx", "-i", job.name), job.parent, job.with_suffix(".log")))
    return job.with_suffix(".dat").read_text(encoding="utf-8")


def _deck(blow: Blow, penalty: float) -> Iterator[str]:
    yield from _body_lines(blow)
    yield from ("*INITIAL CONDITIONS, TYPE=VELOCITY", f"N0,2,{-SPEED}")
    yield from ("*CONTACT PAIR, INTERACTION=PRESS, TYPE=SURFACE TO SURFACE", "S0,S1")
    yield from ("*SURFACE INTERACTION, NAME=PRESS", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{penalty}")
    α = (blow.spectral_radius - 1.0) / (blow.spectral_radius + 1.0)
    yield from (f"*STEP, INC={2 * blow.steps}", f"*DYNAMIC, DIRECT, ALPHA={α:.6f}")
    yield f"{blow.time_step},{blow.time_step * blow.steps}"
    yield from ("*CONTACT PRINT, SLAVE=S0, MASTER=S1, FREQUENCY=1", "CF")
    for body in (0, 1):
        yield from (f"*EL PRINT, ELSET=E{body}, TOTALS=ONLY", "ELKE, ELSE")
    yield "*END STEP"


def _body_lines(blow: Blow) -> Iterator[str]:
    """Nodes, elements, surfaces, material and supports; the latter last."""
    starts, first_cells = (0, 2 * len(blow.bodies[0].points)), (0, len(blow.bodies[0].cells))
    for i, (mesh, group) in enumerate(zip(blow.bodies, ("bottom", "top"))):
        yield from _mesh_lines(mesh, starts[i], first_cells[i], i)
        yield f"*SURFACE, NAME=S{i}, TYPE=ELEMENT"
        yield from (f"{first_cells[i] + cell + 1},S{SIDES[edge]}" for cell, edge in element_faces(mesh, group))
        yield f"*SOLID SECTION, ELSET=E{i}, MATERIAL=STEEL"
    yield from ("*MATERIAL, NAME=STEEL", "*ELASTIC", f"{STEEL.youngs_modulus},{STEEL.poissons_ratio}")
    yield from ("*DENSITY", f"{STEEL.density}")
    held, depth = np.unique(blow.bodies[1].facets["bottom"]), len(blow.bodies[1].points)
    yield "*NSET, NSET=HELD"
    yield from (f"{starts[1] + layer * depth + node + 1}" for layer in (0, 1) for node in held.tolist())
    yield from ("*BOUNDARY", "HELD,1,2", "N0,3,3", "N1,3,3")


def _mesh_lines(mesh: MeshData, start: int, first: int, body: int) -> Iterator[str]:
    """Two layers of nodes, and the cells between them."""
    count = len(mesh.points)
    yield f"*NODE, NSET=N{body}"
    for layer in (0, 1):
        for node, (x, y, _) in enumerate(mesh.points.tolist(), start + layer * count + 1):
            yield f"{node},{x:.12g},{y:.12g},{layer}"
    yield f"*ELEMENT, TYPE=C3D8, ELSET=E{body}"
    for number, cell in enumerate((mesh.cells + start + 1).tolist(), first + 1):
        yield ",".join(map(str, (number, *cell, *(node + count for node in cell))))
