"""The traction that Nitsche's method takes from the body: recovered at the nodes of the contact surface.

At node j of the surface S_j(u) is the mean of σ(u|_K)n_j over the contact cells K that meet there. It is exact for a
uniform stress, so consistency and the patch test stay, and it makes of Nitsche's flux one vector a node instead of a
polynomial a facet: the surface is then seen through three functionals a node, the extended trace e = u − F,
F_j = Γ_j⁻¹ S_j, Γ = γ n⊗n + γ_t (I − n⊗n). The penalty compliance 1/γ is a few per cent of the contact's own, so an
error of some per cent in S changes the pressure by a thousandth of it.

γ = 2 C_n and γ_t = 2 C_t, with C the constants of the inverse trace inequality, per contact cell K with facet F:
C_n = max_v ∫_F σ_n(v)² / a_K(v, v), and C_t with σ_t (the two are far apart, and depend on ν and the cell's shape, so
they are computed, not tabulated).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.fem.lagrange import gmsh_permutation, node_points, quadrature, tabulate
from evolvent.fem.material import Material, traction_rows
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.rigid_modes import rigid_modes
from evolvent.fem.surface import Surface, adjacent_cells, hats
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData

SAFETY = (
    2.0  # γ over the limit of single cells; averaged between cells it needs up to 1.18, and is insensitive up to 50
)


@dataclass(frozen=True)
class NitscheTraction:
    """What Nitsche's method needs of one contact surface of a body with N mesh nodes.

    frames: (n, d, d) at the surface's n nodes, in the body's frame. traction: (n·d, N·d) σ(u)n recovered at the nodes
    [MPa/mm]. stabiliser: (n, 2) γ and γ_t at the nodes [MPa/mm].
    """

    surface: Surface
    frames: Floats
    traction: sp.csr_matrix
    stabiliser: Floats

    def flux(self) -> sp.csr_matrix:
        """F = Γ⁻¹S, (n·d, N·d)."""
        return (_block_diagonal(np.swapaxes(self.frames, 1, 2)) @ self._local_flux()).tocsr()

    def _local_flux(self) -> sp.csr_matrix:
        """F in the nodes' frames."""
        d = self.frames.shape[1]
        scale = np.hstack([self.stabiliser[:, :1]] + [self.stabiliser[:, 1:]] * (d - 1))
        return (_block_diagonal(self.frames / scale[:, :, None]) @ self.traction).tocsr()

    def constant_term(self) -> sp.csr_matrix:
        """∫ (γ F_n² + γ_t |F_t|²), (N·d, N·d): what −θ times goes into the body's stiffness."""
        F, d = self._local_flux(), self.frames.shape[1]
        normal, tangential = (sp.kron(_weighted_mass(self.surface, γ), np.eye(d), format="csr") @ F
                              for γ in self.stabiliser.T)  # fmt: skip
        own = np.arange(F.shape[0]) % d == 0
        weighted = sp.diags(own.astype(float)) @ normal + sp.diags((~own).astype(float)) @ tangential
        return (F.T.tocsr() @ weighted).tocsr()


def nitsche_traction(mesh: MeshData, material: Material, surface: Surface, safety: float = SAFETY) -> NitscheTraction:
    """Recovered traction and γ, γ_t of a contact surface of the body."""
    cells = _ContactCells.of(mesh, surface)
    constants = safety * inverse_trace_constants(cells, material)
    stabiliser = np.zeros((len(surface.points), 2))
    for corner in surface.facets.T:
        np.maximum.at(stabiliser, corner, constants)
    recovered = _recovered(cells, material)
    return NitscheTraction(surface, tangent_frames(surface.normals), recovered, _harmonic(surface, stabiliser))


def _harmonic(surface: Surface, stabiliser: Floats) -> Floats:
    """(n, 2) the stabilisers with 1/γ linear over each facet, from its corners.

    The flux F = S/γ lives at the nodes. Only if 1/γ between them is what F's shape functions make of it is γF the
    uniform traction again, and the patch test passed where the size of the cells jumps; and only where it is linear
    is it sure to be positive.
    """
    linear = tabulate(surface.shape, 1, node_points(surface.shape, surface.order))[0]
    corners = surface.facets[:, np.argmax(linear, axis=0)]
    result = stabiliser.copy()
    result[surface.facets] = 1.0 / np.einsum("kc,fcs->fks", linear, 1.0 / stabiliser[corners])
    return result


def trace_functionals(surface: Surface, columns: int) -> sp.csr_matrix:
    """The displacements of the surface's nodes, (n·d, columns) with columns = N·d."""
    d = surface.points.shape[1]
    dofs = (d * surface.nodes[:, None] + np.arange(d)).ravel()
    return sp.csr_matrix((np.ones(len(dofs)), (np.arange(len(dofs)), dofs)), (len(dofs), columns))


@dataclass(frozen=True)
class _ContactCells:
    """The cells behind the facets of a surface: facet f belongs to cell f here.

    nodes: (f, k) mesh nodes of the cells; coordinates: (f, k, d); slots: (f, kf) places of a facet's nodes there.
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

    def gradients(self, xi: Floats) -> tuple[Floats, Floats]:
        """∇N (f, q, k, d) and det J (f, q) at the reference points xi (q, d)."""
        dN = tabulate(self.mesh.shape, self.mesh.order, xi)[1]
        J = np.einsum("fka,qtk->fqat", self.coordinates, dN)
        return np.einsum("qtk,fqta->fqka", dN, np.linalg.inv(J)), np.linalg.det(J)

    def facet_tractions(self, material: Material, normals: Floats) -> Floats:
        """σ(u)n at the facets' nodes as maps of the cells' displacements: (f, kf, d, k, d); normals (f, kf, d)."""
        everywhere = self.gradients(node_points(self.mesh.shape, self.mesh.order))[0]
        at_facet = np.take_along_axis(everywhere, self.slots[:, :, None, None], axis=1)
        f, kf, k, d = at_facet.shape
        rows = traction_rows(material, at_facet.reshape(-1, k, d), normals.reshape(-1, d))
        return rows.reshape(f, kf, d, k, d)


def _recovered(cells: _ContactCells, material: Material) -> sp.csr_matrix:
    """S: the mean over the facets at a node of σ(u|_K)n_j, (n·d, N·d)."""
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
    """C_n and C_t of each contact cell, (f, 2) [MPa/mm]."""
    surface = cells.surface
    n = surface.normals[surface.facets]
    K = _element_stiffness(cells, material)
    T = cells.facet_tractions(material, n)
    f, kf, d, k, _ = T.shape
    T = T.reshape(f, kf, d, k * d)
    normal = np.einsum("fjr,fjrs->fjs", n, T)
    tangential = (T - n[..., None] * normal[:, :, None, :]).reshape(f, kf * d, k * d)
    M = _facet_mass(surface)
    M_t = np.einsum("fij,ab->fiajb", M, np.eye(d)).reshape(f, kf * d, kf * d)
    return np.stack([_largest_ratio(K, normal, M), _largest_ratio(K, tangential, M_t)], axis=1)


def _largest_ratio(K: Floats, T: Floats, M: Floats) -> Floats:
    """max_v (Tv)ᵀM(Tv) / vᵀKv for each cell; K is regular off the rigid motions, on which T vanishes."""
    L = np.linalg.cholesky(M)
    W = np.einsum("fji,fjs->fis", L, T)
    return np.linalg.eigvalsh(np.einsum("fis,fsj->fij", W, np.linalg.solve(K, np.swapaxes(W, 1, 2))))[:, -1]


def _element_stiffness(cells: _ContactCells, material: Material) -> Floats:
    """a_K (f, k·d, k·d), with the rigid motions made stiff so that it can be inverted."""
    shape, order = cells.mesh.shape, cells.mesh.order
    xi, w = quadrature(shape, 2 * order)
    G, det = cells.gradients(xi)
    λ, μ = material.lame
    wd = w * np.abs(det)
    f, _, k, d = G.shape
    K = λ * np.einsum("fq,fqka,fqlb->fkalb", wd, G, G, optimize=True)
    K += μ * np.einsum("fq,fqkb,fqla->fkalb", wd, G, G, optimize=True)
    K += μ * np.einsum("fq,fqkc,fqlc,ab->fkalb", wd, G, G, np.eye(d), optimize=True)
    K = K.reshape(f, k * d, k * d)
    R = np.linalg.qr(np.stack([rigid_modes(x - x.mean(axis=0)).reshape(k * d, -1) for x in cells.coordinates]))[0]
    stiff = np.trace(K, axis1=1, axis2=2) / (k * d)
    return K + stiff[:, None, None] * np.einsum("fir,fjr->fij", R, R)


def _facet_mass(surface: Surface, γ: Floats | None = None) -> Floats:
    """∫_F γ N_i N_j of each facet, (f, kf, kf); γ (n,) at the nodes, 1/γ linear between, 1 by default."""
    xi, w = quadrature(surface.shape, 2 * surface.order + 2)
    N, dN = tabulate(surface.shape, surface.order, xi)
    tangents = np.einsum("fka,qtk->fqta", surface.points[surface.facets], dN)
    area = np.sqrt(np.linalg.det(np.einsum("fqsa,fqta->fqst", tangents, tangents)))
    if γ is not None:
        area = area / ((1.0 / γ)[surface.facets] @ hats(surface.shape, surface.order, xi).T)
    return np.einsum("fq,qi,qj->fij", w * area, N, N, optimize=True)


def _weighted_mass(surface: Surface, γ: Floats) -> sp.csr_matrix:
    """∫γ N_i N_j over the surface, (n, n)."""
    i, j = np.broadcast_arrays(surface.facets[:, :, None], surface.facets[:, None, :])
    n = len(surface.points)
    return sp.csr_matrix((_facet_mass(surface, γ).ravel(), (i.ravel(), j.ravel())), (n, n))


def _block_diagonal(blocks: Floats) -> sp.bsr_matrix:
    n, d, _ = blocks.shape
    return sp.bsr_matrix((blocks, np.arange(n), np.arange(n + 1)), shape=(n * d, n * d))
