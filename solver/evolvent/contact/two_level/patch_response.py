"""What fine cells change in the response of a contact surface near a load: a patch of the body, condensed twice.

The patch is clamped where it is cut out of the body. Its compliance with fine cells, where the contact's functionals
are those of Nitsche's method, less that with coarse cells, transferred to the fine nodes, falls off with the distance
from the load like the error of the coarse cells.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.contact.nitsche.flux_recovery import nitsche_traction, trace_functionals
from evolvent.contact.two_level.fine_surface import CoarseBody
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.condensation.schur_complement import Factor, compliance, compliance_by_columns
from evolvent.fem.material import Material
from evolvent.fem.surface import Surface, surface_of
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.patches import CUT, Patch

FEW = 0.25
"""Of a patch's nodes: where forces act on fewer, a solution for each costs less than eliminating the patch's inside."""
Places = Callable[[Floats], Bools]
"""Which of some points (n, d) [mm] are meant, (n,)."""


@dataclass(frozen=True)
class PatchResponse:
    """Fine less coarse displacements of a patch's surface under forces on s of its n fine nodes.

    points: (n, d) the fine nodes [mm].
    loaded: (n,) bool, those with forces.
    change: (n, d, s, d) [mm/N].
    """

    points: Floats
    loaded: Bools
    change: Floats


def patch_response(
    body: CoarseBody, patch: Patch, is_held: tuple[str, ...] = (), flux_safety: float | None = None,
    places: Places | None = None,
) -> PatchResponse:  # fmt: skip
    """Condenses a patch with fine and with coarse cells.

    is_held: facet groups of the body that are fixed.
    flux_safety: factor on the stabilisation of Nitsche's method, where the functionals are those of its pressure side;
        None: they are the displacements.
    places: where forces act, by default at all nodes.

    Raises NotPositiveDefinite, OutOfMemory.
    """
    fine, d = body.split_patch(patch), body.mesh.dimension
    held = tuple(Fixed(name) for name in (CUT, *is_held) if len(patch.mesh.facets.get(name, ())))
    above, below = surface_of(fine.mesh, body.group), surface_of(patch.mesh, body.group)
    n = len(above.points)
    loaded = np.ones(n, dtype=bool) if places is None else places(above.points)
    columns = np.flatnonzero(np.repeat(loaded, d))
    change = _condensed(fine.mesh, body.material, above, held, flux_safety, columns)
    C_coarse = _condensed(patch.mesh, body.material, below, held, None, np.arange(d * len(below.points)))
    R = sp.kron(fine.values[above.nodes][:, below.nodes], np.eye(d), format="csr")
    change -= R @ (R[columns] @ C_coarse).T
    return PatchResponse(above.points, loaded, change.reshape(n, d, -1, d))


def _condensed(
    mesh: MeshData, material: Material, surface: Surface, held: tuple[Fixed, ...], flux_safety: float | None,
    columns: Ints,
) -> Floats:  # fmt: skip
    """Some columns of the compliance of a patch's contact surface, (n·d, columns) [mm/N]."""
    assembled = assemble(Body(mesh, material, supports=held, name="patch"))
    K = assembled.stiffness
    P = trace_functionals(surface, K.shape[0])
    graph = sp.csr_matrix((np.ones(K.nnz, dtype=np.int8), K.indices, K.indptr), shape=K.shape)
    if flux_safety is not None:
        traction = nitsche_traction(mesh, material, surface, flux_safety)
        K, P = K - traction.constant_term(), P - traction.flux()
    if len(columns) < FEW * P.shape[0]:
        return compliance_by_columns(Factor(K, assembled.free), P, P.tocsr()[columns])
    return compliance(K, P, assembled.free, graph=graph)[:, columns]
