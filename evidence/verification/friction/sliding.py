"""A cylinder slides over a block: tension at the trailing edge of the contact (Johnson 1985, section 7.1)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from demos.hertz_cylinder import Profile, Slip
from evidence.claims import Claim, Verification, analytical
from evidence.fits import relative_l2
from evolvent import Contact, Placement, Problem, Solution, Step, sweep
from evolvent.contact import hertz
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.lagrange import tabulate
from evolvent.fem.material import STEEL
from evolvent.fem.stress import cell_stress
from evolvent.fem.surface import surface_of
from evolvent.results.drawing.style import FAINT, INK, PINION, TEETH, WHEEL
from evolvent.strength.fatigue.half_plane import LineForces
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import cylinder_2d, graded_rectangle
from evolvent_meshes.shapes.variants import with_part

CASE = Slip(half_width=0.1)  # R = 50 mm, μ = 0.3; small, so that block and base are a half-space to 0.2 %
CELLS = (8, 16, 32, 64)  # on the half-width, of the block
TOUCHING = 1.25  # half-widths to both sides that are fine and may touch
SLID = 0.1  # half-widths: a hundred times what the contact gives way before it slides
DEPTHS = (0.15, 2.0)  # [b] between which the stress inside is compared
NODES = 200  # of the quadrature of the exact stress inside
SOURCE = "Johnson 1985, section 7.1, traction μp to the right"


@dataclass(frozen=True)
class Slid:
    """The block after the cylinder has slid to the right over it, on one mesh."""

    cells: int
    solution: Solution

    @cached_property
    def block(self) -> MeshData:
        return self.solution.condensed[1].assembled.body.mesh

    @cached_property
    def displacement(self) -> Floats:
        """(N, 2) of the block's nodes [mm]."""
        return self.solution.displacement(1)

    @cached_property
    def pressed(self) -> Profile:
        """Pressure and traction."""
        return Profile.of(self.solution.contacts[0], CASE.half_width)

    def surface(self, xi: Floats) -> tuple[Floats, Floats]:
        """(x/b, σ_xx/p0) at reference points xi (q,) of each facet of the block's top, sorted along x.

        Plane strain with σ_yy = −p, the contact's own pressure, and ε_xx along the surface from the displacement:
        σ_xx = E/(1 − ν²) ε_xx + ν/(1 − ν) σ_yy.
        """
        top = surface_of(self.block, "top")
        N, dN = tabulate(top.shape, top.order, xi[:, None])
        nodes = top.nodes[top.facets]
        x = np.einsum("qk,fk->fq", N, self.block.points[nodes, 0]).ravel()
        length = np.einsum("qk,fk->fq", dN[:, 0], self.block.points[nodes, 0]).ravel()
        stretch = np.einsum("qk,fk->fq", dN[:, 0], self.displacement[nodes, 0]).ravel() / length
        p, ν = self.pressed, STEEL.poissons_ratio
        stress = STEEL.plane_modulus * stretch - ν / (1.0 - ν) * np.interp(x, p.x, p.pressure, 0.0, 0.0)
        order = np.argsort(x)
        return x[order] / CASE.half_width, stress[order] / CASE.peak

    @cached_property
    def trailing(self) -> float:
        """Largest σ_xx/p0 on the surface, with the facets' ends: the exact one has a cusp where a facet ends."""
        return float(self.surface(np.linspace(0.0, 1.0, 9))[1].max())

    @cached_property
    def surface_error(self) -> float:
        """Relative L2 error of σ_xx on |x| < 2b at the facets' Gauss points."""
        x, computed = self.surface(0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0))
        near = np.abs(x) < 2.0
        return relative_l2(np.gradient(x[near]), computed[near], surface_stress(x[near]))

    @cached_property
    def inside(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Of the cells around the contact: centres (n, 2) and corners (n, 4, 2) over b, σ (n, 2, 2) and areas (n,)."""
        corners = self.block.points[self.block.cells[:, :4], :2] / CASE.half_width
        centre = corners.mean(axis=1)
        near = (np.abs(centre[:, 0]) < 2.5) & (centre[:, 1] > -2.5)
        stress = cell_stress(self.block, STEEL, self.displacement)[near, :2, :2] / CASE.peak
        size = np.ptp(corners[near], axis=1).prod(axis=1)
        return centre[near], corners[near], stress, size

    @cached_property
    def inside_error(self) -> float:
        """Relative L2 error of (σ_xx, σ_yy, σ_xy) at the centres of the cells between the depths DEPTHS."""
        centre, _, computed, area = self.inside
        here = (-centre[:, 1] > DEPTHS[0]) & (-centre[:, 1] < DEPTHS[1])
        return relative_l2(area[here], computed[here], inner_stress(centre[here]))

    @cached_property
    def tractions_error(self) -> float:
        """The same of the half-plane under the forces at the contact's quadrature points."""
        c, (centre, _, _, area) = self.solution.contacts[0], self.inside
        here = (-centre[:, 1] > DEPTHS[0]) & (-centre[:, 1] < DEPTHS[1])
        into = np.sign(c.force[1]) * c.weights[:, None] * c.traction  # z of the half-plane points into the block
        forces = LineForces(c.points[:, 0] / CASE.half_width, into[:, 1], -into[:, 0])
        x, depth = centre[here].T
        σx, σz, τ = forces.stress(x, -depth).T / (CASE.peak * CASE.half_width)
        found = np.stack([σx, -τ, -τ, σz], axis=1).reshape(-1, 2, 2)
        return relative_l2(area[here], found, inner_stress(centre[here]))


def slide(cells: int) -> Slid:
    """Pressed at rest, then slid; the block carries the pressure, with its flat normals."""
    size, b = CASE.half_width / cells, CASE.half_width
    freedoms = (Freedom("y", load=-CASE.load), Freedom("x", displacement=0.0))
    disc = cylinder_2d(CASE.radius, size / 1.37, TOUCHING * b, contact=TOUCHING * b, growth=1.6)
    cylinder = Body(disc, STEEL, rigid=Rigid("top", freedoms))
    mesh = graded_rectangle(100.0, 100.0, size, TOUCHING * b, fine_depth=0.2 * b)
    block = Body(with_part(mesh, "top", "touching", TOUCHING * b), STEEL, (Fixed("bottom"),))
    problem = Problem((cylinder, block), (Contact((1, "touching"), (0, "arc"), CASE.friction, reach=0.25 * b),))
    start = Placement(np.eye(2), np.array([-SLID * b, 0.0]))
    before = Step(placements=(start, Placement.at_rest(2)))
    *_, after = sweep(problem, [before, Step()])
    return Slid(cells, after)


def surface_stress(x: Floats) -> Floats:
    """σ_xx/p0 of the surface at x/b: −p, and of the traction μp to the right −2μx, outside −2μ(x ∓ √(x² − 1))."""
    outside = np.sign(x) * np.sqrt(np.maximum(0.0, x**2 - 1.0))
    return -hertz.line_pressure(x, 1.0, 1.0) - 2.0 * CASE.friction * (x - outside)


def inner_stress(points: Floats) -> Floats:
    """σ/p0 (n, 2, 2) at points (n, 2) over b below the surface: Flamant's radial stress of the line loads p and μp,
    summed by the quadrature whose weight is √(1 − s²)."""
    k = np.arange(1, NODES + 1) * np.pi / (NODES + 1)
    s, weight = np.cos(k), np.pi / (NODES + 1) * np.sin(k) ** 2
    away = points[:, None] - np.column_stack([s, 0.0 * s])
    square = np.square(away).sum(axis=2)
    radial = -2.0 / np.pi * (away @ np.array([CASE.friction, -1.0])) / square**2
    return np.einsum("s,ns,nsa,nsb->nab", weight, radial, away, away)


def verify() -> Verification:
    """The same slide on four meshes."""
    cases = [slide(cells) for cells in CELLS]
    return Verification(
        "sliding",
        "Sliding line contact: tension at the trailing edge",
        "A steel cylinder (R = 50 mm, b = 0.1 mm, plane strain) slides to the right over a steel block, μ = 0.3: the "
        "traction is μp everywhere. On the surface σ_xx = −p − 2μp0 x/b under the contact; it peaks at the trailing "
        "edge with +2μp0 in a cusp of infinite slope, of which a mesh of size h misses a share of about √(h/b). σ_xx "
        "comes from the strain along the surface and the contact pressure. Inside the block the stress is the "
        "integral of Flamant's.",
        tuple(_claims(cases)),
        lambda figure: _draw(figure, cases),
        "Friction pulls at the surface behind the contact: a cusp of 2μp0, which a mesh cuts off by a share of √(h/b)",
    )


def _claims(cases: list[Slid]) -> list[Claim]:
    fine, wanted = cases[-1], 2.0 * CASE.friction
    force = fine.solution.contacts[0].force
    ratio = float(np.abs(fine.pressed.shear).max() / (CASE.friction * fine.pressed.pressure.max()))
    tension = [case.trailing for case in cases]
    limit = extrapolated(cases[-2].trailing, cases[-1].trailing)
    coulomb, flamant = analytical("Coulomb's law"), analytical("Flamant's solution integrated")
    edge, cusp = analytical(f"+2μ, {SOURCE}"), analytical(f"+2μ, {SOURCE}; a cusp")
    force_over, sliding = abs(float(force[0])), analytical("Coulomb's law, everything slides")
    return [
        sliding.relative("friction force over μP", force_over, CASE.friction * CASE.load, 1e-8),
        coulomb.relative("largest traction over largest μp", ratio, 1.0, 1e-8),
        cusp.relative(f"σ_xx/p0 at the trailing edge, h = b/{fine.cells}", tension[-1], wanted, 0.1),
        edge.relative("the same, extrapolated to h = 0 with √h", limit, wanted, 0.02),
        analytical(SOURCE).bound(
            f"σ_xx on the surface, relative L2 error, h = b/{fine.cells}", fine.surface_error, 0.01
        ),
        flamant.bound(f"stress inside, relative L2 error, h = b/{fine.cells}", fine.inside_error, 0.01),
        flamant.bound(f"the same below the computed tractions, h = b/{fine.cells}", fine.tractions_error, 0.01),
    ]


def extrapolated(coarse: float, fine: float) -> float:
    """To element size zero from sizes 2h and h of an error that goes like √h."""
    return (np.sqrt(2.0) * fine - coarse) / (np.sqrt(2.0) - 1.0)


def _draw(figure: Figure, cases: list[Slid]) -> None:
    grid = figure.add_gridspec(2, 2, width_ratios=(1.5, 1))
    _surface(figure.add_subplot(grid[:, 0]), cases)
    _convergence(figure.add_subplot(grid[0, 1]), cases)
    _inside(figure.add_subplot(grid[1, 1]), cases[1])


def _surface(axes: Axes, cases: list[Slid]) -> None:
    x = np.concatenate([np.linspace(-2.0, 2.0, 801), [-1.0, 1.0]])
    x.sort()
    axes.axhline(0.0, color=FAINT, lw=0.8)
    axes.plot(x, surface_stress(x), color=INK, lw=1.2, label="exact", zorder=1)
    for case, colour in zip(cases[1::2], (TEETH[2], PINION), strict=True):
        at, computed = case.surface(0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0))
        axes.plot(at, computed, "o", ms=2.6, color=colour, label=f"h = b/{case.cells}")
    axes.annotate("+2μp0 at the trailing edge", (-1.0, 2.0 * CASE.friction), (-0.55, 0.62), color=INK,
                  arrowprops={"arrowstyle": "->", "color": INK}, va="center")
    axes.set(xlim=(-2.0, 2.0), ylim=(-1.35, 0.85), xlabel="x / b (the cylinder slides to the right)",
             ylabel="σ_xx / p0 on the surface")
    axes.legend(loc="lower left")


def _convergence(axes: Axes, cases: list[Slid]) -> None:
    h = np.array([1.0 / case.cells for case in cases])
    tension = np.array([abs(case.trailing / (2.0 * CASE.friction) - 1.0) for case in cases])
    axes.loglog(h, 100.0 * tension, "o-", color=WHEEL, label="trailing-edge tension")
    axes.loglog(h, [100.0 * case.surface_error for case in cases], "s-", color=PINION, label="σ_xx on the surface, L2")
    axes.loglog(h, [100.0 * case.inside_error for case in cases], "^-", color=TEETH[0], label="stress inside, L2")
    axes.loglog(h, 100.0 * tension[0] * np.sqrt(h / h[0]), ":", color=INK, lw=1.0, label="slope ½")
    axes.set_xticks(h, [f"b/{case.cells}" for case in cases])
    axes.set_xticks([], minor=True)
    axes.set(ylim=(0.02, 40), xlabel="element size", ylabel="error [%]")
    axes.legend(loc="lower right", fontsize=7, ncols=2, columnspacing=1.0)


def _inside(axes: Axes, case: Slid) -> None:
    _, corners, stress, _ = case.inside
    shown = PolyCollection(list(corners), array=stress[:, 0, 0], cmap="RdBu_r", edgecolors="none")
    shown.set_clim(-1.0, 1.0)
    axes.add_collection(shown)
    x, y = np.meshgrid(np.linspace(-2.2, 2.2, 120), np.linspace(-2.0, -0.03, 60))
    exact = inner_stress(np.column_stack([x.ravel(), y.ravel()]))[:, 0, 0].reshape(x.shape)
    levels = (-0.6, -0.4, -0.2, -0.1, 0.1, 0.2)
    axes.contour(x, y, exact, levels=levels, colors=INK, linewidths=0.7, linestyles="-")
    axes.grid(visible=False)
    axes.set(xlim=(-2.2, 2.2), ylim=(-2.0, 0.0), aspect="equal", xlabel="x / b", ylabel="y / b")
    axes.figure.colorbar(shown, ax=axes, label="σ_xx / p0 (lines: exact)", shrink=0.9)
