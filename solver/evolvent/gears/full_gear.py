"""All sectors of a gear meshed and condensed together, as a check of the ring of one condensed sector.

Nitsche's constant term is on every tooth, as in the ring; both compliances agree to rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.contact.nitsche.flux_recovery import nitsche_traction, trace_functionals
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.condensation.schur_complement import compliance
from evolvent.fem.material import Material
from evolvent.fem.parallel.cores import Threads
from evolvent.fem.surface import surface_of
from evolvent.gears.ring.ring_compliance import MappedNodes
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.rotation import turn


def whole_mesh(sector: MeshData, cuts: tuple[Ints, Ints], count: int) -> MeshData:
    """All `count` sectors of a gear as one mesh, sector s turned by +2πs/count.

    cuts: nodes (k,) of the low and of the high cut face in matching order. Facet groups: bore, and flank, tooth by
    tooth from tooth 0 on.
    """
    low, high = cuts
    size = len(sector.points)
    number = size * np.arange(count)[:, None] + np.arange(size)
    number[:, high] = np.roll(number[:, low], -1, axis=0)  # a sector's high face is the next one's low face
    used, number = np.unique(number, return_inverse=True)
    number = number.reshape(count, size)
    turned = np.concatenate([sector.points @ turn(2.0 * np.pi * s / count, 3).T for s in range(count)])
    facets = {name: _everywhere(number, sector.facets[name]) for name in ("bore", "flank")}
    cells = _everywhere(number, sector.cells)
    return MeshData(turned[used], sector.shape, sector.order, cells, facets, {"gear": np.arange(len(cells))})


def _everywhere(number: Ints, entities: Ints) -> Ints:
    """Entities (m, k) of a sector in all sectors, (count·m, k); number: (count, nodes of a sector)."""
    return number[:, entities].reshape(-1, entities.shape[1])


@dataclass(frozen=True)
class WholeGear:
    """Compliance of the flanks of some teeth, in one matrix; see `ring_compliance.Compliance`."""

    matrix: Floats
    """Compliance (teeth·n·d, teeth·n·d) [mm/N]."""
    dimension: int
    """Space dimension d."""
    teeth: range
    """Numbers of the teeth."""

    @property
    def node_count(self) -> int:
        """Flank nodes n of one tooth."""
        return len(self.matrix) // (self.dimension * len(self.teeth))

    def jumps(self, parts: Sequence[MappedNodes]) -> Floats:
        """Compliance E C Eᵀ of the parts' maps E as a matrix, in their order (mm/N where E = 1)."""
        dofs = [self._dofs(np.full(len(part.nodes), part.tooth), part.nodes) for part in parts]
        rows = [[part.jumps(other.jumps(self.matrix[np.ix_(j, i)]).T) for other, j in zip(parts, dofs)]
                for part, i in zip(parts, dofs)]
        return np.block(rows)

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        """Displacements (..., k_out, d) [mm] of `rows_out` (k_out, 2) under `forces` (..., k_in, d) [N] on `rows_in`. A
        row is a tooth and a flank node."""
        picked = self.matrix[np.ix_(self._dofs(*rows_in.T), self._dofs(*rows_out.T))]
        loads = forces.reshape(*forces.shape[:-2], -1)
        return np.asarray(loads @ picked).reshape(*forces.shape[:-2], -1, self.dimension)

    def _dofs(self, teeth: Ints, nodes: Ints) -> Ints:
        places = (teeth - self.teeth.start) * self.node_count + nodes
        return (places[:, None] * self.dimension + np.arange(self.dimension)).ravel()


@dataclass(frozen=True)
class WholeSystem:
    """Matrices of a whole gear with Nitsche's constant term, N degrees of freedom."""

    stiffness: sp.csr_matrix
    """Stiffness (N, N) [N/mm]."""
    functionals: sp.csr_matrix
    """Displacements (m, N) of the flanks that enter the contact."""
    free: Ints
    """Free degrees of freedom."""
    graph: sp.csr_matrix
    """Pattern (N, N) of the stiffness without Nitsche's term."""
    teeth: range
    """Numbers of the teeth whose flanks are condensed."""
    dimension: int
    """Space dimension d."""

    def condensed(self, threads: Threads = nullcontext) -> WholeGear:
        """Compliance of the flanks. Raises NotPositiveDefinite, OutOfMemory."""
        with threads():
            dense = compliance(self.stiffness, self.functionals, self.free, graph=self.graph)
        return WholeGear(dense, self.dimension, self.teeth)


def whole_system(
    mesh: MeshData, material: Material, count: int, teeth: range, safety: float | None
) -> WholeSystem:
    """Assembles a `whole_mesh` of `count` sectors, held at its bore.

    teeth: numbers of the teeth whose flanks may touch, −1 is the last one. safety: factor on the stabilisation of
    Nitsche's method, None for the gear that does not carry the pressure.
    """
    assembled = assemble(Body(mesh, material, supports=(Fixed("bore"),), name="whole gear"))
    K, d = assembled.stiffness.tocsr(), assembled.d
    flanks = surface_of(mesh, "flank")
    P = trace_functionals(flanks, K.shape[0])
    graph = sp.csr_matrix((np.ones(K.nnz, dtype=np.int8), K.indices, K.indptr), shape=K.shape)
    if safety is not None:
        traction = nitsche_traction(mesh, material, flanks, safety)
        K, P = (K - traction.constant_term()).tocsr(), P - traction.flux()
    size = P.shape[0] // count  # nodes ascend from tooth to tooth, and so do the flanks' nodes
    wanted = np.concatenate([size * (tooth % count) + np.arange(size) for tooth in teeth])
    return WholeSystem(K, P.tocsr()[wanted], assembled.free, graph, teeth, d)
