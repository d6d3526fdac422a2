"""Stress on a body's free surface from the displacements of its nodes alone, as strain gauges find it.

A free surface bears no traction, so that its strain along the surface says everything. Strains are taken at the points
of the facets at which derivatives of shape functions converge one order faster than elsewhere (Barlow 1976). Stresses
there are turned with the normal to that of a node, continued to it facet by facet, and averaged. No cell is looked at:
displacements of surface nodes may come from a condensed body.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.sparse import csr_matrix

from evolvent.fem.lagrange import node_points
from evolvent.fem.material import Material
from evolvent.fem.reference_facets import area_vector, monomials, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats

BARLOW = 0.5 / np.sqrt(3.0)
"""Distance of these points from the middle of an interval, whose length is 1."""
AT_ONCE = 64
"""Displacements whose stresses are found together; more would take more memory and no less time."""


def surface_stress(surface: Surface, material: Material, displacement: Floats) -> Floats:
    """Stress tensors (..., n, 3, 3) [MPa] at the nodes of a free surface; in 2D of plane strain, with σ_zz = ν σ_tt.

    displacement: (..., n, d) of its nodes [mm].
    """
    points, continued = _sampling(surface.shape, surface.order)
    every, several = np.arange(len(surface.facets)), displacement.reshape(-1, *displacement.shape[-2:])
    places = np.broadcast_to(points, (len(every), *points.shape))
    tangents = surface.evaluate(surface.points, every, places)[1]
    turns = _turns(_unit(area_vector(tangents)), _unit(surface.normals)[surface.facets])
    a, mean = np.stack(tangents, axis=-2)[:, :, None], _nodal_mean(surface)
    result = np.empty((*several.shape[:-1], 3, 3))
    for first in range(0, len(several), AT_ONCE):
        u = several[first : first + AT_ONCE]
        slopes = surface.evaluate(np.swapaxes(u, 0, 1).reshape(len(surface.points), -1), every, places)[1]
        change = np.stack([each.reshape(*each.shape[:2], *u.shape[::2]) for each in slopes], axis=-2)
        sampled = _stress(a, change, material)
        of_facets = np.einsum("kq,mkqac,mqpcd,mkqbd->mkpab", continued, turns, sampled, turns, optimize=True)
        nodal = (mean @ of_facets.reshape(mean.shape[1], -1)).reshape(-1, len(u), 3, 3)
        result[first : first + AT_ONCE] = np.swapaxes(nodal, 0, 1)
    return result.reshape(*displacement.shape[:-1], 3, 3)


def principal_stresses(stress: Floats) -> Floats:
    """Principal stresses (..., 3), ascending [MPa], of stress tensors (..., 3, 3) of a free surface: one of them is
    zero, and the others are the roots of λ² − tr σ λ + (sum of the principal minors) = 0."""
    xx, yy, zz, xy, yz, zx = (stress[..., i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)))
    half = 0.5 * (xx + yy + zz)
    minors = xx * yy - xy**2 + yy * zz - yz**2 + zz * xx - zx**2
    radius = np.sqrt(np.maximum(half**2 - minors, 0.0))
    return np.asarray(np.sort(np.stack([half - radius, np.zeros_like(half), half + radius], axis=-1), axis=-1))


def _nodal_mean(surface: Surface) -> csr_matrix:
    """The matrix (n, m k) that averages values at the k nodes of m facets at each node."""
    nodes = surface.facets.ravel()
    share = 1.0 / np.bincount(nodes, minlength=len(surface.points))[nodes]
    return csr_matrix((share, (nodes, np.arange(len(nodes)))), shape=(len(surface.points), len(nodes)))


def _stress(a: Floats, change: Floats, material: Material) -> Floats:
    """Stress (..., 3, 3) from tangents a (..., dt, d) and their change (..., dt, d), without a traction on the surface:
    in 3D plane stress in the tangent plane, in 2D plane strain along the tangent. The leading axes are broadcast."""
    metric = np.linalg.inv(a @ np.swapaxes(a, -1, -2))
    strain = change @ np.swapaxes(a, -1, -2)
    strain = metric @ (0.5 * (strain + np.swapaxes(strain, -1, -2))) @ metric
    trace = np.einsum("...ij,...ij->...", a @ np.swapaxes(a, -1, -2), strain)[..., None, None]
    E, ν = material.youngs_modulus, material.poissons_ratio
    local = E / (1.0 - ν**2) * ((1.0 - ν) * strain + ν * trace * metric)
    d = a.shape[-1]
    stress = np.zeros((*local.shape[:-2], 3, 3))
    stress[..., :d, :d] = np.swapaxes(a, -1, -2) @ local @ a
    if d == 2:
        stress[..., 2, 2] = ν * (stress[..., 0, 0] + stress[..., 1, 1])
    return stress


def _unit(normals: Floats) -> Floats:
    """Unit vectors (..., 3) of normals (..., d)."""
    n = np.zeros((*normals.shape[:-1], 3))
    n[..., : normals.shape[-1]] = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    return n


def _turns(normals: Floats, nodal: Floats) -> Floats:
    """Smallest rotations (m, k, q, 3, 3) from the normals (m, q, 3) at q points of a facet to those (m, k, 3) of its k
    nodes, by Rodrigues' formula."""
    a, b = normals[:, None], nodal[:, :, None]
    sine = b[..., :, None] * a[..., None, :]
    sine = sine - np.swapaxes(sine, -1, -2)  # v ↦ (a × b) × v
    cosine = np.einsum("...a,...a->...", a, b)[..., None, None]
    return np.asarray(np.eye(3) + sine + sine @ sine / (1.0 + cosine))


@cache
def _sampling(shape: str, order: int) -> tuple[Floats, Floats]:
    """Points (q, dt) of a facet at which strains are taken, and the matrix (k, q) that continues values there to the
    nodes, by polynomials that are one order less than the shape functions in each direction."""
    cell = reference_cell(shape, 1)
    if order == 1:
        points = cell.centre[None]
    elif shape == "triangle":
        points = np.array([[1.0, 1.0], [4.0, 1.0], [1.0, 4.0]]) / 6.0
    else:
        points = cell.centre + 2.0 * BARLOW * (cell.corners - cell.centre)
    nodes = node_points(shape, order)
    if order == 1:
        return points, np.ones((len(nodes), 1))
    at_points, at_nodes = (monomials(cell, xi)[0] for xi in (points, nodes))
    return points, at_nodes @ np.linalg.inv(at_points)
