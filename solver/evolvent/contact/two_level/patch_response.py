"""What fine cells change in the response of a contact surface near a load: a patch of the body, condensed twice.

The patch is clamped where it is cut out of the body. Its compliance with fine cells, where the contact's functionals
are those of Nitsche's method, less that with coarse cells, transferred to the fine nodes, falls off with the distance
from the load like the error of the coarse cells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.contact.nitsche.flux_recovery import nitsche_traction, trace_functionals
from evolvent.contact.two_level.fine_surface import CoarseBody
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.condensation.schur_complement import compliance
from evolvent.fem.material import Material
from evolvent.fem.surface import Surface, surface_of
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.patches import CUT, Patch


@dataclass(frozen=True)
class PatchResponse:
    """Fine less coarse displacements of a patch's surface under forces on all of its fine nodes.

    points: (n, d) the fine nodes [mm].
    change: (n, d, n, d) [mm/N].
    """

    points: Floats
    change: Floats


def patch_response(
    body: CoarseBody, patch: Patch, is_held: tuple[str, ...] = (), flux_safety: float | None = None
) -> PatchResponse:
    """Condenses a patch with fine and with coarse cells.

    is_held: facet groups of the body that are fixed.
    flux_safety: factor on the stabilisation of Nitsche's method, where the functionals are those of its pressure side;
        None: they are the displacements.

    Raises NotPositiveDefinite, OutOfMemory.
    """
    fine, d = body.split_patch(patch), body.mesh.dimension
    held = tuple(Fixed(name) for name in (CUT, *is_held) if len(patch.mesh.facets.get(name, ())))
    above, C_fine = _condensed(fine.mesh, body.material, body.group, held, flux_safety)
    below, C_coarse = _condensed(patch.mesh, body.material, body.group, held, None)
    R = sp.kron(fine.values[above.nodes][:, below.nodes], np.eye(d), format="csr")
    C_fine -= R @ (R @ C_coarse).T
    n = len(above.points)
    return PatchResponse(above.points, C_fine.reshape(n, d, n, d))


def _condensed(
    mesh: MeshData, material: Material, group: str, held: tuple[Fixed, ...], flux_safety: float | None
) -> tuple[Surface, Floats]:
    """A patch's contact surface and its compliance (n·d, n·d) [mm/N]."""
    surface, assembled = surface_of(mesh, group), assemble(Body(mesh, material, supports=held, name="patch"))
    K = assembled.stiffness
    P = trace_functionals(surface, K.shape[0])
    graph = sp.csr_matrix((np.ones(K.nnz, dtype=np.int8), K.indices, K.indptr), shape=K.shape)
    if flux_safety is not None:
        traction = nitsche_traction(mesh, material, surface, flux_safety)
        K, P = K - traction.constant_term(), P - traction.flux()
    return surface, compliance(K, P, assembled.free, graph=graph)
