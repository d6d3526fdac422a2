"""The smooth coupling of a ring's teeth, against the same without leaving anything out."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import block_diag

from evolvent.fem.condensation.schur_complement import SectorCondensation, SectorSystem
from evolvent.gears.ring.ring_modes import Coupling, compressed, coupling, smooth_faces
from evolvent.gears.ring.sector_interfaces import ClosedRing
from evolvent_meshes.arrays import Floats
from tests.support.q1_elasticity import ring

TEETH, NAMED = 40, 3
TOLERANCES = [1e-4, 1e-6, 1e-8]


def joined(stiffness: Floats) -> ClosedRing:
    return ClosedRing(stiffness, TEETH, NAMED)


@pytest.fixture(scope="module")
def sector() -> SectorCondensation:
    """One of 40 sectors of a ring, 8 × 9 × 7 cells, seen through the 192 displacements of its outer surface; 192
    displacements on each cut face, the high one's in the frame of the next sector."""
    model = ring((8, 9, 7), 1, 2 * np.pi / TEETH)
    number = np.full(model.stiffness.shape[0], -1)
    number[model.free] = np.arange(len(model.free))
    functionals = sp.identity(len(model.free), format="csr")[number[model.surface[0]]]
    restricted = model.stiffness[model.free][:, model.free]
    own = SectorSystem.of(restricted, functionals, number[model.low], number[model.high]).condensed()
    turn = frames(own)
    return SectorCondensation(turn.T @ own.stiffness @ turn, own.transfer @ turn, own.compliance)


def frames(sector: SectorCondensation) -> sp.csr_array:
    c = len(sector.stiffness) // 2
    return sp.csr_array(sp.block_diag([sp.eye(c), sp.kron(sp.eye(c // 3), turn_about_z(2 * np.pi / TEETH))]))


def turn_about_z(angle: float) -> Floats:
    return np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])


def coupled(sector: SectorCondensation, tolerance: float) -> Coupling:
    return coupling(sector, sp.eye(len(sector.stiffness), format="csr"), joined, tolerance)


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_coupling_within_tolerance(sector: SectorCondensation, tolerance: float) -> None:
    """K_ij of every two teeth = T times the faces' displacements under Tᵀ on all of the faces, within the tolerance of
    the largest K_ij; with fewer modes than the surface has displacements, or nothing would be tested."""
    responses, which = joined(sector.stiffness).responses(sector.transfer.T)
    exact = {(i, j): sector.transfer @ responses[which[i, j]] for i, j in np.ndindex(NAMED, NAMED)}
    found = coupled(sector, tolerance)
    largest = max(np.linalg.norm(K) for K in exact.values())
    for (i, j), K in exact.items():
        assert np.linalg.norm(found.modes @ found.between(i, j) @ found.modes.T - K) < tolerance * largest
    assert found.modes.shape[1] < len(sector.transfer)
    np.testing.assert_allclose(found.modes.T @ found.modes, np.eye(found.modes.shape[1]), atol=1e-13)


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_error_of_smooth_faces_is_of_second_order(sector: SectorCondensation, tolerance: float) -> None:
    """Faces that are smooth to half of the digits (fewer than there are) give T A⁻¹ Tᵀ to all of them."""
    c, half = len(sector.stiffness) // 2, np.sqrt(tolerance)
    faces = smooth_faces(sector.stiffness, sector.transfer, half)
    assert faces.shape[1] < c
    middle = sector.stiffness[:c, :c] + sector.stiffness[c:, c:]
    np.testing.assert_allclose(faces.T @ middle @ faces, np.eye(faces.shape[1]), atol=1e-12)
    pair = block_diag(faces, faces)
    transfer, stiffness = sector.transfer @ pair, pair.T @ sector.stiffness @ pair
    exact, found = (
        T @ joined(S).responses(T.T)[0][NAMED - 1]
        for T, S in ((sector.transfer, sector.stiffness), (transfer, stiffness))
    )
    assert np.linalg.norm(found - exact) < tolerance * np.linalg.norm(exact)


def test_ring_coupling_rotates_with_the_tooth_frame(sector: SectorCondensation) -> None:
    """Faces in the sector's own frame, turned by `frames`, couple the teeth as faces do that are turned already."""
    turn = frames(sector)
    own = SectorCondensation(turn @ sector.stiffness @ turn.T, sector.transfer @ turn.T, sector.compliance)
    wanted, found = coupled(sector, 1e-8), coupling(own, turn, joined, 1e-8)
    for i, j in np.ndindex(NAMED, NAMED):
        K = wanted.modes @ wanted.between(i, j) @ wanted.modes.T
        small = 1e-8 * float(np.linalg.norm(K))
        np.testing.assert_allclose(found.modes @ found.between(i, j) @ found.modes.T, K, atol=small)


def test_compressed_matrix_is_within_the_tolerance() -> None:
    """A matrix with singular values 10^-k is met to the asked tolerance with few columns, U orthonormal."""
    random = np.random.default_rng(0)
    left, right = (np.linalg.qr(random.normal(size=(n, 60)))[0] for n in (200, 150))
    matrix = left * 10.0 ** -np.arange(60) @ right.T
    basis, reduced = compressed(matrix.copy(), 1e-6, step=4)
    assert basis.shape[1] <= 12
    assert np.linalg.norm(basis @ reduced - matrix) < 1e-6 * np.linalg.norm(matrix)
    np.testing.assert_allclose(basis.T @ basis, np.eye(basis.shape[1]), atol=1e-13)


@pytest.mark.parametrize("shape", [(7, 30), (30, 7), (8, 8)])
def test_range_of_a_matrix_of_full_rank_has_its_rank(shape: tuple[int, int]) -> None:
    """A matrix of full rank, smaller than a block: all of its range and no column more."""
    matrix = np.random.default_rng(0).normal(size=shape)
    basis, reduced = compressed(matrix, 1e-13, step=16)
    assert basis.shape[1] == min(shape)
    np.testing.assert_allclose(basis @ reduced, matrix, atol=1e-12)
