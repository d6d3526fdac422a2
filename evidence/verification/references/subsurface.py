"""Stresses of a solution below the middle of a contact, on the axis on which the largest ones lie."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from evidence.claims import Claim, Source
from evolvent.contact.hertz import SubsurfaceMaximum
from evolvent.fem.lagrange import gmsh_permutation, node_points, tabulate
from evolvent.fem.material import Material
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData

GAUSS = (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3))
"""Places on a cell's edge where the stress of second-order cells is most accurate."""

WINDOW, POINTS = 0.3, 8
"""Of the fit around the largest stress: half-widths to each side, but at least so many points. A line's largest shear
changes its direction 0.5 half-widths above its maximum."""


def shear(principal: Floats) -> Floats:
    """Largest shear (n,) of principal stresses (n, 3)."""
    return np.asarray(0.5 * np.ptp(principal, axis=1))


def mises(principal: Floats) -> Floats:
    """Von Mises stress (n,) of principal stresses (n, 3)."""
    first, second, third = principal.T
    return np.asarray(np.sqrt(0.5 * ((first - second) ** 2 + (second - third) ** 2 + (third - first) ** 2)))


@dataclass(frozen=True)
class AxisStress:
    """Stresses below a contact, on its axis.

    depth:  (n,), below the undeformed surface, rising [mm].
    stress: (n, 3), σ_xx, σ_yy, σ_zz [MPa]; in 2D y is up.
    """

    depth: Floats
    stress: Floats

    def largest(self, measure: Callable[[Floats], Floats], width: float) -> tuple[float, float]:
        """Value and depth [mm] of the largest `measure` (shear, mises), by a quartic through the points around it."""
        value = measure(self.stress)
        distance = np.abs(self.depth - self.depth[np.argmax(value)])
        near = distance <= max(WINDOW * width, np.sort(distance)[POINTS - 1])
        fit = Polynomial.fit(self.depth[near], value[near], 4)
        depth = np.linspace(self.depth[near][0], self.depth[near][-1], 4001)
        at = int(np.argmax(fit(depth)))
        return float(fit(depth)[at]), float(depth[at])


@dataclass(frozen=True)
class SubsurfaceHertz:
    """Hertz' theory of a contact.

    width:  half-width [mm].
    peak:   peak pressure [MPa].
    shear:  largest shear stress, as multiples of both.
    mises:  largest von Mises stress, as multiples of both.
    source: of the two.
    """

    width: float
    peak: float
    shear: SubsurfaceMaximum
    mises: SubsurfaceMaximum
    source: Source


def axis_stress(mesh: MeshData, material: Material, displacement: Floats) -> AxisStress:
    """Stresses on the cells' edges along the axis x = 0 (2D) or x = y = 0 (3D), the mean of the cells at each place.

    The axis has to be a line of edges, and the contact at its height 0; displacement: (N, d) [mm].
    """
    d, corners = mesh.dimension, node_points(mesh.shape, 1)
    nodes = mesh.cells[:, gmsh_permutation(mesh.shape, mesh.order)]
    place = mesh.points[nodes[:, : len(corners)], :d]
    on_axis = np.abs(place[..., : d - 1]).max(axis=2) < 1e-9 * np.ptp(mesh.points)
    rows = np.flatnonzero(on_axis.sum(axis=1) == 2)
    depth, stress = [], []
    for row in rows:
        one, two = corners[on_axis[row]]
        xi = np.array([one + s * (two - one) for s in GAUSS])
        N, dN = tabulate(mesh.shape, mesh.order, xi)
        x, u = mesh.points[nodes[row], :d], displacement[nodes[row]]
        slope = np.einsum("ka,qtk,qtb->qab", u, dN, np.linalg.inv(np.einsum("ka,qtk->qat", x, dN)))
        depth.append(np.abs(N @ x[:, d - 1]))
        stress.append(_normal_stresses(slope, material))
    return _averaged(np.concatenate(depth), np.concatenate(stress))


def _normal_stresses(slope: Floats, material: Material) -> Floats:
    """σ_xx, σ_yy, σ_zz (q, 3) of displacement gradients (q, d, d)."""
    λ, μ = material.lame
    strain = np.zeros((len(slope), 3))
    strain[:, : slope.shape[1]] = np.einsum("qaa->qa", slope)
    return np.asarray(λ * strain.sum(axis=1, keepdims=True) + 2 * μ * strain)


def _averaged(depth: Floats, stress: Floats) -> AxisStress:
    places, which = np.unique(np.round(depth, 9), return_inverse=True)
    which = which.reshape(-1)
    count = np.bincount(which)
    return AxisStress(places, np.stack([np.bincount(which, s) / count for s in stress.T], axis=1))


def axis_compression(mesh: MeshData, displacement: Floats, depth: float) -> tuple[float, float]:
    """Depth [mm] of the node on the axis that is nearest to `depth`, and by how much it comes nearer to the
    surface [mm]. displacement: (N, d) [mm]."""
    up = mesh.dimension - 1
    axis = np.flatnonzero(np.abs(mesh.points[:, :up]).max(axis=1) < 1e-9 * np.ptp(mesh.points))
    below = np.abs(mesh.points[axis, up])
    top, node = np.argmin(below), np.argmin(np.abs(below - depth))
    return float(below[node]), float(abs(displacement[axis[top], up] - displacement[axis[node], up]))


def subsurface_claims(stress: AxisStress, hertz: SubsurfaceHertz, body: str) -> tuple[Claim, ...]:
    """Size and depth of the largest shear and von Mises stress of a body, held against Hertz' theory."""
    claims = []
    for name, measure, exact in (("shear", shear, hertz.shear), ("von Mises", mises, hertz.mises)):
        value, depth = stress.largest(measure, hertz.width)
        largest = f"largest {name} stress below the surface of the {body} [MPa]"
        claims += [
            hertz.source.relative(largest, value, exact.value * hertz.peak, 0.01),
            hertz.source.relative("its depth [mm]", depth, exact.depth * hertz.width, 0.02),
        ]
    return tuple(claims)
