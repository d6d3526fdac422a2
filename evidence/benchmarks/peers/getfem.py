"""GetFEM's side of the benchmark, a process of Debian's Python: python3 -m evidence.benchmarks.peers.getfem TASK ANSWER

Its own contact brick of large sliding by ray tracing, an augmented Lagrangian with a multiplier on the contact surface,
with r = E/h. (The brick of small sliding between non-matching meshes converges silently to a wrong answer where the
bodies overlap at the start.) MUMPS solves the tangent.
"""

from __future__ import annotations

import sys
import time
from math import nan
from pathlib import Path
from typing import Any

import numpy as np

from evidence.benchmarks.comparison.task import Answer, Push, Task, Turn
from evidence.benchmarks.peers.nodal_normals import nodal_normals
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.reference_cells import node_positions

DRIVEN, CONTACT, HELD = 1, 2, 10  # numbers of regions; supports count on from HELD
TRANSFORMATION = {
    "triangle": "GT_PK(2,{})",
    "quadrilateral": "GT_QK(2,{})",
    "tetrahedron": "GT_PK(3,{})",
    "hexahedron": "GT_QK(3,{})",
}
ELEMENT = {shape: name.replace("GT", "FEM") for shape, name in TRANSFORMATION.items()}
INTEGRATION = {
    "triangle": ("IM_TRIANGLE(3)", "IM_TRIANGLE(6)"),
    "quadrilateral": ("IM_GAUSS_PARALLELEPIPED(2,2)", "IM_GAUSS_PARALLELEPIPED(2,4)"),
    "tetrahedron": ("IM_TETRAHEDRON(2)", "IM_TETRAHEDRON(5)"),
    "hexahedron": ("IM_GAUSS_PARALLELEPIPED(3,2)", "IM_GAUSS_PARALLELEPIPED(3,4)"),
}
STIFF = 1e4  # penalty of supports over Young's modulus a millimetre
SLAVE = 1  # the body that carries the multiplier: the one with the smaller cells
TOLERANCE, ITERATIONS = 1e-8, 60
SEARCH = "lsearch", "simplest", "alpha min", 0.8  # its default search does not converge from a start without contact


class Part:
    """One body in GetFEM: mesh, space of displacements, integration.

    nodes: GetFEM's point of every node of `MeshData`.
    """

    def __init__(self, gf: Any, data: MeshData) -> None:
        self.gf, self.data, d = gf, data, data.dimension
        place = node_positions(data.shape, data.order)
        lexicographic = np.lexsort(place.T)
        cells = data.cells[:, lexicographic]
        corners = np.ascontiguousarray(data.points[cells][..., :d].transpose(2, 1, 0))
        self.mesh = gf.Mesh("empty", d)
        numbers = self.mesh.add_convex(gf.GeoTrans(TRANSFORMATION[data.shape].format(data.order)), corners)
        points, _ = self.mesh.pid_from_cvid(numbers)
        self.nodes = np.empty(len(data.points), dtype=np.int64)
        self.nodes[cells.ravel()] = points
        self.displacement = self.field(d)
        self.integration = gf.MeshIm(self.mesh, gf.Integ(INTEGRATION[data.shape][data.order - 1]))

    def region(self, number: int, group: str) -> None:
        """Names the boundary faces of a facet group."""
        inside = np.unique(self.nodes[self.data.facets[group]])
        faces, outer = self.mesh.faces_from_pid(inside), self.mesh.outer_faces()
        both = {tuple(f) for f in faces.T.tolist()} & {tuple(f) for f in outer.T.tolist()}
        self.mesh.set_region(number, np.array(sorted(both)).T)

    def field(self, components: int, order: int | None = None) -> Any:
        """Lagrange elements of the mesh's order."""
        space = self.gf.MeshFem(self.mesh, components)
        space.set_fem(self.gf.Fem(ELEMENT[self.data.shape].format(order or self.data.order)))
        return space


def solved(gf: Any, task: Task) -> Answer:
    """The answer, and what its parts took (CPU seconds)."""
    marks = [time.process_time()]
    parts = [Part(gf, mesh) for mesh in task.bodies]
    marks.append(time.process_time())
    model = _model(gf, task, parts)
    iterations = _newton(model)
    marks.append(time.process_time())
    return _answer(model, task, parts, iterations, marks)


def _model(gf: Any, task: Task, parts: list[Part]) -> Any:
    """Elasticity, supports, drive and contact."""
    model = gf.Model("real")
    for i, part in enumerate(parts):
        young, poisson = task.materials[i]
        model.add_fem_variable(f"u{i}", part.displacement)
        model.add_initialized_data(f"lame{i}", young * poisson / ((1 + poisson) * (1 - 2 * poisson)))
        model.add_initialized_data(f"shear{i}", young / (2 * (1 + poisson)))
        model.add_isotropic_linearized_elasticity_brick(part.integration, f"u{i}", f"lame{i}", f"shear{i}")
        part.region(CONTACT, task.contact[i])
    for number, (body, group, directions) in enumerate(task.held):
        parts[body].region(HELD + number, group)
        for direction in directions[: task.dimension]:
            one, stiff = f"u{body}({'xyz'.index(direction) + 1})", STIFF * task.materials[body][0]
            model.add_linear_term(
                parts[body].integration, f"{stiff}*{one}*Test_{one}", HELD + number, 1, 1
            )
    parts[0].region(DRIVEN, task.driven)
    _drive(model, task, parts[0])
    _contact(model, task, parts)
    return model


def _drive(model: Any, task: Task, part: Part) -> None:
    if isinstance(task.drive, Push):
        model.add_initialized_data("push", [0.0] * (task.dimension - 1) + [task.drive.displacement])
        model.add_Dirichlet_condition_with_simplification("u0", DRIVEN, "push")
        return
    space = part.displacement
    x, y, z = space.basic_dof_nodes()[:, ::3]
    turned = task.drive.rotation * np.column_stack([-y, x, 0.0 * z])
    model.add_initialized_fem_data("turn", space, turned.ravel())
    model.add_Dirichlet_condition_with_simplification("u0", DRIVEN, "turn")


def _contact(model: Any, task: Task, parts: list[Part]) -> None:
    size = np.median([_size(task.bodies[SLAVE], nodes) for nodes in task.bodies[SLAVE].facets[task.contact[SLAVE]]])
    model.add_initialized_data("r", task.materials[SLAVE][0] / size)
    model.add_initialized_data("friction", task.friction)
    model.add_filtered_fem_variable("multiplier", parts[SLAVE].field(task.dimension), CONTACT)
    brick = model.add_integral_large_sliding_contact_brick_raytracing("r", 4.0 * size, "friction")
    model.add_slave_contact_boundary_to_large_sliding_contact_brick(
        brick, parts[SLAVE].integration, CONTACT, f"u{SLAVE}", "multiplier"
    )
    model.add_master_contact_boundary_to_large_sliding_contact_brick(
        brick, parts[1 - SLAVE].integration, CONTACT, f"u{1 - SLAVE}"
    )


def _size(mesh: MeshData, nodes: Ints) -> float:
    """Length of a facet's first edge [mm]."""
    return float(np.linalg.norm(mesh.points[nodes[1]] - mesh.points[nodes[0]]))


def _torque(model: Any, parts: list[Part]) -> float:
    """About z, of what the driven body presses on the other one with [N·mm]."""
    place = f"(X+u{SLAVE})"
    moment = f"multiplier.[-{place}(2);{place}(1);0]"
    on_slave = float(parts[SLAVE].gf.asm_generic(parts[SLAVE].integration, 0, moment, CONTACT, model))
    return on_slave if SLAVE == 1 else -on_slave


def _newton(model: Any) -> int:
    """Its iterations. Raises RuntimeError where it does not converge."""
    count, converged = model.solve("max_iter", ITERATIONS, "max_res", TOLERANCE, "lsolver", "mumps", *SEARCH)
    if not converged:
        raise RuntimeError(f"GetFEM: no convergence within {ITERATIONS} iterations")
    return int(count)


def _answer(model: Any, task: Task, parts: list[Part], iterations: int, marks: list[float]) -> Answer:
    """Pressure at the nodes of the slave's contact surface, from its multiplier."""
    part, d = parts[SLAVE], task.dimension
    nodes, normals = nodal_normals(part.data, task.contact[SLAVE])
    traction = _at_nodes(part, model.interpolation("multiplier", part.field(d), CONTACT), nodes)
    return Answer(
        body=SLAVE,
        pressure=-np.sum(traction * normals[:, :d], axis=1),
        nodes=nodes,
        torque=_torque(model, parts) if isinstance(task.drive, Turn) else nan,
        iterations=iterations,
        dofs=int(model.nbdof()),
        seconds={"start": marks[0], "mesh": marks[1] - marks[0], "solve": marks[2] - marks[1]},
    )


def _at_nodes(part: Part, values: Floats, nodes: Ints) -> Floats:
    """A vector field's values (n, d) at nodes of `MeshData`."""
    space, d = part.field(part.data.dimension), part.data.dimension
    first = np.empty(part.mesh.max_pid() + 1, dtype=np.int64)
    basic = space.basic_dof_nodes()[:, ::d]
    first[part.mesh.pid_from_coords(basic)] = np.arange(basic.shape[1])
    return values.reshape(-1, d)[first[part.nodes[nodes]]]


def main() -> None:
    import getfem as gf

    gf.util("trace level", 0)
    source, target = sys.argv[1:]
    solved(gf, Task.read(Path(source))).write(Path(target))


if __name__ == "__main__":
    main()
