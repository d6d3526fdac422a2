"""Stress on a body's free surface from the displacements of its nodes alone, as strain gauges find it.

A free surface bears no traction, so that its strain along the surface says everything. Strains are taken at the points
of the facets at which derivatives of shape functions converge one order faster than elsewhere (Barlow 1976). Stresses
there are turned with the normal to that of a node, continued to it facet by facet, and averaged. No cell is looked at:
displacements of surface nodes may come from a condensed body.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from evolvent.fem.lagrange import node_points
from evolvent.fem.material import Material
from evolvent.fem.reference_facets import area_vector, monomials, reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats

BARLOW = 0.5 / np.sqrt(3.0)
"""Distance of these points from the middle of an interval, whose length is 1."""


def surface_stress(surface: Surface, material: Material, displacement: Floats) -> Floats:
    """Stress tensors (n, 3, 3) [MPa] at the nodes of a free surface; in 2D of plane strain, with σ_zz = ν σ_tt.

    displacement: (n, d) of its nodes [mm].
    """
    points, continued = _sampling(surface.shape, surface.order)
    every = np.arange(len(surface.facets))
    places = np.broadcast_to(points, (len(every), *points.shape))
    tangents, slopes = (surface.evaluate(field, every, places)[1] for field in (surface.points, displacement))
    sampled = _stress(np.stack(tangents, axis=-2), np.stack(slopes, axis=-2), material)
    turns = _turns(_unit(area_vector(tangents)), _unit(surface.normals)[surface.facets])
    nodal = np.einsum("kq,mkqac,mqcd,mkqbd->mkab", continued, turns, sampled, turns, optimize=True)
    total = np.zeros((len(surface.points), 3, 3))
    np.add.at(total, surface.facets.ravel(), nodal.reshape(-1, 3, 3))
    count = np.bincount(surface.facets.ravel(), minlength=len(total))
    return np.asarray(total / np.maximum(count, 1)[:, None, None])


def _stress(a: Floats, change: Floats, material: Material) -> Floats:
    """Stress (..., 3, 3) from tangents a (..., dt, d) and their change (..., dt, d), without a traction on the surface:
    in 3D plane stress in the tangent plane, in 2D plane strain along the tangent."""
    metric = np.linalg.inv(a @ np.swapaxes(a, -1, -2))
    strain = change @ np.swapaxes(a, -1, -2)
    strain = metric @ (0.5 * (strain + np.swapaxes(strain, -1, -2))) @ metric
    trace = np.einsum("...ij,...ij->...", a @ np.swapaxes(a, -1, -2), strain)[..., None, None]
    E, ν = material.youngs_modulus, material.poissons_ratio
    local = E / (1.0 - ν**2) * ((1.0 - ν) * strain + ν * trace * metric)
    d = a.shape[-1]
    stress = np.zeros((*a.shape[:-2], 3, 3))
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
