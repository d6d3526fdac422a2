"""Wear problems with a known answer: nearly rigid bodies, whose worn shape follows from the removed volume alone."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from evolvent import Body, Contact, Fixed, Freedom, Material, Placement, Problem, Rigid, Step
from evolvent.wear import Cycle
from evolvent_meshes.shapes.blocks import cylinder_2d, graded_rectangle
from evolvent_meshes.shapes.rings import ring_block, ring_sphere
from evolvent_meshes.shapes.variants import with_part

RIGID = Material(2.1e7, 0.3)  # MPa: Hertz' approach is then 1 % of the worn depth
RADIUS, K = 5.0, 1e-9  # mm, mm²/N
SLIDING = 1e5  # mm

LINE_LOAD = 10.0  # N/mm
CYLINDER_WIDTH = (3.0 * RADIUS * K * LINE_LOAD * SLIDING / 2.0) ** (1.0 / 3.0)
CYLINDER_DEPTH = CYLINDER_WIDTH**2 / (2.0 * RADIUS)

POINT_LOAD = 10.0  # N
SPHERE_DEPTH = float(brentq(lambda h: np.pi * h**2 * (RADIUS - h / 3.0) - K * POINT_LOAD * SLIDING, 0.0, RADIUS))
SPHERE_WIDTH = float(np.sqrt(2.0 * RADIUS * SPHERE_DEPTH - SPHERE_DEPTH**2))


def cylinder(cells: float = 8.0, order: int = 2, friction: float = 0.0, material: Material = RIGID) -> Problem:
    """A half cylinder (body 0) on a slab, `cells` cells over the worn half-width."""
    size, fine = CYLINDER_WIDTH / cells, 1.3 * CYLINDER_WIDTH
    pin = Body(
        cylinder_2d(RADIUS, size, fine, order, contact=fine),
        material, rigid=Rigid("top", (Freedom("y", load=-LINE_LOAD),)), name="cylinder",
    )
    slab = graded_rectangle(4.0, 2.0, size / 1.25, 1.5 * fine, order)
    return Problem(
        (pin, Body(with_part(slab, "top", "near", 1.5 * fine), material, (Fixed("bottom"),), name="slab")),
        (Contact((0, "arc"), (1, "near"), friction, reach=0.05),),
    )


def sphere(cells: float = 3.0) -> Problem:
    """A quarter of a half sphere (body 0) on a slab, `cells` cells over the worn radius."""
    size, fine = SPHERE_WIDTH / cells, 1.25 * SPHERE_WIDTH
    ball = ring_sphere(RADIUS, 1.5, 1.5, SPHERE_WIDTH, size, fine, growth=1.7)
    slab = ring_block(1.5, 1.5, SPHERE_WIDTH, size / 1.25, fine, growth=1.7)
    symmetry = (Fixed("symmetry_x", "x"), Fixed("symmetry_y", "y"))
    down = Rigid("top", (Freedom("z", load=-POINT_LOAD / 4.0),))
    bodies = (
        Body(with_part(ball, "arc", "near", fine), RIGID, symmetry, rigid=down, name="ball"),
        Body(with_part(slab, "top", "near", 1.5 * fine), RIGID, (*symmetry, Fixed("bottom")), name="slab"),
    )
    return Problem(bodies, (Contact((0, "near"), (1, "near"), reach=0.05),))


def to_and_fro(stroke: float) -> Cycle:
    """The slab moves to one side by `stroke` [mm], to the other, and back."""

    def at(x: float) -> Step:
        return Step(placements=(Placement.at_rest(2), Placement(np.eye(2), np.array([x, 0.0]))))

    return Cycle((Step(), at(stroke), at(0.0), at(-stroke), at(0.0)))
