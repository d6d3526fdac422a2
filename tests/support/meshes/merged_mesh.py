"""Two blocks as one dolfinx mesh whose interface is inside, for forms that UFL writes down and FFCx integrates.

Displacements are first order and discontinuous from cell to cell; `nodes_of_dofs` says which node of which body each
degree of freedom belongs to, and so makes them continuous in each body, but not across the interface.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
import ufl
from dolfinx import fem
from numpy.typing import NDArray

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.material import Material
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData


@dataclass(frozen=True)
class Merged:
    """upper, lower: matching meshes (one facet of "bottom" of the upper for each of "top" of the lower)."""

    upper: MeshData
    lower: MeshData
    materials: tuple[Material, Material]

    @property
    def d(self) -> int:
        return self.upper.dimension

    @cached_property
    def twin(self) -> Ints:
        """(N_lower,) merged node of each node of the lower block; those of the upper block come first."""
        n = len(self.upper.points)
        number = np.arange(n, n + len(self.lower.points))
        here, there = np.unique(self.upper.facets["bottom"]), np.unique(self.lower.facets["top"])
        distance = np.linalg.norm(self.upper.points[here][:, None] - self.lower.points[there][None], axis=2)
        assert distance.min(axis=1).max() < 1e-12, "the interface must match"
        number[there[distance.argmin(axis=1)]] = here
        return number

    @cached_property
    def mesh(self) -> Any:
        used, cells = np.unique(np.concatenate([self.upper.cells, self.twin[self.lower.cells]]), return_inverse=True)
        points = np.concatenate([self.upper.points, self.lower.points])[used]
        assert np.array_equal(used[: len(self.upper.points)], np.arange(len(self.upper.points)))
        count = len(self.upper.cells) + len(self.lower.cells)
        return dolfinx_compat.create_mesh(points, cells.reshape(count, -1), self.upper.shape, self.upper.order)

    @cached_property
    def space(self) -> Any:
        if hasattr(fem, "functionspace"):
            return fem.functionspace(self.mesh, ("Discontinuous Lagrange", 1, (self.d,)))
        return fem.VectorFunctionSpace(self.mesh, ("Discontinuous Lagrange", 1))

    @cached_property
    def in_upper(self) -> Bools:
        """(n_cells,) bool, in dolfinx's order of cells."""
        return dolfinx_compat.input_cells(self.mesh) < len(self.upper.cells)

    def per_cell(self, upper: float, lower: float) -> Any:
        """A number for each body, as a piecewise constant function."""
        make = fem.functionspace if hasattr(fem, "functionspace") else fem.FunctionSpace
        function = fem.Function(make(self.mesh, ("Discontinuous Lagrange", 0)))
        function.x.array[:] = np.where(self.in_upper, upper, lower)
        return function

    def per_node(self, upper: Floats) -> Any:
        """A continuous scalar on the upper block from its nodal values (N_upper,), zero on the lower one."""
        make = fem.functionspace if hasattr(fem, "functionspace") else fem.FunctionSpace
        function = fem.Function(make(self.mesh, ("Discontinuous Lagrange", 1)))
        nodes, dofs = self._cells_of(function.function_space)
        function.x.array[dofs[self.in_upper]] = upper[nodes[self.in_upper]]
        return function

    def _cells_of(self, space: Any) -> tuple[Ints, NDArray[np.int32]]:
        """(n_cells, k) node of the own body (the lower one's come after the upper one's) and block of `space`."""
        n_upper, n_lower = len(self.upper.points), len(self.lower.points)
        cell_nodes = dolfinx_compat.cell_nodes(self.mesh)
        back = np.full(n_upper + n_lower, -1)
        used = np.unique(np.concatenate([np.arange(n_upper), self.twin]))
        back[np.searchsorted(used, self.twin)] = n_upper + np.arange(n_lower)
        dofs = np.asarray(getattr(space.dofmap.list, "array", space.dofmap.list)).reshape(cell_nodes.shape)
        return np.where(self.in_upper[:, None], cell_nodes, back[cell_nodes]), dofs

    @cached_property
    def interface(self) -> Any:
        """The measure dS over the interface."""
        tags = dolfinx_compat.facet_tags(self.mesh, [self.upper.facets["bottom"]])
        return ufl.Measure("dS", domain=self.mesh, subdomain_data=tags)(1)

    @cached_property
    def nodes_of_dofs(self) -> sp.csr_matrix:
        """(n_dofs, (N_upper + N_lower)·d): nodal displacements, upper body first, to degrees of freedom."""
        nodes, dofs = self._cells_of(self.space)
        d, count = self.d, len(self.upper.points) + len(self.lower.points)
        rows = (d * dofs.ravel()[:, None] + np.arange(d)).ravel()
        columns = (d * nodes.ravel()[:, None] + np.arange(d)).ravel()
        return sp.csr_matrix((np.ones(len(rows)), (rows, columns)), (d * dofs.size, d * count))

    def matrix(self, form: Any) -> sp.csr_matrix:
        """A bilinear form in nodal displacements of both bodies."""
        R = self.nodes_of_dofs
        return (R.T @ dolfinx_compat.assemble_csr(form) @ R).tocsr()

    def sides(self, function: Any) -> tuple[Any, Any]:
        """The values on the upper and on the lower side of the interface, whichever of + and − these are."""
        up, low = self.per_cell(1.0, 0.0), self.per_cell(0.0, 1.0)
        return tuple(f("+") * w("+") + f("-") * w("-") for f, w in ((function, up), (function, low)))

    def stress(self, u: Any) -> Any:
        """σ(u) with each body's own material."""
        pairs = zip(*(m.lame for m in self.materials), strict=True)
        λ, μ = (self.per_cell(*pair) for pair in pairs)
        ε = ufl.sym(ufl.grad(u))
        return λ * ufl.tr(ε) * ufl.Identity(self.d) + 2.0 * μ * ε
