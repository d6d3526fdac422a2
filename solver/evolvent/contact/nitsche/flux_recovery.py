"""Recovery of the boundary traction of Nitsche's method at the nodes of a contact surface, and its stabiliser.

The recovered traction S_j(u) at node j is the mean of σ(u|_K)n_j over the contact cells K that share the node. It is
exact for a uniform stress, which keeps consistency and the patch test. Nitsche's flux becomes one vector a node instead
of a polynomial a facet, so that d functionals a node couple body and contact: the extended trace e = u − F with
F_j = Γ_j⁻¹ S_j, Γ = γ n⊗n + γ_t (I − n⊗n). The compliance 1/γ is a few per cent of that of the contact, so that an
error of a few per cent in S changes the pressure by about a thousandth.

γ = 2 C_n and γ_t = 2 C_t, with C the constants of the inverse trace inequality. For a contact cell K with facet F,
C_n = max_v ∫_F σ_n(v)² / a_K(v, v), and C_t likewise with σ_t. They differ a lot and depend on ν and the shape of the
cell, and are therefore computed, not tabulated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from evolvent.fem.lagrange import gmsh_permutation, node_points, quadrature, tabulate
from evolvent.fem.material import Material, traction_rows
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.reference_facets import hats
from evolvent.fem.rigid_modes import rigid_modes
from evolvent.fem.surface import Surface, adjacent_cells
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.reference_cells import corner_count

SAFETY = 2.0
"""Stabiliser γ over the limit C of single cells. With γ averaged between cells up to 1.18 is needed; results hardly
change up to 50."""
CONGRUENT = 1e-7
"""Step to which lengths are rounded before cells are compared, over the longest length in the smallest cell."""
AT_ONCE = 64
"""Cells whose stiffness is held at a time: of 3,500 at once it would be 0.6 GB, whose pages took half of the time."""


@dataclass(frozen=True)
class NitscheTraction:
    """Recovered traction and stabiliser on one contact surface of a body with N mesh nodes.

    surface: with n nodes.
    frames: (n, d, d) nodal frames, in the body's frame.
    traction: S (n·d, N·d), from displacements to σ(u)n recovered at the nodes [MPa/mm].
    stabiliser: (n, 2) γ and γ_t at the nodes [MPa/mm].
    """

    surface: Surface
    frames: Floats
    traction: sp.csr_matrix
    stabiliser: Floats

    def flux(self) -> sp.csr_matrix:
        """F = Γ⁻¹S, (n·d, N·d), in the body's frame."""
        return (_block_diagonal(np.swapaxes(self.frames, 1, 2)) @ self._local_flux()).tocsr()

    def _local_flux(self) -> sp.csr_matrix:
        """F in the nodal frames."""
        d = self.frames.shape[1]
        scale = np.hstack([self.stabiliser[:, :1]] + [self.stabiliser[:, 1:]] * (d - 1))
        return (_block_diagonal(self.frames / scale[:, :, None]) @ self.traction).tocsr()

    def constant_term(self) -> sp.csr_matrix:
        """Matrix (N·d, N·d) of ∫ (γ F_n² + γ_t |F_t|²) [N/mm]; −θ times it is added to the body's stiffness."""
        F = self._local_flux()
        return (F.T.tocsr() @ (self._local_weight() @ F)).tocsr()

    def weight(self) -> sp.csr_matrix:
        """Matrix W (n·d, n·d) with FᵀWF = `constant_term`, symmetric positive definite, in the body's frame [N/mm]."""
        frames = _block_diagonal(self.frames)
        return (frames.T @ self._local_weight() @ frames).tocsr()

    def _local_weight(self) -> sp.csr_matrix:
        """W in the nodal frames."""
        is_normal = np.arange(self.frames.shape[1]) == 0
        normal, tangential = (sp.kron(_weighted_mass(self.surface, γ), np.diag(which.astype(float)), format="csr")
                              for γ, which in zip(self.stabiliser.T, (is_normal, ~is_normal)))
        return normal + tangential


def nitsche_traction(mesh: MeshData, material: Material, surface: Surface, safety: float = SAFETY) -> NitscheTraction:
    """Recovered traction and stabiliser of a contact surface; safety: γ over the limit of single cells."""
    return recovered_traction(nitsche_stabiliser(mesh, material, surface, safety), mesh, material, surface)


def recovered_traction(stabiliser: Floats, mesh: MeshData, material: Material, surface: Surface) -> NitscheTraction:
    """Recovered traction of a contact surface whose `nitsche_stabiliser` (n, 2) is known."""
    recovered = _recovered(_ContactCells.of(mesh, surface), material)
    return NitscheTraction(surface, tangent_frames(surface.normals), recovered, stabiliser)


def nitsche_stabiliser(mesh: MeshData, material: Material, surface: Surface, safety: float = SAFETY) -> Floats:
    """Stabiliser γ and γ_t (n, 2) at the nodes of a contact surface of this mesh [MPa/mm]; safety: γ over the limit of
    single cells."""
    constants = safety * inverse_trace_constants(_ContactCells.of(mesh, surface), material)
    stabiliser = np.zeros((len(surface.points), 2))
    for corner in surface.facets.T:
        np.maximum.at(stabiliser, corner, constants)
    return _harmonic(surface, stabiliser)


def _harmonic(surface: Surface, stabiliser: Floats) -> Floats:
    """The stabilisers (n, 2) with 1/γ linear over each facet, from those of its corners.

    The flux F = S/γ is a nodal field. For a uniform traction S, γF = S between the nodes, and thus the patch test where
    the size of the cells jumps, needs 1/γ to be interpolated with the shape functions of F; and only linear
    interpolation keeps it positive.
    """
    linear = tabulate(surface.shape, 1, node_points(surface.shape, surface.order))[0]
    corners = surface.facets[:, np.argmax(linear, axis=0)]
    result = stabiliser.copy()
    result[surface.facets] = 1.0 / np.einsum("kc,fcs->fks", linear, 1.0 / stabiliser[corners])
    return result


def trace_functionals(surface: Surface, columns: int) -> sp.csr_matrix:
    """Selection (n·d, columns) of the displacements of the surface's nodes; columns = N·d."""
    return node_functionals(surface.nodes, surface.points.shape[1], columns)


def node_functionals(nodes: Ints, d: int, columns: int) -> sp.csr_matrix:
    """Selection (n·d, columns) of the displacements of nodes (n,) with d components; columns = N·d."""
    dofs = (d * nodes[:, None] + np.arange(d)).ravel()
    return sp.csr_matrix((np.ones(len(dofs)), (np.arange(len(dofs)), dofs)), (len(dofs), columns))


@dataclass(frozen=True)
class _ContactCells:
    """The cells behind the facets of a surface, cell f behind facet f.

    mesh: of the body.
    surface: its facets.
    nodes: (f, k) mesh nodes of the cells.
    coordinates: (f, k, d) of these nodes [mm].
    slots: (f, kf) indices of the facet's nodes among those of its cell.
    """

    mesh: MeshData
    surface: Surface
    nodes: Ints
    coordinates: Floats
    slots: Ints

    @staticmethod
    def of(mesh: MeshData, surface: Surface) -> _ContactCells:
        facets = surface.nodes[surface.facets]
        behind = adjacent_cells(mesh.cells, facets, len(mesh.points))
        nodes = mesh.cells[behind][:, gmsh_permutation(mesh.shape, mesh.order)]
        slots = np.argmax(nodes[:, None, :] == facets[:, :, None], axis=2)
        return _ContactCells(mesh, surface, nodes, mesh.points[nodes][..., : mesh.dimension], slots)

    def part(self, cells: Ints) -> _ContactCells:
        """Some of the cells (m,)."""
        surface = replace(self.surface, facets=self.surface.facets[cells])
        return _ContactCells(self.mesh, surface, self.nodes[cells], self.coordinates[cells], self.slots[cells])

    def congruent(self) -> tuple[Ints, Ints]:
        """First cell (m,) of each group of congruent cells, and the group (f,) of each cell. Congruent cells have equal
        distances between nodes and corners, and equal normals relative to these, so equal constants: on a flank that is
        swept along a screw, all layers but those at its ends."""
        corners = self.coordinates[:, : corner_count(self.mesh.shape)]
        normals = self.surface.normals[self.surface.facets]
        apart = np.linalg.norm(self.coordinates[:, :, None] - corners[:, None], axis=3)
        size = apart.max(axis=(1, 2))
        tips = np.take_along_axis(self.coordinates, self.slots[..., None], axis=1) + size[:, None, None] * normals
        leaning = np.linalg.norm(tips[:, :, None] - corners[:, None], axis=3)
        lengths = np.concatenate([apart, leaning], axis=1).reshape(len(size), -1)
        keys = np.hstack([self.slots, np.rint(lengths / (CONGRUENT * size.min())).astype(np.int64)])
        known: dict[bytes, int] = {}
        like = [known.setdefault(key.tobytes(), i) for i, key in enumerate(keys)]
        first, group = np.unique(like, return_inverse=True)
        return first, group.ravel()

    def gradients(self, xi: Floats) -> tuple[Floats, Floats]:
        """Shape function gradients ∇N (f, q, k, d) [1/mm] and det J (f, q) at the reference points xi (q, d)."""
        dN = tabulate(self.mesh.shape, self.mesh.order, xi)[1]
        J = np.swapaxes(dN @ self.coordinates[:, None], 2, 3)  # (f, q, d, t)
        return np.swapaxes(dN, 1, 2) @ np.linalg.inv(J), np.linalg.det(J)

    def facet_tractions(self, material: Material, normals: Floats) -> Floats:
        """Matrices from displacements of the cells to tractions σ(u)n at the nodes of the facets, (f, kf, d, k, d)
        [MPa/mm]; normals: (f, kf, d)."""
        everywhere = self.gradients(node_points(self.mesh.shape, self.mesh.order))[0]
        at_facet = np.take_along_axis(everywhere, self.slots[:, :, None, None], axis=1)
        f, kf, k, d = at_facet.shape
        rows = traction_rows(material, at_facet.reshape(-1, k, d), normals.reshape(-1, d))
        return rows.reshape(f, kf, d, k, d)


def _recovered(cells: _ContactCells, material: Material) -> sp.csr_matrix:
    """S (n·d, N·d): the mean of σ(u|_K)n_j over the facets at node j [MPa/mm]."""
    surface = cells.surface
    d = surface.normals.shape[1]
    rows = cells.facet_tractions(material, surface.normals[surface.facets])
    rows /= np.bincount(surface.facets.ravel(), minlength=len(surface.points))[surface.facets][..., None, None, None]
    i = d * surface.facets[:, :, None] + np.arange(d)
    j = d * cells.nodes[:, :, None] + np.arange(d)
    i, j = np.broadcast_arrays(i[:, :, :, None, None], j[:, None, None, :, :])
    shape = (d * len(surface.points), d * len(cells.mesh.points))
    return sp.csr_matrix((rows.ravel(), (i.ravel(), j.ravel())), shape)


def inverse_trace_constants(cells: _ContactCells, material: Material) -> Floats:
    """Constants C_n and C_t of the inverse trace inequality of each contact cell, (f, 2) [MPa/mm]."""
    first, group = cells.congruent()
    parts = np.array_split(first, math.ceil(len(first) / AT_ONCE))
    return np.concatenate([_trace_constants(cells.part(part), material) for part in parts])[group]


def _trace_constants(cells: _ContactCells, material: Material) -> Floats:
    surface = cells.surface
    n = surface.normals[surface.facets]
    K = _element_stiffness(cells, material)
    T = cells.facet_tractions(material, n)
    f, kf, d, k, _ = T.shape
    T = T.reshape(f, kf, d, k * d)
    normal = (n[:, :, None] @ T)[:, :, 0]
    tangential = (T - n[..., None] * normal[:, :, None, :]).reshape(f, kf * d, k * d)
    M = _facet_mass(surface)
    M_t = np.einsum("fij,ab->fiajb", M, np.eye(d)).reshape(f, kf * d, kf * d)
    return np.stack([_largest_ratio(K, normal, M), _largest_ratio(K, tangential, M_t)], axis=1)


def _largest_ratio(K: Floats, T: Floats, M: Floats) -> Floats:
    """Largest ratio max_v (Tv)ᵀM(Tv) / vᵀKv of each cell, (f,), where T vanishes for rigid motions."""
    L = np.linalg.cholesky(M)
    W = np.swapaxes(L, 1, 2) @ T
    return np.asarray(np.linalg.eigvalsh(W @ np.linalg.solve(K, np.swapaxes(W, 1, 2)))[:, -1])


def _element_stiffness(cells: _ContactCells, material: Material) -> Floats:
    """Element stiffness a_K (f, k·d, k·d), with stiffness added for the rigid motions so that it is regular."""
    shape, order = cells.mesh.shape, cells.mesh.order
    xi, w = quadrature(shape, 2 * order)
    G, det = cells.gradients(xi)
    λ, μ = material.lame
    f, q, k, d = G.shape
    weighted = ((w * np.abs(det))[:, :, None, None] * G).reshape(f, q, k * d)
    M = (np.swapaxes(weighted, 1, 2) @ G.reshape(f, q, k * d)).reshape(f, k, d, k, d)  # ∫∂_a N_k ∂_b N_l
    K = λ * M + μ * np.swapaxes(M, 2, 4)
    K += μ * np.trace(M, axis1=2, axis2=4)[:, :, None, :, None] * np.eye(d)[:, None, :]
    K = K.reshape(f, k * d, k * d)
    centred = cells.coordinates - cells.coordinates.mean(axis=1, keepdims=True)
    R = np.linalg.qr(rigid_modes(centred.reshape(-1, d)).reshape(f, k * d, -1))[0]
    stiff = np.trace(K, axis1=1, axis2=2) / (k * d)
    return np.asarray(K + stiff[:, None, None] * (R @ np.swapaxes(R, 1, 2)))


def _facet_mass(surface: Surface, γ: Floats | None = None) -> Floats:
    """Mass matrix ∫_F γ N_i N_j of each facet, (f, kf, kf); γ: (n,) at the nodes, 1/γ linear between, by default 1."""
    xi, w = quadrature(surface.shape, 2 * surface.order + 2)
    N, dN = tabulate(surface.shape, surface.order, xi)
    tangents = np.einsum("fka,qtk->fqta", surface.points[surface.facets], dN)
    area = np.sqrt(np.linalg.det(np.einsum("fqsa,fqta->fqst", tangents, tangents)))
    if γ is not None:
        area = area / ((1.0 / γ)[surface.facets] @ hats(surface.shape, surface.order, xi).T)
    return np.einsum("fq,qi,qj->fij", w * area, N, N, optimize=True)


def _weighted_mass(surface: Surface, γ: Floats) -> sp.csr_matrix:
    """Weighted mass matrix ∫γ N_i N_j over the surface, (n, n)."""
    i, j = np.broadcast_arrays(surface.facets[:, :, None], surface.facets[:, None, :])
    n = len(surface.points)
    return sp.csr_matrix((_facet_mass(surface, γ).ravel(), (i.ravel(), j.ravel())), (n, n))


def _block_diagonal(blocks: Floats) -> sp.bsr_matrix:
    n, d, _ = blocks.shape
    return sp.bsr_matrix((blocks, np.arange(n), np.arange(n + 1)), shape=(n * d, n * d))
