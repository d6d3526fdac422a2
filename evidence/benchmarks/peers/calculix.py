"""CalculiX's side of the benchmark: python -m evidence.benchmarks.peers.calculix TASK ANSWER [surface | mortar]

surface: penalty contact of surface to surface with a linear law, as stiff as it is before it oscillates. mortar: dual
mortar with a hard law, for hexahedra and tetrahedra of the first order. Solved by SPOOLES, the solver that Debian's
CalculiX has. All but CalculiX itself counts as meshing.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from math import nan
from pathlib import Path

import numpy as np

from evidence.benchmarks.comparison.task import Answer, Push, Task, Turn
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData

ELEMENT = {
    ("quadrilateral", 1): "CPE4", ("quadrilateral", 2): "CPE8", ("triangle", 1): "CPE3", ("triangle", 2): "CPE6",
    ("hexahedron", 1): "C3D8", ("hexahedron", 2): "C3D20", ("tetrahedron", 1): "C3D4", ("tetrahedron", 2): "C3D10",
}
NODES = {
    "CPE8": range(8), "CPE6": range(6), "C3D10": (0, 1, 2, 3, 4, 5, 6, 7, 9, 8),
    "C3D20": (*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15),
}
"""The nodes of `MeshData`'s cells that CalculiX's elements have, in its order."""
FACES = {
    "quadrilateral": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "triangle": ((0, 1), (1, 2), (2, 0)),
    "hexahedron": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    "tetrahedron": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
}
STIFFNESS = {Push: 1e7, Turn: 1e6}  # N/mm³: ten times softer loses 5 % of a peak, ten times stiffer oscillates
SLAVE = 1  # the body with the smaller cells


def main() -> None:
    source, target, kind = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3] if len(sys.argv) > 3 else "surface"
    task, begin = Task.read(source), time.process_time()
    job = target.with_suffix("")
    with open(job.with_suffix(".inp"), "w") as file:
        file.writelines(line + "\n" for line in deck(task, kind == "mortar"))
    written = time.process_time()
    with open(job.with_suffix(".out"), "w") as out:
        subprocess.run(["ccx", "-i", job.name], cwd=job.parent, stdout=out, stderr=out, check=True)
    solved = time.process_time()
    answer = read_answer(task, job, start=begin)
    seconds = {"start": begin, "mesh": written + time.process_time() - solved}
    Answer(**{**vars(answer), "seconds": seconds}).write(target)


def deck(task: Task, mortar: bool) -> Iterator[str]:
    """The lines of the input."""
    starts = (0, len(task.bodies[0].points))
    first_cells = (0, len(task.bodies[0].cells))
    element = ELEMENT[task.bodies[0].shape, task.bodies[0].order]
    for i, mesh in enumerate(task.bodies):
        yield from _mesh_lines(mesh, element, starts[i], first_cells[i], i)
        yield from _surface_lines(mesh, task.contact[i], first_cells[i], f"S{i}")
        yield from _material_lines(task.materials[i], i)
    yield from _drive_lines(task)
    yield "*BOUNDARY"
    yield from _support_lines(task, mortar)
    yield from _contact_lines(task, mortar)
    yield from _step_lines(task)


def _support_lines(task: Task, mortar: bool) -> Iterator[str]:
    """One line for each displacement that is held. Mortar bears one support a node on the slave's contact surface."""
    starts, element = (0, len(task.bodies[0].points)), ELEMENT[task.bodies[0].shape, task.bodies[0].order]
    bearing = set(task.bodies[SLAVE].facets[task.contact[SLAVE]].ravel().tolist()) if mortar else set()
    supported: set[int] = set()
    for body, group, directions in task.held:
        numbers = ["xyz".index(a) + 1 for a in directions if "xyz".index(a) < task.dimension]
        for node in _used(task.bodies[body], group, element).tolist():
            if body == SLAVE and node in bearing:
                if node in supported:
                    continue
                supported.add(node)
            yield from (f"{node + starts[body] + 1},{k},{k}" for k in numbers)


def _mesh_lines(mesh: MeshData, element: str, start: int, first: int, body: int) -> Iterator[str]:
    used = np.unique(_cells(mesh, element))
    yield f"*NODE, NSET=N{body}"
    for number, (x, y, z) in zip(used + start + 1, mesh.points[used].tolist()):
        yield f"{number},{x:.12g},{y:.12g},{z:.12g}"
    yield f"*ELEMENT, TYPE={element}, ELSET=E{body}"
    for number, cell in enumerate((_cells(mesh, element) + start + 1).tolist(), first + 1):
        words = [str(number), *map(str, cell)]
        yield ",".join(words[:11]) + ("," if len(words) > 11 else "")
        if len(words) > 11:
            yield ",".join(words[11:])


def _cells(mesh: MeshData, element: str) -> Ints:
    """Node indices of the cells in CalculiX's order."""
    return mesh.cells[:, list(NODES[element])] if element in NODES else mesh.cells


def _used(mesh: MeshData, group: str, element: str) -> Ints:
    """Nodes of a facet group that CalculiX has."""
    return np.intersect1d(mesh.facets[group], _cells(mesh, element))


def _surface_lines(mesh: MeshData, group: str, first: int, name: str) -> Iterator[str]:
    yield f"*SURFACE, NAME={name}, TYPE=ELEMENT"
    for cell, face in element_faces(mesh, group):
        yield f"{first + cell + 1},S{face + 1}"


def element_faces(mesh: MeshData, group: str) -> list[tuple[int, int]]:
    """(cell, CalculiX's face number − 1) of each facet of a group."""
    faces = FACES[mesh.shape]
    wanted = {frozenset(nodes) for nodes in mesh.facets[group][:, : len(faces[0])].tolist()}
    near = np.flatnonzero(np.isin(mesh.cells, mesh.facets[group]).any(axis=1))
    return [
        (cell, face)
        for cell, nodes in zip(near.tolist(), mesh.cells[near].tolist())
        for face, corners in enumerate(faces)
        if frozenset(nodes[c] for c in corners) in wanted
    ]


def _material_lines(material: tuple[float, float], body: int) -> Iterator[str]:
    yield from (f"*MATERIAL, NAME=M{body}", "*ELASTIC", f"{material[0]},{material[1]}")
    yield from (f"*SOLID SECTION, ELSET=E{body}, MATERIAL=M{body}", "1.")


def _drive_lines(task: Task) -> Iterator[str]:
    """The driven group as a set of nodes."""
    yield "*NSET, NSET=DRIVEN"
    yield from (str(node + 1) for node in _driven(task))


def _contact_lines(task: Task, mortar: bool) -> Iterator[str]:
    yield f"*CONTACT PAIR, INTERACTION=PRESS, TYPE={'MORTAR' if mortar else 'SURFACE TO SURFACE'}"
    yield f"S{SLAVE},S{1 - SLAVE}"
    yield "*SURFACE INTERACTION, NAME=PRESS"
    stiffness = STIFFNESS[type(task.drive)]
    if mortar:
        yield "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"
    else:
        yield from ("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness}")
    if task.friction:
        yield from ("*FRICTION", f"{task.friction},{stiffness / 10}")


def _step_lines(task: Task) -> Iterator[str]:
    """One step from rest to the full drive."""
    d = task.dimension
    yield from ("*STEP, INC=100", "*STATIC", "1.,1.", "*BOUNDARY")
    if isinstance(task.drive, Push):
        yield from (f"DRIVEN,1,{d - 1}", f"DRIVEN,{d},{d},{task.drive.displacement}")
    else:
        nodes = _driven(task)
        for node, (x, y, _) in zip(nodes + 1, task.drive.rotation * task.bodies[0].points[nodes]):
            yield from (f"{node},1,1,{-y:.12g}", f"{node},2,2,{x:.12g}")
    yield from ("*CONTACT FILE, FREQUENCY=100", "CDIS, CSTR")
    yield f"*NODE FILE, FREQUENCY=100{', OUTPUT=2D' if d == 2 else ''}"
    yield from ("RF", "*END STEP")


def read_answer(task: Task, job: Path, start: float) -> Answer:
    """Pressure at the slave's nodes, from the last CONTACT block of the .frd file."""
    offset = len(task.bodies[0].points) if SLAVE else 0
    block = frd_block(job.with_suffix(".frd"), "CONTACT")
    slave = task.bodies[SLAVE]
    nodes = np.unique(slave.facets[task.contact[SLAVE]])
    pressure = np.zeros(len(slave.points))
    inside = (block[:, 0] > offset) & (block[:, 0] <= offset + len(slave.points))
    pressure[block[inside, 0].astype(int) - offset - 1] = block[inside, 4]
    _fill_middles(slave, task.contact[SLAVE], pressure)
    return Answer(
        body=SLAVE,
        pressure=pressure[nodes],
        nodes=nodes,
        torque=_torque(task, job) if isinstance(task.drive, Turn) else nan,
        iterations=_iterations(job.with_suffix(".out")),
        dofs=task.dofs,
        seconds={"start": start},
    )


def _torque(task: Task, job: Path) -> float:
    """Of the forces that turn the driven group [N·mm]."""
    nodes = _driven(task)
    block = frd_block(job.with_suffix(".frd"), "FORC")
    force = block[np.searchsorted(block[:, 0], nodes + 1), 1:3]
    x, y, _ = task.bodies[0].points[nodes].T
    return float(x @ force[:, 1] - y @ force[:, 0])


def _driven(task: Task) -> Ints:
    """Nodes of the driven group that CalculiX has."""
    return _used(task.bodies[0], task.driven, ELEMENT[task.bodies[0].shape, task.bodies[0].order])


def _fill_middles(mesh: MeshData, group: str, pressure: Floats) -> None:
    """The centre node of a second-order quadrilateral facet, which CalculiX has not: serendipity interpolation."""
    facets = mesh.facets[group]
    if facets.shape[1] == 9:
        values = pressure[facets]
        pressure[facets[:, 8]] = 0.5 * values[:, 4:8].sum(axis=1) - 0.25 * values[:, :4].sum(axis=1)


def frd_block(path: Path, name: str) -> Floats:
    """(n, 1 + components): node numbers and values of the last block of this name. Raises ValueError without one."""
    rows: list[list[float]] = []
    reading, present = False, False
    with open(path) as file:
        for line in file:
            if line.startswith(" -4"):
                reading = line.split()[1] == name
                if reading:
                    rows, present = [], True
            elif line.startswith(" -3"):
                reading = False
            elif reading and line.startswith(" -1"):
                rows.append([float(line[3:13])] + [float(line[k : k + 12]) for k in range(13, len(line.rstrip()), 12)])
    if not present:
        raise ValueError(f"{path.name}: wanted a block {name}, found none; read the end of {path.stem}.out")
    return np.array(rows)


def _iterations(out: Path) -> int:
    """Newton's, over all increments."""
    return sum(line.strip().startswith("iteration") for line in out.read_text(errors="replace").splitlines())


if __name__ == "__main__":
    main()
