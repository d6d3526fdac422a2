"""A digest of a mesh that rounding errors of its points do not change."""

from __future__ import annotations

import math

import numpy as np

from evolvent_meshes.arrays import Ints
from evolvent_meshes.digests import digest
from evolvent_meshes.mesh.mesh_data import MeshData

GRID = 1e-7 / math.sqrt(2.0)
"""Grid to which coordinates are rounded, over the power of two above the largest of them. Sums in another order, as
vector units take them from one call to another, move points by 1e-16 of their distance: of 1,000 meshes with 60,000
coordinates one may get another digest. No round coordinate lies halfway between two points of an irrational grid."""


def mesh_digest(mesh: MeshData) -> str:
    """SHA-256 of the cells and groups of a mesh, and of its points up to `GRID`."""
    return digest((_rounded(mesh), mesh.shape, mesh.order, mesh.cells, mesh.facets, mesh.volumes))


def _rounded(mesh: MeshData) -> Ints:
    """Points (n, d) on the grid."""
    largest = float(np.abs(mesh.points).max(initial=0.0)) or 1.0
    return np.rint(mesh.points / (GRID * 2.0 ** math.ceil(math.log2(largest)))).astype(np.int64)
