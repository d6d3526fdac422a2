"""What Nitsche's functionals change in a compliance, from that of displacements and flux, against elimination of the
stiffness with the constant term. Blocks of steel, held at their bottom, in contact on top."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.nitsche.flux_recovery import nitsche_traction, trace_functionals
from evolvent.contact.two_level.flux_change import flux_change
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.condensation.schur_complement import NotPositiveDefinite, compliance
from evolvent.fem.material import STEEL
from evolvent.fem.surface import surface_of
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import box, rectangle


def found_and_exact(mesh: MeshData, columns: Ints, safety: float) -> tuple[Floats, Floats]:
    """The change, and the difference of two compliances, (m, c)."""
    surface, assembled = surface_of(mesh, "top"), assemble(Body(mesh, STEEL, supports=(Fixed("bottom"),)))
    K, free = assembled.stiffness, assembled.free
    traction = nitsche_traction(mesh, STEEL, surface, safety)
    P, F = trace_functionals(surface, K.shape[0]), traction.flux()
    found = flux_change(compliance(K, sp.vstack([P, F], "csr"), free), traction.weight(), columns)
    exact = compliance(K - traction.constant_term(), P - F, free) - compliance(K, P, free)
    return found, exact[:, columns]


@pytest.mark.parametrize("mesh", [rectangle(4.0, 2.0, 6, 3, 2), box((2.0, 2.0, 1.0), (3, 2, 2), 2, "hexahedron")])
@pytest.mark.parametrize("every", [1, 3])
def test_change_by_nitsches_functionals(mesh: MeshData, every: int) -> None:
    """All columns, and a third of them, which take another way. Exact, to rounding."""
    size = mesh.dimension * len(np.unique(mesh.facets["top"]))
    found, exact = found_and_exact(mesh, np.arange(0, size, every), 2.0)
    assert np.abs(found - exact).max() < 1e-11 * np.abs(exact).max()


def test_stabiliser_below_the_limit_is_refused() -> None:
    """γ of a fifth of the limit of single cells: K − FᵀWF is indefinite."""
    with pytest.raises(NotPositiveDefinite, match="Nitsche's γ is above C_n"):
        found_and_exact(rectangle(4.0, 2.0, 6, 3, 2), np.arange(3), 0.2)
