"""Contacts of two bodies: a cylinder and a ball on a block, and three whose pressure a mesh shows badly."""

from __future__ import annotations

import numpy as np

from evolvent import (
    Body,
    Contact,
    ContactResult,
    Fixed,
    Freedom,
    Material,
    Nitsche,
    Problem,
    Rigid,
    solve,
)
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.structured_grid import boundary_facets, facets_where, lattice_cells, subdivided
from evolvent_meshes.shapes.blocks import cylinder_2d, graded_box, graded_rectangle, rectangle, sphere_quarter

FRICTION = 0.2


def cylinder(friction: float = FRICTION, first: int = 0, order: int = 2, extra: tuple[Freedom, ...] = ()) -> Problem:
    """A steel cylinder of 50 mm radius on an aluminium block, 5 kN/mm, a = 2.35 mm, cells of a/3 on a/4."""
    bodies = (
        Body(cylinder_2d(50.0, 0.8, 3.0, order, growth=1.6), rigid=Rigid("top", (Freedom("y", load=-5e3), *extra))),
        Body(graded_rectangle(60.0, 40.0, 0.63, 3.0, order, growth=1.6), Material(70e3, 0.3), (Fixed("bottom"),)),
    )
    sides = ((0, "arc"), (1, "top"))
    return Problem(bodies, (Contact(sides[first], sides[1 - first], friction, reach=0.5),))


def ball(friction: float = FRICTION) -> Problem:
    """A quarter of a ball of 8 mm radius on a block, coarse."""
    symmetry = (Fixed("symmetry_x", "x"), Fixed("symmetry_y", "y"))
    bodies = (
        Body(
            sphere_quarter(8.0, 2.0, 2.0, 0.2, 0.4, 1),
            supports=symmetry,
            rigid=Rigid("top", (Freedom("z", load=-500.0),)),
        ),
        Body(graded_box(2.0, 2.0, 0.17, 0.4, 1), Material(70e3, 0.3), (*symmetry, Fixed("bottom"))),
    )
    return Problem(bodies, (Contact((0, "arc"), (1, "top"), friction, reach=0.1),))


def rubber(
    size: float,
    fine: float,
    poissons_ratio: float = 0.49,
    order: int = 2,
    shape: str = "quadrilateral",
    nitsche: Nitsche = Nitsche(),  # noqa: B008
) -> Problem:
    """A steel cylinder of 10 mm radius, pressed with 5 N/mm on rubber, 10 MPa, 40 by 20 mm; both with cells of `size`
    over |x| <= fine, growing outside. The contact is 4.2 mm wide."""
    steel = Body(cylinder_2d(10.0, size, fine, order, shape), rigid=Rigid("top", (Freedom("y", load=-5.0),)))
    soft = Body(
        graded_rectangle(40.0, 20.0, size, fine, order, shape), Material(10.0, poissons_ratio), (Fixed("bottom"),)
    )
    return Problem((steel, soft), (Contact((1, "top"), (0, "arc")),), nitsche)


def quarter_ring(inner: float, outer: float, around: int, across: int, order: int = 2) -> MeshData:
    """Facet groups inner, outer, and in the planes of symmetry at_x (y = 0), at_y (x = 0) [mm]."""
    r, angle = (subdivided(np.linspace(a, b, n + 1), order) for a, b, n in
                ((inner, outer, across), (0.0, np.pi / 2.0, around)))
    R, θ = np.meshgrid(r, angle, indexing="ij")
    points = np.stack([R * np.cos(θ), R * np.sin(θ), 0.0 * R], axis=-1).reshape(-1, 3)
    cells = lattice_cells((across, around), order)
    ends = {"inner": R - inner, "outer": R - outer, "at_x": points[:, 1], "at_y": points[:, 0]}
    facets = boundary_facets("quadrilateral", order, cells)
    groups = {name: facets_where(facets, np.abs(value.ravel()) < 1e-9 * outer) for name, value in ends.items()}
    return MeshData(points, "quadrilateral", order, cells, groups, {"body": np.arange(len(cells))})


def press_fit(shaft: int, hub: int, oversize: float) -> ContactResult:
    """Steel rings of 5 to 10 and 10 to 20 mm radius, the inner one too large by `oversize` [mm]; cells a quarter."""
    symmetry = (Fixed("at_x", "y"), Fixed("at_y", "x"))
    bodies = (
        Body(quarter_ring(5.0, 10.0 + oversize, shaft, 4), supports=symmetry),
        Body(quarter_ring(10.0, 20.0, hub, 6), supports=symmetry),
    )
    return solve(Problem(bodies, (Contact((0, "outer"), (1, "inner"), reach=0.5),))).contacts[0]


def punch(cells: int) -> ContactResult:
    """A flat punch of 4 mm with sharp edges, on a wide block of the same steel."""
    upper = rectangle(4.0, 4.0, cells, cells, origin=(-2.0, 0.0))
    lower = graded_rectangle(40.0, 20.0, 3.0 / cells, 2.5)
    bodies = (
        Body(upper, rigid=Rigid("top", (Freedom("y", load=-1000.0),))),
        Body(lower, supports=(Fixed("bottom"),)),
    )
    return solve(Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=0.2),))).contacts[0]
