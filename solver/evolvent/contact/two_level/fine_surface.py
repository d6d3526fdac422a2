"""The contact surface of a coarsely meshed body, finely divided."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from evolvent.fem.material import Material
from evolvent.fem.surface import Surface, adjacent_cells, surface_of
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.patches import Patch, cells_near, cut_out
from evolvent_meshes.mesh.splitting import SplitMesh, split

Snap = Callable[[Floats], Floats]
"""Moves points (n, 3) that lie nearly on a body's surface onto it [mm]."""

SAME_NODE = 1e-7
"""Fine nodes of different patches closer than this are the same [mm]."""


@dataclass(frozen=True)
class CoarseBody:
    """A body whose mesh does not resolve its contact, and how its cells near the contact are split.

    mesh: second-order quadrilaterals or hexahedra.
    material: of the body.
    group: facet group of the contact surface.
    counts: (n_cells, d) into how many cells each is split along its reference axes in patches, equal within a class
        of edges.
    snap: moves points of the split surface onto the exact one.
    """

    mesh: MeshData
    material: Material
    group: str
    counts: Ints
    snap: Snap

    @property
    def facets(self) -> Ints:
        """Mesh nodes (m, k) of the coarse contact surface's facets."""
        return self.mesh.facets[self.group]

    @cached_property
    def surface(self) -> Surface:
        """The coarse contact surface."""
        return surface_of(self.mesh, self.group)

    @cached_property
    def fine(self) -> FineSurface:
        """Contact surface of the body with its cells split."""
        behind = np.unique(adjacent_cells(self.mesh.cells, self.facets, len(self.mesh.points)))
        return FineSurface.of(self, cut_out(self.mesh, behind))

    def near(self, facets: Ints, reach: float) -> Patch:
        """The cells closer than `reach` [mm] to some of the facets (f,)."""
        return cut_out(self.mesh, cells_near(self.mesh, np.unique(self.facets[facets]), reach))

    def split_patch(self, patch: Patch) -> SplitMesh:
        """A patch with its cells split, its contact surface moved onto the exact one."""
        fine = split(patch.mesh, self.counts[patch.cells])
        on_surface = np.unique(fine.mesh.facets[self.group])
        points = fine.mesh.points.copy()
        points[on_surface] = self.snap(points[on_surface])
        mesh = MeshData(points, fine.mesh.shape, 2, fine.mesh.cells, fine.mesh.facets, fine.mesh.volumes)
        return SplitMesh(mesh, fine.parent, fine.values)


@dataclass(frozen=True)
class FineSurface:
    """The finely divided contact surface of a coarse body, n nodes.

    surface: its nodes, normals and facets; `surface.nodes` are those of `mesh`.
    transfer: (n, c) shape functions of the coarse surface's c nodes at the fine nodes.
    mesh: the split cells behind it.
    """

    surface: Surface
    transfer: sp.csr_matrix
    mesh: MeshData

    @staticmethod
    def of(body: CoarseBody, layer: Patch) -> FineSurface:
        """Fine surface from the cells behind the coarse one."""
        fine = body.split_patch(layer)
        surface = surface_of(fine.mesh, body.group)
        place = np.full(len(body.mesh.points), -1)
        place[body.surface.nodes] = np.arange(len(body.surface.nodes))
        values = fine.values[surface.nodes].tocoo()
        columns = place[layer.nodes[values.col]]
        transfer = sp.csr_matrix((values.data, (values.row, columns)), (len(surface.nodes), len(body.surface.nodes)))
        return FineSurface(surface, transfer, fine.mesh)

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.surface.points)

    def numbers(self, points: Floats) -> Ints:
        """The fine nodes (n,) at points (n, d) [mm]. Raises ValueError where there are none."""
        distance, number = self._tree.query(points)
        if distance.max(initial=0.0) > SAME_NODE:
            raise ValueError(f"patch: wanted nodes of the fine surface, found one {distance.max():.1e} mm off")
        return np.asarray(number)
