"""The matrix of settings: each sheet varies two of them over the widest range that makes sense, all else nominal.

The nominal problem is a steel cylinder on a steel block, a/R = 0.01, friction 0.3, second-order quadrilaterals of a/4
on meshes that do not match; its error is that of p0 against Hertz. Perturbed meshes are tested with the patch test,
whose exact solution every mesh can represent, the position step with He's spur pair, and point contact in `ball`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from demos.hertz_cylinder import Profile
from demos.two_blocks import FRICTION, Patch
from evidence.robustness.settings.ball import ball
from evidence.robustness.settings.distortion import distorted
from evidence.robustness.settings.gear_steps import spur_pair_at_steps
from evidence.robustness.settings.sheets import Cell, Sheet, sheet_of
from evolvent import Contact, Nitsche, Placement, Problem, Step, solve
from evolvent.contact import hertz
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import Material
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import cylinder_2d, graded_rectangle

RADIUS, HALF_WIDTH, BLOCK = 50.0, 0.5, 100.0  # mm
PEAK_ERROR = "error of p0 against Hertz"


@dataclass(frozen=True)
class Cylinder:
    """The nominal problem and everything of it that varies."""

    safety: float = 2.0
    """γ over its limit."""
    theta: float = 1.0
    friction: float = 0.3
    load: float = 1.0
    """Over the nominal one."""
    ratio: float = 0.73
    """Element size of the block over that of the cylinder."""
    nu: float = 0.3
    gap: float = 0.0
    """Between the bodies at the start [mm]; negative: overlap."""
    order: int = 2
    shape: str = "quadrilateral"
    first: str = "block"
    """The body that carries the pressure."""
    cells: float = 4.0
    """On the half-width of contact, of the cylinder."""

    @property
    def half_width(self) -> float:
        """a [mm], which grows with √load."""
        return HALF_WIDTH * float(np.sqrt(self.load))

    @property
    def modulus(self) -> float:
        return hertz.contact_modulus(210e3, self.nu, 210e3, self.nu)

    @property
    def force(self) -> float:
        """P [N/mm]."""
        return float(np.pi * self.modulus * self.half_width**2 / (4.0 * RADIUS))

    @property
    def peak(self) -> float:
        return hertz.line_peak_pressure(self.force, RADIUS, self.modulus)

    def problem(self) -> Problem:
        a, steel = self.half_width, Material(210e3, self.nu)
        size, fine = a / self.cells, 1.5 * a
        press = Rigid("top", (Freedom("y", load=-self.force), Freedom("x", displacement=0.0)))
        upper = cylinder_2d(RADIUS, size, fine, self.order, self.shape)
        lower = graded_rectangle(BLOCK, BLOCK, size * self.ratio, fine, self.order, self.shape)
        bodies = (Body(upper, steel, rigid=press), Body(lower, steel, supports=(Fixed("bottom"),)))
        sides = ((1, "top"), (0, "arc")) if self.first == "block" else ((0, "arc"), (1, "top"))
        reach = max(0.25 * a, 2.0 * abs(self.gap))
        return Problem(bodies, (Contact(*sides, self.friction, reach=reach),), Nitsche(self.safety, self.theta))

    def cell(self) -> Cell:
        """Iterations, and the error of the fitted p0."""
        raised = (Placement(np.eye(2), np.array([0.0, self.gap])), Placement.at_rest(2))
        solution = solve(self.problem(), Step(placements=raised))
        peak = Profile.of(solution.contacts[0], self.half_width).peak
        return Cell(solution.iterations, abs(peak / self.peak - 1.0))


def stabiliser() -> Sheet:
    """γ over its limit × θ. Below about 1.2 the symmetric method's stiffness is not positive definite."""
    safeties, thetas = (0.1, 0.5, 1.1, 2.0, 5.0, 20.0, 50.0, 200.0, 1000.0), (1.0, 0.0, -1.0)
    return sheet_of(
        ("stabiliser", "Four decades of the stabiliser γ, all variants θ", PEAK_ERROR),
        ("θ", thetas),
        ("γ over the inverse-trace constant", safeties),
        lambda i, j: Cylinder(safeties[j], thetas[i]).cell(),
    )


def friction_and_load() -> Sheet:
    """μ × load; the mesh follows the contact's width."""
    frictions, loads = (0.0, 0.1, 0.3, 0.6, 1.0), (1e-3, 1e-2, 0.1, 1.0, 10.0)
    return sheet_of(
        ("friction_load", "Friction coefficient, and load over four decades", PEAK_ERROR),
        ("μ", frictions),
        ("load over nominal", loads),
        lambda i, j: Cylinder(friction=frictions[i], load=loads[j]).cell(),
    )


def mesh_ratio() -> Sheet:
    """Element sizes across the contact, and which body carries the pressure, in both orders."""
    ratios = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0)
    rows = [(order, first) for order in (2, 1) for first in ("block", "cylinder")]
    return sheet_of(
        ("mesh_ratio", "Element size of the block over the cylinder's, 1:8 to 8:1", PEAK_ERROR),
        ("order, pressure on", [f"{order}, {first}" for order, first in rows]),
        ("size of the block's cells over the cylinder's", ["1:8", "1:4", "1:2", "1:1", "2:1", "4:1", "8:1"]),
        lambda i, j: _on_finer(ratios[j], *rows[i]),
    )


def _on_finer(ratio: float, order: int, first: str) -> Cell:
    """The coarser body has cells of a/4."""
    return Cylinder(ratio=ratio, order=order, first=first, cells=4.0 * max(ratio, 1.0)).cell()


def incompressible() -> Sheet:
    """ν × cells. Plane strain near ν = 0.5 locks in first order."""
    ratios = (0.0, 0.3, 0.45, 0.49, 0.499)
    kinds = [(shape, order) for shape in ("quadrilateral", "triangle") for order in (2, 1)]
    return sheet_of(
        ("poisson", "Poisson's ratio to 0.499, cells and orders", PEAK_ERROR),
        ("cells, order", [f"{shape}, {order}" for shape, order in kinds]),
        ("ν", ratios),
        lambda i, j: Cylinder(nu=ratios[j], shape=kinds[i][0], order=kinds[i][1]).cell(),
    )


def initial_gap() -> Sheet:
    """Gap and overlap at the start, in multiples of a²/2R, the depth to which Hertz' bodies come together."""
    gaps, frictions = (-30.0, -3.0, -1.0, 0.0, 1.0, 3.0, 30.0), (0.0, 0.3, 1.0)
    depth = HALF_WIDTH**2 / (2.0 * RADIUS)
    return sheet_of(
        ("gap", "The bodies start apart (positive) or overlap (negative)", PEAK_ERROR),
        ("μ", frictions),
        ("initial gap over a²/2R", gaps),
        lambda i, j: Cylinder(gap=gaps[j] * depth, friction=frictions[i]).cell(),
    )


def distortion() -> Sheet:
    """Patch test on meshes whose inner nodes are moved at random."""
    targets = (0.8, 0.4, 0.2, 0.1)
    shapes = ("triangle", "quadrilateral", "tetrahedron", "hexahedron")
    kinds = [Patch(shape, order, friction=FRICTION) for shape in shapes for order in (1, 2)]
    return sheet_of(
        ("distortion", "Meshes perturbed at random (patch test)", "largest error of the traction"),
        ("cells, order", [f"{patch.shape}, {patch.order}" for patch in kinds]),
        ("smallest scaled Jacobian over the regular mesh's", targets),
        lambda i, j: patch_cell(kinds[i], targets[j]),
    )


def patch_cell(patch: Patch, target: float) -> Cell:
    """The patch test on meshes perturbed to a share `target` of their smallest scaled Jacobian."""
    problem = patch.problem()
    meshes: list[MeshData] = [distorted(body.mesh, target, seed) for seed, body in enumerate(problem.bodies)]
    bodies = tuple(replace(body, mesh=mesh) for body, mesh in zip(problem.bodies, meshes, strict=True))
    solution = solve(replace(problem, bodies=bodies))
    return Cell(solution.iterations, float(patch.errors(solution).max()))


SHEETS: tuple[Callable[[], Sheet], ...] = (
    stabiliser, friction_and_load, mesh_ratio, incompressible, initial_gap, ball, distortion, spur_pair_at_steps,
)
