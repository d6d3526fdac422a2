"""Mesh motion (ALE): the nodes of a worn surface move inwards, and the interior nodes follow.

A worn node moves by −h d, d·n = 1, with d tangential to the adjacent free faces: a worn edge stays on its end face and
on its tip cylinder. Inner nodes of second-order facets move slightly more or less, so that every facet loses the volume
that its nodes' hat functions give it. The interior displacement solves a linear equation with these nodes prescribed
and the held groups at rest. Cells are the stiffer the smaller they are, so that large cells take most of the motion.
Facets that continue a worn surface smoothly stay at rest; faces beyond an edge slide tangentially.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import scipy.sparse as sp
import ufl
from scipy.sparse.csgraph import connected_components

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.condensation.schur_complement import Factor
from evolvent.fem.lagrange import gmsh_permutation
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError
from evolvent_meshes.mesh.mesh_data import FACET_SHAPE, MeshData, MeshError
from evolvent_meshes.mesh.quality import check_quality
from evolvent_meshes.mesh.reference_cells import corner_count
from evolvent_meshes.mesh.structured_grid import boundary_facets

InteriorMotion = Literal["elastic", "harmonic"]
"""Equation for the displacement of the interior."""
SMOOTH = 0.87  # cosine (30°) between the normals of neighbouring facets above which they are one smooth surface
NORMAL_PENALTY = 1e6  # on displacements normal to a free face, over the largest diagonal entry of the equation
POISSON = 0.3  # of the elastic equation
MESH_VOLUME_TOLERANCE = 1e-2
"""Largest relative difference between the volume that a mesh has lost and Σ m h. On a curved surface the two differ by
half the depth over the radius; on worn spheres and cylinders by 6e-4."""


class MeshInverted(MeshError):
    """The moved mesh has an inverted cell, or one of a scaled Jacobian below the limit."""


class MeshVolumeLost(MeshError):
    """The moved mesh has not lost the volume that the contact has worn off."""


@dataclass(frozen=True)
class WornSurface:
    """A surface and its worn depth.

    surface: the surface, n nodes.
    depth: (n,) at its nodes [mm].
    """

    surface: Surface
    depth: Floats


def worn_mesh(
    mesh: MeshData, worn: Collection[WornSurface], held: Collection[str], interior: InteriorMotion = "elastic",
    least_quality: float = 0.05,
) -> MeshData:
    """The mesh with its worn surfaces moved inwards by their depths, and the interior following.

    held: facet groups that stay at rest.
    interior: equation for the interior.
    least_quality: smallest scaled Jacobian allowed.

    Raises MeshInverted where a scaled Jacobian is below `least_quality`, and InputError where nothing is held.
    """
    moved = np.concatenate([w.surface.nodes for w in worn])
    depths = [w.surface.with_volume_of_hats(w.depth) for w in worn]
    prescribed = np.concatenate([-h[:, None] * motion_directions(mesh, w.surface) for h, w in zip(depths, worn)])
    if not len(held):
        raise InputError("mesh motion: wanted a facet group that stays at rest, found none; name a support")
    groups = [mesh.facets[name].ravel() for name in held]
    at_rest = np.unique(np.concatenate([*groups, *(_smooth_continuation(mesh, w.surface) for w in worn)]))
    u = np.zeros((len(mesh.points), mesh.dimension))
    if np.any(prescribed):
        normal = _normal_projector(mesh, moved)
        u = _interior_displacement(mesh, moved, prescribed, np.setdiff1d(at_rest, moved), interior, normal)
        u -= (normal @ u.ravel()).reshape(u.shape)
    points = mesh.points.copy()
    points[:, : mesh.dimension] += u
    result = replace(mesh, points=points)
    try:
        check_quality(result, least_quality)
    except MeshError as error:
        raise MeshInverted(f"the wear is deeper than the cells there can follow, take larger ones: {error}") from error
    return result


def motion_directions(mesh: MeshData, surface: Surface) -> Floats:
    """Outward directions d (n, d) of the surface's nodes: d·n = 1, and tangential to the adjacent free faces."""
    worn = {tuple(row) for row in np.sort(surface.nodes[surface.facets], axis=1).tolist()}
    outer = boundary_facets(mesh.shape, mesh.order, mesh.cells)
    others = [row for row in outer.tolist() if tuple(sorted(row)) not in worn]
    result = surface.normals.copy()
    for node, normals in _normals_at(mesh, np.asarray(others), surface.nodes).items():
        n = surface.normals[node]
        edges = normals[np.abs(normals @ n) < SMOOTH]
        result[node] = np.linalg.pinv(np.vstack([n, edges]), rcond=1e-3)[:, 0]
    return result


def _smooth_continuation(mesh: MeshData, surface: Surface) -> Ints:
    """Nodes of the boundary facets that continue a surface without an edge, without the surface's own nodes."""
    outer = boundary_facets(mesh.shape, mesh.order, mesh.cells)
    corners = outer[:, : corner_count(FACET_SHAPE[mesh.shape])]
    rows = np.repeat(np.arange(len(outer)), corners.shape[1])
    has = sp.csr_matrix((np.ones(corners.size), (rows, corners.ravel())), (len(outer), len(mesh.points)))
    pairs = (has @ has.T).tocoo()
    beside = (pairs.data >= mesh.dimension - 1) & (pairs.row != pairs.col)
    one, other, unit = pairs.row[beside], pairs.col[beside], _unit_normals(mesh, outer)
    smooth = np.abs(np.einsum("fa,fa->f", unit[one], unit[other])) > SMOOTH
    links = sp.csr_matrix((np.ones(smooth.sum()), (one[smooth], other[smooth])), (len(outer), len(outer)))
    part = connected_components(links, directed=False)[1]
    worn = np.isin(corners, surface.nodes).all(axis=1)
    continuing = np.isin(part, part[worn]) & ~worn
    return np.setdiff1d(outer[continuing].ravel(), surface.nodes)


def _normals_at(mesh: MeshData, facets: Ints, nodes: Ints) -> dict[int, Floats]:
    """Index in `nodes` -> unit normals (m, d) at the centres of the facets that have this node."""
    if not len(facets):
        return {}
    place = np.full(len(mesh.points), -1)
    place[nodes] = np.arange(len(nodes))
    near = facets[(place[facets] >= 0).any(axis=1)]
    unit = _unit_normals(mesh, near)
    by_node: dict[int, list[Floats]] = {}
    for row, normal in zip(near, unit):
        for at in place[row][place[row] >= 0]:
            by_node.setdefault(int(at), []).append(normal)
    return {at: np.array(normals) for at, normals in by_node.items()}


def _unit_normals(mesh: MeshData, facets: Ints) -> Floats:
    """Unit normals (f, d) at the centres of the facets, of either sign."""
    shape = FACET_SHAPE[mesh.shape]
    ordered = facets[:, gmsh_permutation(shape, mesh.order)]
    points = mesh.points[:, : mesh.dimension]
    plain = Surface(points, points, ordered, shape, mesh.order, np.arange(len(points)))
    centre = np.full((len(facets), 1, mesh.dimension - 1), 1.0 / 3.0 if shape == "triangle" else 0.5)
    vectors = plain.area_vectors(np.arange(len(facets)), centre)[:, 0]
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _interior_displacement(
    mesh: MeshData, moved: Ints, prescribed: Floats, at_rest: Ints, interior: InteriorMotion, normal: sp.csr_matrix
) -> Floats:
    """Displacement (N, d) of all nodes: prescribed at `moved`, zero at `at_rest`, tangential at other free faces.

    normal: (N d, N d) projector onto the normals of free faces, see `_normal_projector`.
    """
    u = np.zeros((len(mesh.points), mesh.dimension))
    u[moved] = prescribed
    given = np.zeros(u.shape, dtype=bool)
    given[moved] = given[at_rest] = True
    free = np.flatnonzero(~given.ravel())
    K = _stiffness(mesh, interior)
    K = (K + NORMAL_PENALTY * K.diagonal().max() * normal).tocsr()
    right = -(K @ u.ravel())[free]
    u.ravel()[free] = Factor(K[free][:, free].tocsr()).solve(right)
    return u


def _stiffness(mesh: MeshData, interior: InteriorMotion) -> sp.csr_matrix:
    """Matrix (N d, N d) of the equation for the interior, in the order of the mesh's nodes."""
    domain = dolfinx_compat.create_mesh(mesh.points, mesh.cells, mesh.shape, mesh.order)
    space = dolfinx_compat.vector_space(domain, mesh.order)
    blocks = dolfinx_compat.node_dofs(space, domain, len(mesh.points))
    order = (mesh.dimension * blocks[:, None] + np.arange(mesh.dimension)).ravel()
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    stiff = 1.0 / abs(ufl.JacobianDeterminant(domain))
    dx = ufl.Measure("dx", domain=domain, metadata={"quadrature_degree": 2 * mesh.order})
    if interior == "harmonic":
        form = stiff * ufl.inner(ufl.grad(u), ufl.grad(v)) * dx
    else:
        ε, λ = ufl.sym(ufl.grad(u)), 2.0 * POISSON / (1.0 - 2.0 * POISSON)
        σ = λ * ufl.tr(ε) * ufl.Identity(mesh.dimension) + 2.0 * ε
        form = stiff * ufl.inner(σ, ufl.sym(ufl.grad(v))) * dx
    return dolfinx_compat.assemble_csr(form)[order][:, order].tocsr()


def _normal_projector(mesh: MeshData, moved: Ints) -> sp.csr_matrix:
    """Projector (N d, N d) of displacements onto the normals of the boundary at its nodes that are not moved."""
    facets = boundary_facets(mesh.shape, mesh.order, mesh.cells)
    nodes = np.setdiff1d(np.unique(facets), moved)
    blocks = np.zeros((len(mesh.points), mesh.dimension, mesh.dimension))
    for at, normals in _normals_at(mesh, facets, nodes).items():
        blocks[nodes[at]] = np.linalg.pinv(normals, rcond=0.3) @ normals
    every = np.arange(len(blocks))
    return sp.bsr_matrix((blocks, every, np.append(every, len(every)))).tocsr()


def certify_mesh_volume(before: MeshData, after: MeshData, worn_off: float) -> None:
    """Compares the volume that a mesh has lost with the worn volume Σ m h [mm³; mm² in 2D].

    Raises MeshVolumeLost where they differ by more than MESH_VOLUME_TOLERANCE.
    """
    lost = mesh_volume(before) - mesh_volume(after)
    if not abs(lost - worn_off) <= MESH_VOLUME_TOLERANCE * abs(worn_off):
        raise MeshVolumeLost(
            f"mesh motion: wanted meshes that lose {worn_off:.6g}, found {lost:.6g}; put all facets that may touch "
            "into the worn surface, refine it, or let the mesh follow more often"
        )


def smallest_edge(mesh: MeshData, nodes: Ints) -> float:
    """Shortest distance [mm] between two corners of a cell that has one of these nodes."""
    near = mesh.cells[np.isin(mesh.cells, nodes).any(axis=1)][:, : corner_count(mesh.shape)]
    corners = mesh.points[near]
    lengths = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1)
    return float(lengths[:, *np.triu_indices(near.shape[1], 1)].min())


def mesh_volume(mesh: MeshData) -> float:
    """Volume of all cells [mm³; mm² in 2D]."""
    domain = dolfinx_compat.create_mesh(mesh.points, mesh.cells, mesh.shape, mesh.order)
    dx = ufl.Measure("dx", domain=domain, metadata={"quadrature_degree": 2 * mesh.order + 2})
    return dolfinx_compat.assemble_number(dolfinx_compat.constant(domain, 1.0) * dx)
