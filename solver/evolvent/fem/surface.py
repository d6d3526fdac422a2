"""Contact surface of a body: facets, nodal normals and weights, taken from named facet groups of a mesh.

A surface consists of plain arrays, so that search and contact terms do not depend on the mesh. Facets number their
nodes in the order of basix (corners of a quadrilateral in tensor order, then edges, then the interior) and are oriented
outwards: t1 × t2, in 2D the tangent turned clockwise, points out of the body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_matrix

from evolvent.fem.lagrange import gmsh_permutation
from evolvent.fem.lagrange import tabulate as shape_functions
from evolvent.fem.reference_facets import REVERSED_FACET, area_vector, hats, monomials, reference_cell, subcell_rule
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import FACET_SHAPE, MeshData, MeshError

MASS_DEGREE = 6
"""Degree of the rule on each sub-facet for ∫ψ_j N_k: exact on plane facets, also distorted ones."""
EDGE = np.radians(40.0)
"""Largest angle between the normal of a node and that of a facet there: half of the turn of an edge of 80°."""
INNER_NODES = {("interval", 2): [2], ("quadrilateral", 2): [8], ("triangle", 2): [3, 4, 5]}
"""Second-order facets, basix order: nodes that belong to one facet only; of a triangle those of its edges."""


@dataclass(frozen=True)
class Surface:
    """Contact surface of a body.

    points: (n, d) node coordinates [mm], d = 2 or 3.
    normals: (n, d) outward unit normals, means of the facets' normals at the node weighted by facet area.
    facets: (m, k) indices into points, basix order, oriented outwards.
    shape: of the facets, "interval", "quadrilateral" or "triangle".
    order: of the facets, 1 or 2.
    nodes: (n,) node of the body's mesh at each point.
    """

    points: Floats
    normals: Floats
    facets: Ints
    shape: str
    order: int
    nodes: Ints

    @classmethod
    def from_arrays(cls, points: ArrayLike, facets: ArrayLike, shape: str, order: int,
                    nodes: ArrayLike | None = None) -> Surface:
        """A surface from points (n, d) [mm] and outward oriented facets (m, k) in the order of basix.

        nodes: (n,) mesh nodes (default: the numbers of the points).
        Raises ValueError if sizes do not match, a point is not finite, or a facet is folded or has no area.
        """
        x, f = np.asarray(points, dtype=np.float64), np.asarray(facets, dtype=np.int64)
        cell = reference_cell(shape, order)
        if f.ndim != 2 or f.shape[1] != len(cell.nodes) or x.shape[1] != cell.nodes.shape[1] + 1:
            raise ValueError(f"{shape} facets of order {order} need (m, {len(cell.nodes)}) node indices and "
                             f"(n, {cell.nodes.shape[1] + 1}) points; found {f.shape} and {x.shape}")
        if not np.isfinite(x).all():
            raise ValueError(f"{int((~np.isfinite(x)).any(axis=1).sum())} of {len(x)} surface points are not finite")
        numbers = np.arange(len(x)) if nodes is None else np.asarray(nodes, dtype=np.int64)
        bare = cls(x, np.zeros_like(x), f, shape, order, numbers)
        return replace(bare, normals=_nodal_normals(bare))

    def evaluate(self, field: Floats, facets: Ints, xi: Floats) -> tuple[Floats, list[Floats]]:
        """Values (t, p, c) of a nodal field (n, c) at xi (t, p, dt) of the facets (t,), and derivatives by each ξ."""
        cell = reference_cell(self.shape, self.order)
        nodal = cell.coefficients @ field[self.facets[facets]]
        value, first = monomials(cell, xi)
        return value @ nodal, [f @ nodal for f in first]

    def positions(self, facets: Ints, xi: Floats) -> Floats:
        """Points (t, p, d) [mm] at xi (t, p, dt) of the facets (t,)."""
        return self.evaluate(self.points, facets, xi)[0]

    def area_vectors(self, facets: Ints, xi: Floats) -> Floats:
        """Outward facet normal times dA/dξ (t, p, d) [mm; mm²] at xi (t, p, dt) of the facets (t,)."""
        return area_vector(self.evaluate(self.points, facets, xi)[1])

    def areas(self) -> Floats:
        """Length [mm] or area [mm²] of each facet (m,)."""
        return self._rule()[2].sum(axis=1)

    @property
    def size(self) -> float:
        """Median size of the facets [mm]: length, in 3D the square root of the area."""
        return float(np.median(self.areas()) ** (1.0 / (self.points.shape[1] - 1)))

    def weights(self) -> Floats:
        """Nodal weights m_j = ∫ψ_j (n,) [mm; mm²] with the hat functions ψ; all positive."""
        psi, _, measure = self._rule()
        total = np.bincount(self.facets.ravel(), (measure @ psi).ravel(), minlength=len(self.points))
        return total.astype(np.float64)

    def mass(self) -> Any:
        """Mass matrix M_jk = ∫ψ_j N_k, csr (n, n) [mm; mm²], of hat functions ψ and shape functions N; row sums m_j."""
        psi, shape, measure = self._rule()
        local = np.einsum("mq,qj,qk->mjk", measure, psi, shape, optimize=True)
        k = self.facets.shape[1]
        rows, columns = np.repeat(self.facets, k, axis=1).ravel(), np.tile(self.facets, (1, k)).ravel()
        return csr_matrix((local.ravel(), (rows, columns)), shape=(len(self.points),) * 2)

    def with_volume_of_hats(self, field: Floats) -> Floats:
        """A nodal field (n,) whose interpolation by shape functions has the integral of the given field's by hats.

        The integrals agree nearly facet by facet. Only values at inner nodes of facets, of triangles at edge nodes, are
        changed; in order 1 none.
        """
        inner = INNER_NODES.get((self.shape, self.order))
        if inner is None:
            return field
        psi, shape, measure = self._rule()
        missing = np.einsum("mk,mk->m", measure @ (psi - shape), field[self.facets])
        integrals = np.bincount(self.facets.ravel(), (measure @ shape).ravel(), minlength=len(field))  # ∫N_k
        nodes, result = self.facets[:, inner], field.copy()
        np.add.at(result, nodes, (missing / integrals[nodes].sum(axis=1))[:, None])
        return result

    def hat_matrix(self, facets: Ints, xi: Floats) -> csr_matrix:
        """Hat functions (q, n) at xi (q, dt) of the facets (q,); points outside are moved to the facet's edge."""
        inside = np.maximum(xi, 0.0)
        if self.shape == "triangle":
            inside = inside / np.maximum(inside.sum(axis=1, keepdims=True), 1.0)
        psi = hats(self.shape, self.order, np.minimum(inside, 1.0))
        ends = psi.shape[1] * np.arange(len(psi) + 1)
        return csr_matrix((psi.ravel(), self.facets[facets].ravel(), ends), shape=(len(psi), len(self.points)))

    def moved(self, rotation: ArrayLike, translation: ArrayLike) -> Surface:
        """The surface moved by x → R x + t, with rotation R (d, d) and translation t (d,) [mm]."""
        turn = np.asarray(rotation, dtype=np.float64)
        return replace(self, points=self.points @ turn.T + np.asarray(translation), normals=self.normals @ turn.T)

    def displaced(self, u: Floats) -> Surface:
        """The surface displaced by u (n, d) [mm], with the normals of its displaced facets.

        Raises ValueError where a facet is folded.
        """
        return Surface.from_arrays(self.points + u, self.facets, self.shape, self.order, self.nodes)

    def _rule(self) -> tuple[Floats, Floats, Floats]:
        """A rule on all sub-facets: hat functions (q, k), shape functions (q, k) and weights times dA/dξ (m, q)."""
        xi, w = subcell_rule(self.shape, self.order, MASS_DEGREE)
        every = np.arange(len(self.facets))
        vectors = self.area_vectors(every, np.broadcast_to(xi, (len(every), *xi.shape)))
        psi, shape = hats(self.shape, self.order, xi), shape_functions(self.shape, self.order, xi)[0]
        return psi, shape, np.linalg.norm(vectors, axis=-1) * w


def _nodal_normals(surface: Surface) -> Floats:
    cell = reference_cell(surface.shape, surface.order)
    every = np.arange(len(surface.facets))
    points = np.concatenate([cell.nodes, cell.centre[None]])
    vectors = surface.area_vectors(every, np.broadcast_to(points, (len(every), *points.shape)))
    vectors, centre = vectors[:, :-1], vectors[:, -1:]
    if np.any(folded := np.sum(vectors * centre, axis=2).min(axis=1) <= 0.0):
        bad = int(np.argmax(folded))
        raise ValueError(f"{folded.sum()} of {len(every)} facets are folded or empty (first: {bad}, its normals at the "
                         "nodes and at the centre should differ by less than 90°): correct or refine the mesh")
    unit = vectors / np.linalg.norm(vectors, axis=2, keepdims=True)
    total = np.zeros_like(surface.points)
    np.add.at(total, surface.facets, surface.areas()[:, None, None] * unit)
    return total / np.linalg.norm(total, axis=1, keepdims=True)


def check_smooth(surface: Surface, of: str) -> None:
    """Raises MeshError where the normal of a facet is further than EDGE from that of one of its nodes.

    At a sharp edge the nodal normals are those of neither face, and pressures are wrong. of: name for the message.
    """
    cell, every = reference_cell(surface.shape, surface.order), np.arange(len(surface.facets))
    normals = surface.area_vectors(every, np.broadcast_to(cell.nodes, (len(every), *cell.nodes.shape)))
    normals = normals / np.linalg.norm(normals, axis=2, keepdims=True)
    agreement = np.einsum("mkd,mkd->mk", normals, surface.normals[surface.facets])
    facet, node = np.unravel_index(int(np.argmin(agreement)), agreement.shape)
    if agreement[facet, node] < np.cos(EDGE):
        place = ", ".join(f"{x:.4g}" for x in surface.points[surface.facets[facet, node]])
        raise MeshError(
            f"{of}: wanted a surface without sharp edges, found one at ({place}) mm; leave the faces behind its edges "
            "out of the facet group, or give each face a contact of its own"
        )


def surface_of(mesh: MeshData, group: str | Sequence[str]) -> Surface:
    """The contact surface of one or more named facet groups of a mesh, oriented outwards.

    Raises MeshError if a group is unknown (the message lists those there are) or empty, or if a facet is not on the
    boundary.

    >>> from evolvent_meshes.shapes.blocks import rectangle
    >>> top = surface_of(rectangle(40.0, 20.0, nx=4, ny=2), "top")
    >>> print(f"{len(top.facets)} facets, {len(top.points)} nodes, {top.areas().sum():.1f} mm")
    4 facets, 9 nodes, 40.0 mm
    """
    names = [group] if isinstance(group, str) else list(group)
    shape, order = FACET_SHAPE[mesh.shape], mesh.order
    groups = [facet_group(mesh, name, "contact surface") for name in names]
    gmsh = np.concatenate([f for f in groups if len(f)])[:, gmsh_permutation(shape, order)]
    facets = _outward(mesh, gmsh, shape)
    nodes, local = np.unique(facets, return_inverse=True)
    points = mesh.points[nodes, : mesh.dimension]
    return Surface.from_arrays(points, local.reshape(facets.shape), shape, order, nodes)


def _outward(mesh: MeshData, facets: Ints, shape: str) -> Ints:
    """The facets (m, k) of mesh nodes, reversed where their normal points into the adjacent cell."""
    points = mesh.points[:, : mesh.dimension]
    corners = {"triangle": 3, "quadrilateral": 4, "tetrahedron": 4, "hexahedron": 8}[mesh.shape]
    adjacent = adjacent_cells(mesh.cells[:, :corners], facets[:, : len(reference_cell(shape, 1).nodes)], len(points))
    surface = Surface(points, points, facets, shape, mesh.order, np.arange(len(points)))
    every = np.arange(len(facets))
    middle = np.broadcast_to(reference_cell(shape, 1).centre, (len(every), 1, mesh.dimension - 1))
    inside = points[mesh.cells[adjacent, :corners]].mean(axis=1)
    away = surface.positions(every, middle)[:, 0] - inside
    inwards = np.einsum("md,md->m", surface.area_vectors(every, middle)[:, 0], away) < 0.0
    return np.where(inwards[:, None], facets[:, REVERSED_FACET[shape, mesh.order]], facets)


def adjacent_cells(cells: Ints, facets: Ints, n_points: int) -> Ints:
    """The cell (f,) that has all nodes of each facet (f, k). Raises MeshError for a facet of no cell or of two."""
    rows, columns = _facets_and_cells(cells, facets, n_points)
    count = np.bincount(rows, minlength=len(facets))
    if np.any(count != 1):
        bad = int(np.flatnonzero(count != 1)[0])
        raise MeshError(
            f"facets: wanted one cell behind each, as on the boundary of a body, found {count[bad]} behind facet {bad} "
            f"with nodes {facets[bad].tolist()}; put only boundary facets of this body into the group"
        )
    adjacent = np.empty(len(facets), dtype=np.int64)
    adjacent[rows] = columns
    return adjacent


def _facets_and_cells(cells: Ints, facets: Ints, n_points: int) -> tuple[Ints, Ints]:
    """Pairs of a facet and a cell that has all of its nodes: facets (p,), cells (p,)."""

    def incidence(items: Ints) -> Any:
        rows = np.repeat(np.arange(len(items)), items.shape[1])
        return csr_matrix((np.ones(items.size), (rows, items.ravel())), shape=(len(items), n_points))

    on_facets = np.zeros(n_points, dtype=bool)
    on_facets[facets] = True
    near = np.flatnonzero(on_facets[cells].sum(axis=1) >= facets.shape[1])
    shared = (incidence(facets) @ incidence(cells[near]).T).tocoo()
    complete = shared.data > facets.shape[1] - 0.5
    return shared.row[complete], near[shared.col[complete]]


def facet_group(mesh: MeshData, group: str, of: str) -> Ints:
    """The facets (m, k) of a group, in the node order of gmsh.

    of: name for the message.
    Raises MeshError for a group that is unknown, empty, or has a facet of no cell.
    """
    if group not in mesh.facets:
        known = ", ".join(sorted(mesh.facets)) or "(the mesh has none)"
        raise MeshError(f"{of}: wanted one of the facet groups {known}, found {group!r}; name one of these")
    facets = np.asarray(mesh.facets[group], dtype=np.int64)
    if not len(facets):
        raise MeshError(f"{of}: wanted at least one facet in the group {group!r}, found it empty; put facets into it")
    lost = np.setdiff1d(np.arange(len(facets)), _facets_and_cells(mesh.cells, facets, len(mesh.points))[0])
    if len(lost):
        raise MeshError(
            f"{of}, facet group {group!r}: wanted facets of the mesh's cells, found {len(lost)} of no cell, the "
            f"first has the nodes {facets[lost[0]].tolist()}; mesh the boundary together with the body"
        )
    return facets


def boundary_group(mesh: MeshData, group: str, of: str) -> Ints:
    """Facets of a group on the boundary, as by `facet_group`; raises MeshError also for facets inside the body and for
    facets that occur twice."""
    facets = facet_group(mesh, group, of)
    try:
        adjacent_cells(mesh.cells, facets, len(mesh.points))
    except MeshError as error:
        raise MeshError(f"{of}, facet group {group!r}: {error}") from error
    if len(np.unique(np.sort(facets, axis=1), axis=0)) < len(facets):
        raise MeshError(f"{of}, facet group {group!r}: wanted each facet once, found some twice; leave out the copies")
    return facets
