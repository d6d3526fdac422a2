"""A quarter of a punch on a quarter of a block, pressed together over an ellipse; what Hertz says of it, as claims."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from evidence.claims import Claim, Source, analytical
from evidence.fits import relative_l2
from evidence.verification.references.half_space import Ellipse
from evidence.verification.references.hertz_figure import HertzFigure
from evidence.verification.references.subsurface import (
    AxisStress,
    SubsurfaceHertz,
    axis_compression,
    axis_stress,
    subsurface_claims,
)
from evolvent import Contact, Problem, Solution, solve
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData


@dataclass(frozen=True)
class Quarter:
    """A quarter of two bodies in contact.

    punch, block: meshes of the quarter x, y > 0, with the facet groups of `shapes.ellipse` or `shapes.rings`.
    exact: the contact that Hertz expects.
    depth: at which the approach is taken [mm].
    name: of the punch.
    """

    punch: MeshData
    block: MeshData
    exact: Ellipse
    depth: float
    name: str = "punch"

    @property
    def load(self) -> float:
        """P = ⅔π p0 a b [N], on the whole contact."""
        return 2 / 3 * np.pi * self.exact.peak * self.exact.a * self.exact.b

    def problem(self) -> Problem:
        """The punch's top is pushed down as a rigid body; the punch, the coarser body, carries the pressure."""
        symmetry = (Fixed("symmetry_x", "x"), Fixed("symmetry_y", "y"))
        down = Rigid("top", (Freedom("z", load=-self.load / 4),))
        bodies = (
            Body(self._near(self.punch, "arc"), self.exact.material, symmetry, rigid=down, name=self.name),
            Body(self._near(self.block, "top"), self.exact.material, (*symmetry, Fixed("bottom")), name="block"),
        )
        return Problem(bodies, (Contact((0, "near"), (1, "near"), reach=0.1 * self.exact.b),))

    def _near(self, mesh: MeshData, group: str) -> MeshData:
        """With a facet group "near": within 1.5 times the ellipse."""
        facets = mesh.facets[group]
        x, y = mesh.points[facets, :2].mean(axis=1).T
        return replace(mesh, facets={**mesh.facets, "near": facets[self.radius(x, y) < 1.5]})

    def radius(self, x: Floats, y: Floats) -> Floats:
        """1 on the edge of the ellipse."""
        return np.hypot(x / self.exact.a, y / self.exact.b)

    def solved(self) -> Pressed:
        """Raises NotConverged."""
        return Pressed(self, solve(self.problem()))


@dataclass(frozen=True)
class Pressed:
    """A quarter and its solution."""

    quarter: Quarter
    solution: Solution

    @cached_property
    def fitted(self) -> tuple[float, float, float]:
        """p0 [MPa], a, b [mm] of the ellipsoid that fits the pressure over the inner 70 % of the ellipse."""
        contact = self.solution.contacts[0]
        x, y = contact.points[:, :2].T
        inner = self.quarter.radius(x, y) < 0.7
        terms = np.column_stack([np.ones(inner.sum()), x[inner] ** 2, y[inner] ** 2])
        top, along, across = np.linalg.lstsq(terms, contact.pressure[inner] ** 2, rcond=None)[0]
        return float(np.sqrt(top)), float(np.sqrt(-top / along)), float(np.sqrt(-top / across))

    @property
    def profile_error(self) -> float:
        """Relative L2 distance of the pressure from Hertz'."""
        contact, peak = self.solution.contacts[0], self.quarter.exact.peak
        radius = self.quarter.radius(*contact.points[:, :2].T)
        exact = peak * np.sqrt(np.maximum(0.0, 1 - radius**2))
        return relative_l2(contact.weights, contact.pressure, exact)

    @cached_property
    def stresses(self) -> tuple[AxisStress, ...]:
        """On the axis of each body."""
        return tuple(
            axis_stress(mesh, self.quarter.exact.material, self.solution.displacement(i))
            for i, mesh in enumerate((self.quarter.punch, self.quarter.block))
        )

    def claims(self, source: Source) -> tuple[Claim, ...]:
        """Pressure, half-axes, approach and the stresses below the surface."""
        exact = self.quarter.exact
        wanted = (("peak pressure p0 [MPa]", exact.peak), ("half-axis a [mm]", exact.a), ("half-axis b [mm]", exact.b))
        surface = [source.relative(what, value, known, 0.005) for value, (what, known) in zip(self.fitted, wanted)]
        profile = source.bound("pressure, relative error in L2", self.profile_error, 0.025)
        return (*surface, profile, self._approach_claim(), *self._below_claims())

    def _approach_claim(self) -> Claim:
        """The sum of both bodies, between points on the axis about `depth` below the surfaces."""
        exact = self.quarter.exact
        compressions = [
            axis_compression(mesh, self.solution.displacement(i), self.quarter.depth)
            for i, mesh in enumerate((self.quarter.punch, self.quarter.block))
        ]
        wanted = sum(exact.sinking(0.0) - exact.sinking(depth) for depth, _ in compressions)
        places = " and ".join(f"{depth / exact.b:.1f} b" for depth, _ in compressions)
        quantity = f"approach of the points {places} below the surfaces [mm]"
        total = sum(compression for _, compression in compressions)
        return analytical("Johnson 1985, Eq. 3.22c integrated").relative(quantity, total, wanted, 0.005)

    def _below_claims(self) -> tuple[Claim, ...]:
        exact = self.quarter.exact
        source = analytical("Johnson 1985, Eq. 3.19 integrated")
        known = SubsurfaceHertz(exact.b, exact.peak, exact.largest_shear(), exact.largest_mises(), source)
        names = (self.quarter.name, "block")
        return tuple(c for name, body in zip(names, self.stresses) for c in subsurface_claims(body, known, name))

    def figure(self, across: str) -> HertzFigure:
        """Pressure over the ellipse's radius, stresses over the depth."""
        contact, exact = self.solution.contacts[0], self.quarter.exact
        depth = exact.b * np.linspace(0.02, 2.0, 200)
        radius = self.quarter.radius(*contact.points[:, :2].T)
        below = AxisStress(depth, exact.stress(depth))
        return HertzFigure(radius, contact.pressure / exact.peak, self.stresses, below, exact.b, exact.peak, across)
