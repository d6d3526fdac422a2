"""The mesh follows the worn surface: where its nodes go, and where the interior goes (ALE: the material stays).

A worn node goes by −h d, d·n = 1, within the free faces that it also belongs to: a worn edge stays on its end face and
on its tip cylinder. Inner nodes of second-order facets go by a little more or less, so that every facet loses the
volume that its nodes' hats give it. The interior follows by a linear equation with these nodes prescribed and the held
groups at rest, every cell as stiff as it is small, so that large ones take most of the motion. What goes on smoothly
from a worn surface stays; faces beyond an edge slide in themselves.
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

Follow = Literal["elastic", "harmonic"]
SMOOTH = 0.87  # faces whose normals' cosine is above this (30°) are one smooth surface, and no edge
WALL = 1e6  # stiffness against leaving a free face, over the largest of the equation
POISSON = 0.3  # of the elastic equation
MESH_VOLUME = 1e-2
"""How far what a moved mesh has lost may be from Σ m h. On a curved surface the two differ by half the depth over the
radius; 6e-4 was found on worn spheres and cylinders."""


class MeshInverted(MeshError):
    """The moved mesh has a cell that is turned over, or nearly so."""


class MeshVolumeLost(MeshError):
    """The moved mesh has not lost the volume that the contact took away."""


@dataclass(frozen=True)
class WornSurface:
    """A surface that loses depth (n,) [mm] at its nodes."""

    surface: Surface
    depth: Floats


def worn_mesh(
    mesh: MeshData, worn: Collection[WornSurface], held: Collection[str], follow: Follow = "elastic",
    least_quality: float = 0.05,
) -> MeshData:  # fmt: skip
    """The mesh with its worn surfaces moved in and the interior following. held: facet groups that stay where they are.

    Raises MeshInverted where a scaled Jacobian falls below `least_quality`, and InputError where nothing is held.
    """
    moved = np.concatenate([w.surface.nodes for w in worn])
    depths = [w.surface.with_volume_of_hats(w.depth) for w in worn]
    goal = np.concatenate([-h[:, None] * directions(mesh, w.surface) for h, w in zip(depths, worn)])
    if not len(held):
        raise InputError("mesh motion: wanted a facet group that stays at rest, found none; name a support")
    resting = [mesh.facets[name].ravel() for name in held]
    still = np.unique(np.concatenate([*resting, *(_continuation(mesh, w.surface) for w in worn)]))
    shift = np.zeros((len(mesh.points), mesh.dimension))
    if np.any(goal):
        walls = _walls(mesh, moved)
        shift = _followed(mesh, moved, goal, np.setdiff1d(still, moved), follow, walls)
        shift -= (walls @ shift.ravel()).reshape(shift.shape)
    points = mesh.points.copy()
    points[:, : mesh.dimension] += shift
    result = replace(mesh, points=points)
    try:
        check_quality(result, least_quality)
    except MeshError as error:
        raise MeshInverted(f"the wear is deeper than the cells there can follow, take larger ones: {error}") from error
    return result


def directions(mesh: MeshData, surface: Surface) -> Floats:
    """(n, d) where a worn node goes for a depth of one, outwards: d·n = 1, and within adjacent free faces."""
    own = {tuple(row) for row in np.sort(surface.nodes[surface.facets], axis=1).tolist()}
    outer = boundary_facets(mesh.shape, mesh.order, mesh.cells)
    others = [row for row in outer.tolist() if tuple(sorted(row)) not in own]
    result = surface.normals.copy()
    for node, normals in _normals_at(mesh, np.asarray(others), surface.nodes).items():
        n = surface.normals[node]
        edges = normals[np.abs(normals @ n) < SMOOTH]
        result[node] = np.linalg.pinv(np.vstack([n, edges]), rcond=1e-3)[:, 0]
    return result


def _continuation(mesh: MeshData, surface: Surface) -> Ints:
    """Nodes of the outer facets that go on from a surface without an edge, its own not among them."""
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
    own = np.isin(corners, surface.nodes).all(axis=1)
    found = np.isin(part, part[own]) & ~own
    return np.setdiff1d(outer[found].ravel(), surface.nodes)


def _normals_at(mesh: MeshData, facets: Ints, nodes: Ints) -> dict[int, Floats]:
    """Position in `nodes` -> unit normals (m, d) at the centres of the given facets that have this node."""
    if not len(facets):
        return {}
    place = np.full(len(mesh.points), -1)
    place[nodes] = np.arange(len(nodes))
    near = facets[(place[facets] >= 0).any(axis=1)]
    unit = _unit_normals(mesh, near)
    found: dict[int, list[Floats]] = {}
    for row, normal in zip(near, unit):
        for at in place[row][place[row] >= 0]:
            found.setdefault(int(at), []).append(normal)
    return {at: np.array(normals) for at, normals in found.items()}


def _unit_normals(mesh: MeshData, facets: Ints) -> Floats:
    """(f, d) at the facets' centres, to either side."""
    shape = FACET_SHAPE[mesh.shape]
    ordered = facets[:, gmsh_permutation(shape, mesh.order)]
    points = mesh.points[:, : mesh.dimension]
    plain = Surface(points, points, ordered, shape, mesh.order, np.arange(len(points)))
    centre = np.full((len(facets), 1, mesh.dimension - 1), 1.0 / 3.0 if shape == "triangle" else 0.5)
    vectors = plain.area_vectors(np.arange(len(facets)), centre)[:, 0]
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _followed(
    mesh: MeshData, moved: Ints, goal: Floats, still: Ints, follow: Follow, walls: sp.csr_matrix
) -> Floats:
    """(N, d) displacement of all nodes, prescribed at `moved`, zero at `still`, almost none against the walls."""
    shift = np.zeros((len(mesh.points), mesh.dimension))
    shift[moved] = goal
    given = np.zeros(shift.shape, dtype=bool)
    given[moved] = given[still] = True
    free = np.flatnonzero(~given.ravel())
    K = _stiffness(mesh, follow)
    K = (K + WALL * K.diagonal().max() * walls).tocsr()
    right = -(K @ shift.ravel())[free]
    shift.ravel()[free] = Factor(K[free][:, free].tocsr()).solve(right)
    return shift


def _stiffness(mesh: MeshData, follow: Follow) -> sp.csr_matrix:
    """The equation's matrix, by the mesh's nodes."""
    domain = dolfinx_compat.create_mesh(mesh.points, mesh.cells, mesh.shape, mesh.order)
    space = dolfinx_compat.vector_space(domain, mesh.order)
    blocks = dolfinx_compat.node_dofs(space, domain, len(mesh.points))
    order = (mesh.dimension * blocks[:, None] + np.arange(mesh.dimension)).ravel()
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    stiff = 1.0 / abs(ufl.JacobianDeterminant(domain))
    dx = ufl.Measure("dx", domain=domain, metadata={"quadrature_degree": 2 * mesh.order})
    if follow == "harmonic":
        form = stiff * ufl.inner(ufl.grad(u), ufl.grad(v)) * dx
    else:
        ε, λ = ufl.sym(ufl.grad(u)), 2.0 * POISSON / (1.0 - 2.0 * POISSON)
        σ = λ * ufl.tr(ε) * ufl.Identity(mesh.dimension) + 2.0 * ε
        form = stiff * ufl.inner(σ, ufl.sym(ufl.grad(v))) * dx
    return dolfinx_compat.assemble_csr(form)[order][:, order].tocsr()


def _walls(mesh: MeshData, moved: Ints) -> sp.csr_matrix:
    """(N d, N d) the part of a displacement that leaves the faces of the boundary nodes that are not moved."""
    facets = boundary_facets(mesh.shape, mesh.order, mesh.cells)
    nodes = np.setdiff1d(np.unique(facets), moved)
    blocks = np.zeros((len(mesh.points), mesh.dimension, mesh.dimension))
    for at, normals in _normals_at(mesh, facets, nodes).items():
        blocks[nodes[at]] = np.linalg.pinv(normals, rcond=0.3) @ normals
    every = np.arange(len(blocks))
    return sp.bsr_matrix((blocks, every, np.append(every, len(every)))).tocsr()


def certify_loss(before: MeshData, after: MeshData, wanted: float) -> None:
    """wanted: Σ m h [mm³; mm² in 2D] of what a moved mesh was to lose. Raises MeshVolumeLost."""
    lost = mesh_volume(before) - mesh_volume(after)
    if not abs(lost - wanted) <= MESH_VOLUME * abs(wanted):
        raise MeshVolumeLost(
            f"mesh motion: wanted meshes that lose {wanted:.6g}, found {lost:.6g}; put all facets that may touch "
            "into the worn surface, refine it, or let the mesh follow more often"
        )


def smallest_edge(mesh: MeshData, nodes: Ints) -> float:
    """Least distance [mm] between two corners of a cell that has one of these nodes."""
    near = mesh.cells[np.isin(mesh.cells, nodes).any(axis=1)][:, : corner_count(mesh.shape)]
    corners = mesh.points[near]
    lengths = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1)
    return float(lengths[:, *np.triu_indices(near.shape[1], 1)].min())


def mesh_volume(mesh: MeshData) -> float:
    """Of all cells [mm³; mm² in 2D]."""
    domain = dolfinx_compat.create_mesh(mesh.points, mesh.cells, mesh.shape, mesh.order)
    dx = ufl.Measure("dx", domain=domain, metadata={"quadrature_degree": 2 * mesh.order + 2})
    return dolfinx_compat.assemble_number(dolfinx_compat.constant(domain, 1.0) * dx)
