"""The pressure of a round contact by any program: its force, its peak, its error against a reference."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from evidence.benchmarks.comparison.task import Answer, Task
from evidence.fits import half_ellipse, relative_l2
from evolvent.fem.lagrange import gmsh_permutation, quadrature, tabulate
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import FACET_SHAPE

DEGREE = 8  # of the rule for a pressure between nodes


@dataclass(frozen=True)
class Pressure:
    """The pressure over the distance from the middle of the contact.

    radius:  (n,), distances [mm].
    value:   (n,), pressures [MPa].
    weights: (n,), of the quadrature [mm or mm²].
    """

    radius: Floats
    value: Floats
    weights: Floats

    @staticmethod
    def of(task: Task, answer: Answer) -> Pressure:
        """At the points where the program has it, or as the Lagrange field between its nodal values."""
        if answer.points is None or answer.weights is None:
            points, value, weights = _between_nodes(task, answer)
        else:
            points, value, weights = answer.points, answer.pressure, answer.weights
        radius = np.hypot(points[:, 0], points[:, 1]) if task.dimension == 3 else np.abs(points[:, 0])
        return Pressure(radius, value, weights)

    @property
    def force(self) -> float:
        """∫p [N; N/mm in 2D], of the part that was meshed."""
        return float(self.weights @ self.value)

    def peak(self, half_width: float) -> float:
        """p0 [MPa] of the half-ellipse that fits the middle best."""
        return half_ellipse(self.radius, self.value, half_width).peak

    def error(self, reference: Reference) -> float:
        """Relative L2 distance from the reference, over the whole contact surface."""
        return relative_l2(self.weights, self.value, reference(self.radius))


def _between_nodes(task: Task, answer: Answer) -> tuple[Floats, Floats, Floats]:
    """Points (n, 3), pressure (n,) and weights (n,) of a rule on the facets that carry the pressure."""
    mesh = task.bodies[answer.body]
    shape = FACET_SHAPE[mesh.shape]
    facets = mesh.facets[task.contact[answer.body]][:, gmsh_permutation(shape, mesh.order)]
    nodal = np.zeros(len(mesh.points))
    nodal[answer.nodes] = answer.pressure
    xi, rule = quadrature(shape, DEGREE)
    N, dN = tabulate(shape, mesh.order, xi)
    corners = mesh.points[facets]
    tangents = np.einsum("qtk,fkd->fqtd", dN, corners)
    if tangents.shape[2] == 1:
        measure = np.linalg.norm(tangents[:, :, 0], axis=-1)
    else:
        measure = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=-1)
    points = np.einsum("qk,fkd->fqd", N, corners).reshape(-1, 3)
    return points, (nodal[facets] @ N.T).ravel(), (measure * rule).ravel()


@dataclass(frozen=True)
class Reference:
    """A smooth pressure √(1 − s)(c0 + c1 s), s = (r/a)²: Hertz' ellipse with what finite bodies change of it.

    half_width: a [mm]. coefficients: c [MPa].
    """

    half_width: float
    coefficients: tuple[float, float]

    @staticmethod
    def fitted(pressure: Pressure, half_width: float, dimension: int) -> Reference:
        """The best fit in L2 to an overkill solution within 93 % of `half_width`, which is near a, of those with its
        force. The cells at the edge are left out: they have nearly all of an overkill solution's error.
        """
        inner = (pressure.radius < 0.93 * half_width) & (pressure.weights > 0.0)
        radius, value, root = pressure.radius[inner], pressure.value[inner], np.sqrt(pressure.weights[inner])
        unit = [Reference(1.0, c).force(dimension) for c in ((1.0, 0.0), (0.0, 1.0))]

        def reference(x: Floats) -> Reference:
            a, c0 = x[0] * half_width, x[1] * float(value.max())
            return Reference(a, (c0, (pressure.force / a ** (dimension - 1) - c0 * unit[0]) / unit[1]))

        return reference(least_squares(lambda x: root * (reference(x)(radius) - value), [1.0, 1.0]).x)

    def __call__(self, radius: Floats) -> Floats:
        """Pressure (n,) [MPa] at distances (n,) [mm] from the middle."""
        s = (radius / self.half_width) ** 2
        return np.asarray(np.sqrt(np.maximum(0.0, 1.0 - s)) * (self.coefficients[0] + self.coefficients[1] * s))

    def force(self, dimension: int) -> float:
        """∫p over the whole contact in 2D [N/mm]; over a quarter of it in 3D [N]."""
        (c0, c1), a = self.coefficients, self.half_width
        if dimension == 2:
            return float(np.pi / 2 * a * (c0 + c1 / 4))
        return float(np.pi / 2 * a**2 * (c0 / 3 + c1 * 2 / 15))

    def distance(self, other: Reference, dimension: int) -> float:
        """Relative L2 difference."""
        r = np.linspace(0.0, 1.2 * self.half_width, 4001)
        return relative_l2(r ** (dimension - 2), self(r), other(r))
