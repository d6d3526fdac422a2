"""The compliance of a coarse body, corrected patch by patch, against the compliance of the split body.

A block 12 × 4 mm of steel, plane, held at its bottom, 12 × 4 coarse cells; each split into 3 × 2 near the top.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.contact.nitsche.flux_recovery import nitsche_traction, trace_functionals
from evolvent.contact.two_level.fine_surface import CoarseBody
from evolvent.contact.two_level.patch_response import patch_response
from evolvent.contact.two_level.split_counts import split_counts
from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.condensation.schur_complement import compliance
from evolvent.fem.material import STEEL
from evolvent.fem.surface import Surface, surface_of
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.splitting import split
from evolvent_meshes.shapes.blocks import rectangle

SAFETY = 2.0


def block() -> CoarseBody:
    mesh = rectangle(12.0, 4.0, 12, 4)
    along = np.tile([3, 1], (len(mesh.cells), 1))
    return CoarseBody(mesh, STEEL, "top", split_counts(mesh, "top", along, (2, 2)), lambda points: points)


def condensed(mesh: MeshData, with_flux: bool) -> tuple[Surface, Floats]:
    """The top and its compliance."""
    surface, assembled = surface_of(mesh, "top"), assemble(Body(mesh, STEEL, supports=(Fixed("bottom"),)))
    K, P = assembled.stiffness, trace_functionals(surface, assembled.stiffness.shape[0])
    if with_flux:
        traction = nitsche_traction(mesh, STEEL, surface, SAFETY)
        K, P = K - traction.constant_term(), P - traction.flux()
    return surface, compliance(K, P, assembled.free)


@dataclass(frozen=True)
class Compared:
    """Two-level and exact compliance of the fine top, in the same order, and the correction in the former."""

    two_level: Floats
    exact: Floats
    correction: Floats


def compared(reach: float, with_flux: bool) -> Compared:
    """Patches that extend so far [mm] beyond each coarse facet."""
    body = block()
    fine, d = body.fine, 2
    owned = np.zeros(len(fine.surface.points), dtype=bool)
    D = np.zeros((len(owned), d, len(owned), d))
    for facet in range(len(body.facets)):
        response = patch_response(body, body.near(np.array([facet]), reach), ("bottom",), SAFETY if with_flux else None)
        nodes = fine.numbers(response.points)
        x = np.sort(body.mesh.points[body.facets[facet], 0])
        loaded = (response.points[:, 0] > x[0] - 1e-9) & (response.points[:, 0] < x[-1] + 1e-9) & ~owned[nodes]
        owned[nodes[loaded]] = True
        axes = np.arange(d)
        change = response.change if response.nitsche is None else response.nitsche
        D[np.ix_(nodes, axes, nodes[loaded], axes)] += change[:, :, loaded]
    surface, exact = condensed(split(body.mesh, body.counts).mesh, with_flux)
    order = fine.numbers(surface.points)
    dofs = np.argsort((d * order[:, None] + np.arange(d)).ravel())
    _, coarse = condensed(body.mesh, False)
    R = sp.kron(fine.transfer, np.eye(d), format="csr")
    D = D.reshape(d * len(owned), -1)
    near = (D + D.T) / 2.0
    return Compared(R @ coarse @ R.T + near, exact[np.ix_(dofs, dofs)], near)


@pytest.mark.parametrize("with_flux", [False, True])
def test_patches_correct_all_but_what_their_cut_leaves(with_flux: bool) -> None:
    """The largest error of a column, over its largest entry: patches that reach over one cell leave 2 %, over two
    0.5 %, and those of the whole body nothing. The coarse compliance alone is off by more than a tenth."""
    errors = []
    for reach in (1.1, 2.1, 20.0):
        both = compared(reach, with_flux)
        errors.append(np.abs(both.two_level - both.exact).max() / np.abs(both.exact).max())
    assert errors[0] < 0.02 and errors[1] < 0.005 and errors[2] < 1e-12
    assert np.abs(both.correction).max() > 0.1 * np.abs(both.exact).max()


@pytest.mark.parametrize("upper", [1.1, 6.0])
def test_forces_on_some_nodes_only(upper: float) -> None:
    """The columns of the nodes with x < upper are those of the response to forces on all, whether they are few, solved
    for one by one, or many. Exact."""
    body = block()
    patch = body.near(np.array([1, 2]), 2.1)
    every = patch_response(body, patch, ("bottom",), SAFETY)
    some = patch_response(body, patch, ("bottom",), SAFETY, lambda points: points[:, 0] < upper)
    assert every.loaded.all() and np.array_equal(some.loaded, some.points[:, 0] < upper)
    assert 0 < some.change.shape[2] < every.change.shape[2]
    assert every.nitsche is not None and some.nitsche is not None
    for own, other in ((some.change, every.change), (some.nitsche, every.nitsche)):
        assert own == pytest.approx(other[:, :, some.loaded], abs=1e-11 * np.abs(every.nitsche).max())


def test_flux_is_followed_in_the_fine_cells_about_the_loads() -> None:
    """The further what Nitsche's functionals change is followed beyond the loaded nodes, the less is lost, and nothing
    in all of the patch. In a plane, where responses decay slowest, one and a half fine cells leave 6 % of the
    correction."""
    body = block()
    patch, middle = body.near(np.array([2]), 2.1), float(np.mean(body.mesh.points[body.facets[2], 0]))

    def response(flux_reach: float) -> Floats:
        nitsche = patch_response(
            body, patch, ("bottom",), SAFETY, lambda points: np.abs(points[:, 0] - middle) < 0.51, flux_reach
        ).nitsche
        assert nitsche is not None
        return nitsche

    exact = response(np.inf)
    errors = [np.abs(response(reach) - exact).max() / np.abs(exact).max() for reach in (0.1, 0.51, 1.01, 20.0)]
    assert 0.07 < errors[0] < 0.1 and errors[1] < 0.06 and errors[2] < 0.035 and errors[3] < 1e-12
