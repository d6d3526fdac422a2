"""A ball slides over a block: stress below the contact, in the cells and by the half-space (Hamilton 1983)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence.claims import Claim, Verification, analytical
from evidence.fits import relative_l2
from evolvent import Contact, Placement, Problem, Solution, Step, sweep
from evolvent.contact import hertz
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import STEEL
from evolvent.fem.stress import cell_stress
from evolvent.results.drawing.style import INK, PINION, TEETH
from evolvent.strength.fatigue.criteria import von_mises
from evolvent.strength.fatigue.half_space import PointForces
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.rings import ring_block, ring_sphere
from evolvent_meshes.shapes.variants import doubled, with_part

RADIUS, CONTACT, SIDE, FRICTION = 8.0, 0.08, 4.0, 0.25  # of the ball, a, of the bodies [mm]; μ
CELLS = 4  # on a
SLID = 0.3  # contact radii
DEPTHS = (0.3, 1.5)  # [a] between which stress is compared
MODULUS = 0.5 * STEEL.plane_modulus  # E* of two alike bodies
LOAD = 4.0 * MODULUS * CONTACT**3 / (3.0 * RADIUS)  # P [N]
PEAK = hertz.point_contact(LOAD, RADIUS, MODULUS).peak_pressure
SOURCE = "Hertz' pressure and μ times it, Boussinesq and Cerruti integrated; Hamilton 1983"


@dataclass(frozen=True)
class SlidBall:
    """Half a block, y >= 0, after half a ball has slid over it in +x."""

    solution: Solution

    @cached_property
    def block(self) -> MeshData:
        """Undeformed."""
        return self.solution.condensed[1].assembled.body.mesh

    @cached_property
    def tractions(self) -> PointForces:
        """The contact's forces on both halves of the block, with z into it."""
        c = self.solution.contacts[0]
        x, y = c.points[:, :2].T
        fx, fy, fz = (c.weights[:, None] * c.traction).T * np.sign(c.force[2]) * -1.0
        places = np.column_stack([np.tile(x, 2), np.concatenate([y, -y])])
        forces = np.column_stack([np.tile(fx, 2), np.concatenate([fy, -fy]), np.tile(-fz, 2)])
        return PointForces(places, forces, STEEL.poissons_ratio)

    @cached_property
    def inside(self) -> tuple[Floats, Floats, Floats]:
        """Of the block's cells around the contact between the DEPTHS: centres (n, 3) with z into it [mm], stress
        (n, 3, 3) [MPa] in the same axes, and volumes (n,)."""
        corners = self.block.points[self.block.cells[:, :8]]
        centre = corners.mean(axis=1)
        radius, depth = np.hypot(centre[:, 0], centre[:, 1]) / CONTACT, -centre[:, 2] / CONTACT
        near = (radius < 1.5) & (depth > DEPTHS[0]) & (depth < DEPTHS[1])
        stress = cell_stress(self.block, STEEL, self.solution.displacement(1))[near]
        flip = np.array([1.0, 1.0, -1.0])
        return centre[near] * flip, stress * np.outer(flip, flip), np.ptp(corners[near], axis=1).prod(axis=1)


def exact() -> PointForces:
    """Hertz' hemisphere of pressure that slides towards +x, at quadrature points."""
    nodes, weights = np.polynomial.legendre.leggauss(48)
    ω, dω = 0.25 * np.pi * (nodes + 1.0), 0.25 * np.pi * weights  # r = a sin ω: smooth where the pressure ends
    φ = 2.0 * np.pi * (np.arange(96) + 0.5) / 96
    force = np.repeat(PEAK * CONTACT**2 * np.cos(ω) ** 2 * np.sin(ω) * dω * 2.0 * np.pi / 96, 96)
    places = CONTACT * np.column_stack([np.outer(np.sin(ω), np.cos(φ)).ravel(), np.outer(np.sin(ω), np.sin(φ)).ravel()])
    forces = np.column_stack([FRICTION * force, 0.0 * force, force])
    return PointForces(places, forces, STEEL.poissons_ratio)


def slide() -> SlidBall:
    """Pressed at rest, then slid; the block carries the pressure."""
    size, fine = CONTACT / CELLS, (1.0 + SLID) * 1.2 * CONTACT
    ball = ring_sphere(RADIUS, SIDE, SIDE, CONTACT, size, fine, 2, 1.7, 0.5 * CONTACT)
    block = ring_block(SIDE, SIDE, CONTACT, size / 0.8, fine, 2, 1.7, 1.2 * CONTACT)
    symmetry, freedoms = Fixed("symmetry_y", "y"), (Freedom("z", load=-0.5 * LOAD), Freedom("x", displacement=0.0))
    bodies = (
        Body(_half(ball, "arc"), STEEL, (symmetry,), rigid=Rigid("top", freedoms), name="ball"),
        Body(_half(block, "top"), STEEL, (symmetry, Fixed("bottom")), name="block"),
    )
    contact = Contact((1, "contact"), (0, "contact"), FRICTION, reach=0.1 * CONTACT)
    start = Placement(np.eye(3), np.array([-SLID * CONTACT, 0.0, 0.0]))
    *_, after = sweep(Problem(bodies, (contact,)), [Step(placements=(start, Placement.at_rest(3))), Step()])
    return SlidBall(after)


def _half(quarter: MeshData, group: str) -> MeshData:
    """Doubled along the sliding, with the facets that may touch as the group "contact"."""
    return with_part(doubled(quarter, "symmetry_x"), group, "contact", (1.0 + SLID) * 1.3 * CONTACT)


def verify() -> Verification:
    """One slide on one mesh."""
    ball = slide()
    return Verification(
        "sliding_ball",
        "Sliding point contact: stress below",
        "A steel ball (R = 8 mm, a = 0.08 mm) is pressed on a steel block and slides over it, μ = 0.25: the traction "
        "is μp everywhere. Stress below the contact, which decides contact fatigue, is compared from 0.3 to 1.5 a deep "
        "with the half-space under Hertz' pressure and μ times it: that of the block's cells, and that of the "
        "half-space under the forces at the contact's quadrature points (evolvent.strength.fatigue.half_space). A half "
        f"model, hexahedra of a/{CELLS} in rings.",
        tuple(_claims(ball)),
        lambda figure: _draw(figure, ball),
        "Below a ball that slides: the half-space under the computed tractions, and the cells of the block",
    )


def _claims(ball: SlidBall) -> list[Claim]:
    at, cells, volume = ball.inside
    known = exact().stress(at)
    ours = ball.tractions.stress(at)
    force = ball.solution.contacts[0].force
    reference = analytical(SOURCE)
    return [
        analytical("Coulomb's law, everything slides").relative(
            "friction force over P", abs(float(force[0] / force[2])), FRICTION, 1e-6
        ),
        reference.bound("stress below the computed tractions, relative L2 error", _error(volume, ours, known), 0.01),
        reference.relative(
            "largest von Mises stress there over p0", float(von_mises(ours).max()) / PEAK,
            float(von_mises(known).max()) / PEAK, 0.01,
        ),
        reference.bound("stress in the cells, relative L2 error", _error(volume, cells, known), 0.03),
    ]


def _error(volume: Floats, found: Floats, known: Floats) -> float:
    return relative_l2(volume, found.reshape(-1, 9), known.reshape(-1, 9))


def _draw(figure: Figure, ball: SlidBall) -> None:
    for axes, depth in zip(figure.subplots(1, 2, sharey=True), (0.35, 0.7)):
        _along(axes, ball, depth)
    figure.axes[0].set_ylabel("stress / p0")
    figure.axes[1].legend(loc="lower right")


def _along(axes: Axes, ball: SlidBall, depth: float) -> None:
    """σ_x, σ_z and τ_xz along the sliding at a depth."""
    x = np.linspace(-2.0, 2.0, 161)
    at = CONTACT * np.column_stack([x, 0.0 * x, np.full_like(x, depth)])
    known, ours = exact().stress(at) / PEAK, ball.tractions.stress(at) / PEAK
    for (a, b), name, colour in (((0, 0), "σ_x", PINION), ((2, 2), "σ_z", TEETH[2]), ((0, 2), "τ_xz", TEETH[0])):
        axes.plot(x, known[:, a, b], color=INK, lw=1.0)
        axes.plot(x[::4], ours[::4, a, b], "o", ms=3.0, color=colour, label=f"{name}, computed tractions")
    axes.plot([], [], color=INK, lw=1.0, label="exact")
    axes.set(title=f"{depth:g} a deep", xlabel="x / a (the ball slides to the right)")
