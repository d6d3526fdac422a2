"""The round contacts that programs are compared on, and their meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evidence.benchmarks.comparison.task import Push, Task
from evolvent.contact import hertz
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.structured_grid import split_to_simplices
from evolvent_meshes.shapes.blocks import cylinder_2d, graded_rectangle
from evolvent_meshes.shapes.rings import ring_block, ring_sphere
from evolvent_meshes.shapes.variants import with_part

STEEL, ALUMINIUM = (210e3, 0.3), (70e3, 0.3)
FINER = 1.37  # how much smaller the cells of the block are: the meshes do not match
GROWTH = 1.6  # of the cells away from the contact


@dataclass(frozen=True)
class Hertz:
    """A round contact.

    radius:     R of the upper body [mm].
    half_width: or radius a of the contact [mm].
    peak:       p0 [MPa].
    approach:   of the driven group [mm].
    """

    radius: float
    half_width: float
    peak: float
    approach: float


def line_contact() -> Hertz:
    """The cylinder and block of NAFEMS R0094, benchmark 1, under a load that makes a = R/100.

    At the benchmark's own load a is R/8, and programs that take the normals of one body or the other, before or after
    deformation, solve problems whose answers lie 0.3 % (peak) to 1 % (profile) apart: no error below that means
    anything. At R/100 they are the same problem. The approach is that of bodies of this size.
    """
    modulus = hertz.contact_modulus(*STEEL, *ALUMINIUM)
    a = 0.5
    return Hertz(50.0, a, modulus * a / (2 * 50.0), 0.0162)


def cylinder(cells: float, order: int, shape: str) -> Task:
    """Cylinder on block with cells of a/`cells` on the cylinder; shape "quadrilateral" or "triangle"."""
    case = line_contact()
    size, fine = case.half_width / cells, 1.5 * case.half_width
    upper = cylinder_2d(case.radius, size, fine, order, shape, growth=GROWTH)
    lower = graded_rectangle(200.0, 200.0, size / FINER, fine, order, shape, GROWTH)
    reach = 2 * case.half_width
    bodies = with_part(upper, "arc", "contact", reach), with_part(lower, "top", "contact", reach)
    return Task(
        bodies, (STEEL, ALUMINIUM), "top", Push(-case.approach), ((1, "bottom", "xy"),), ("contact", "contact")
    )


def point_contact() -> Hertz:
    """A steel ball of 8 mm radius on a steel block under about 2000 N."""
    contact = hertz.point_contact(2000.0, 8.0, hertz.contact_modulus(*STEEL, *STEEL))
    return Hertz(8.0, contact.radius, contact.peak_pressure, 0.026)


def sphere(cells: float, order: int, shape: str, edge: float = 1.0) -> Task:
    """A quarter of ball and block with cells of a/`cells` on the ball, in rings one of which ends at `edge` times
    Hertz' radius; shape "hexahedron" or "tetrahedron"."""
    case = point_contact()
    bodies = ball_and_block(case.radius, case.half_width, case.half_width / cells, order, shape, edge)
    symmetry = [(body, f"symmetry_{axis}", axis) for body in (0, 1) for axis in "xy"]
    held = (*symmetry, (1, "bottom", "xyz"))
    return Task(bodies, (STEEL, STEEL), "top", Push(-case.approach), held, ("contact", "contact"))


def ball_and_block(
    radius: float, a: float, size: float, order: int, shape: str, edge: float = 1.0, ratio: float = 1 / 1.2
) -> tuple[MeshData, MeshData]:
    """Quarters of a ball and of a block of 4 mm with cells of `size` on the ball and `ratio` times that on the block,
    in rings one of which ends at `edge` times Hertz' radius a [mm]; facet group "contact" within 1.5 a."""
    side, fine, growth, depth = 4.0, 1.25 * a, 1.7, 0.25 * a
    upper = ring_sphere(radius, side, side, edge * a, size, fine, order, growth, depth)
    lower = ring_block(side, side, edge * a, size * ratio, fine, order, growth, depth)
    if shape == "tetrahedron":
        upper, lower = (split_to_simplices(mesh, _columns(mesh.points)) for mesh in (upper, lower))
    return with_part(upper, "arc", "contact", 1.5 * a), with_part(lower, "top", "contact", 1.5 * a)


def _columns(points: Floats) -> Ints:
    """A number for each column of nodes above each other, by radius and then angle (n,)."""
    x, y = points[:, 0], points[:, 1]
    key = np.round(np.column_stack([np.hypot(x, y), np.arctan2(y, x) * (np.hypot(x, y) > 1e-9)]), 9)
    return np.unique(key, axis=0, return_inverse=True)[1].ravel()
