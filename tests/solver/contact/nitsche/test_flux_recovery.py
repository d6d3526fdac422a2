"""Recovered nodal traction, constants of the inverse trace inequality, and coercivity of the stiffness with them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent import Body, Fixed, Material, MeshData
from evolvent.contact.nitsche import flux_recovery
from evolvent.contact.nitsche.flux_recovery import SAFETY, nitsche_traction
from evolvent.fem.body import assemble
from evolvent.fem.condensation.schur_complement import Factor, NotPositiveDefinite
from evolvent.fem.surface import surface_of
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import box, rectangle

CASES = [(s, o) for s in ("triangle", "quadrilateral", "tetrahedron", "hexahedron") for o in (1, 2)]


def _block(shape: str, order: int) -> MeshData:
    if shape in ("triangle", "quadrilateral"):
        return rectangle(2.0, 1.0, 4, 2, order, shape)
    return box((2.0, 2.0, 1.0), (3, 2, 2), order, shape)


def _field(points: Floats, order: int, seed: int = 0) -> tuple[Floats, Floats]:
    """A polynomial displacement (N, d) of this degree, and its gradient (N, d, d)."""
    d = points.shape[1]
    rng = np.random.default_rng(seed)
    A, B = rng.normal(size=(d, d)), rng.normal(size=(d, d, d)) * (order - 1)
    B = B + np.swapaxes(B, 1, 2)
    return points @ A.T + 0.5 * np.einsum("abc,nb,nc->na", B, points, points), A + np.einsum("abc,nc->nab", B, points)


@pytest.mark.parametrize(("shape", "order"), CASES)
def test_traction_of_a_polynomial_field(shape: str, order: int) -> None:
    """u is a polynomial of the mesh's order, so σ(u)n is known at every node: λ tr ε n + 2μ ε n."""
    mesh, material = _block(shape, order), Material(210e3, 0.3)
    surface = surface_of(mesh, "top")
    u, gradient = _field(mesh.points[:, : mesh.dimension], order)
    found = (nitsche_traction(mesh, material, surface).traction @ u.ravel()).reshape(-1, mesh.dimension)
    λ, μ = material.lame
    ε = 0.5 * (gradient + np.swapaxes(gradient, 1, 2))[surface.nodes]
    stress = λ * np.trace(ε, axis1=1, axis2=2)[:, None, None] * np.eye(mesh.dimension) + 2.0 * μ * ε
    exact = np.einsum("nab,nb->na", stress, surface.normals)
    assert np.abs(found - exact).max() < 1e-10 * np.abs(exact).max()


@pytest.mark.parametrize(
    ("order", "poisson", "wanted"), [(1, 0.3, 1.9), (2, 0.3, 6.3), (1, 0.45, 10.8), (2, 0.45, 26.7)]
)
def test_inverse_trace_constant_of_a_square(order: int, poisson: float, wanted: float) -> None:
    """C_n of a square cell in units of E/h against the values of an independent prototype (two digits)."""
    mesh = rectangle(1.0, 1.0, 4, 4, order)
    constants = nitsche_traction(mesh, Material(1.0, poisson), surface_of(mesh, "top"), safety=1.0).stabiliser
    assert constants[:, 0] * 0.25 == pytest.approx(wanted, rel=0.02)


def test_congruent_cells_share_their_constants(monkeypatch: pytest.MonkeyPatch) -> None:
    """A block of 3 × 5 × 2 graded cells whose layers turn as along a screw: constants are computed for 9 of its 15
    contact cells, 3 in each layer at an end, where the normals of the nodes are means of fewer facets, and 3 in all
    layers between; stabilisers are those of all cells by themselves to 1e-12."""
    computed: list[int] = []
    alone = flux_recovery._trace_constants

    def counted(cells: flux_recovery._ContactCells, material: Material) -> Floats:
        computed.append(len(cells.nodes))
        return alone(cells, material)

    monkeypatch.setattr(flux_recovery, "_trace_constants", counted)
    straight = box((3.0, 5.0, 1.0), (3, 5, 2), 2, "hexahedron")
    x, y, z = straight.points.T
    x = x + 0.1 * x**2
    c, s = np.cos(0.1 * y), np.sin(0.1 * y)
    mesh = replace(straight, points=np.stack([c * x + s * (z + 5.0), y, c * (z + 5.0) - s * x], axis=1))
    top = surface_of(mesh, "top")
    shared = flux_recovery.nitsche_stabiliser(mesh, Material(210e3, 0.3), top)
    assert sum(computed) == 9
    monkeypatch.setattr(flux_recovery, "CONGRUENT", 1e-15)
    assert shared == pytest.approx(flux_recovery.nitsche_stabiliser(mesh, Material(210e3, 0.3), top), rel=1e-12)
    assert sum(computed) == 9 + 15


def _modified(mesh: MeshData, safety: float) -> sp.csr_matrix:
    assembled = assemble(Body(mesh, Material(210e3, 0.3), supports=(Fixed("bottom"),)))
    term = nitsche_traction(mesh, Material(210e3, 0.3), surface_of(mesh, "top"), safety).constant_term()
    free = assembled.free
    return (assembled.stiffness - term)[free][:, free].tocsr()


@pytest.mark.parametrize(("shape", "order"), CASES)
@pytest.mark.parametrize("safety", [1.25, SAFETY])
def test_stiffness_with_gamma_is_coercive(shape: str, order: int, safety: float) -> None:
    """θ = 1: K − ∫F·ΓF is positive definite from 1.25 times the inverse trace constants on (averaging the traction
    between cells costs up to 1.18 with second-order quadrilaterals and hexahedra): no eigenvalue is negative or zero,
    and its Cholesky factor solves with it."""
    stiffness = _modified(_block(shape, order), safety)
    eigenvalues = np.linalg.eigvalsh(stiffness.toarray())
    assert eigenvalues[0] > 1e-12 * eigenvalues[-1]
    load = np.ones(stiffness.shape[0])
    assert np.abs(stiffness @ Factor(stiffness).solve(load) - load).max() < 1e-9


def test_stiffness_far_below_the_limit_is_not_coercive() -> None:
    """With a tenth of the limit the stiffness is indefinite, and its factorisation raises an error."""
    assert np.linalg.eigvalsh(_modified(_block("quadrilateral", 2), 0.1).toarray())[0] < 0.0
    with pytest.raises(NotPositiveDefinite):
        Factor(_modified(_block("quadrilateral", 2), 0.1))


@pytest.mark.parametrize(("shape", "order"), CASES)
def test_rigid_motion_has_no_flux(shape: str, order: int) -> None:
    """A small rotation and a translation cause no stress: F = 0, and δ enters the contact by the trace alone."""
    mesh = _block(shape, order)
    nitsche = nitsche_traction(mesh, Material(210e3, 0.3), surface_of(mesh, "top"))
    d = mesh.dimension
    spin = np.zeros((d, d))
    spin[0, 1], spin[1, 0] = -1.0, 1.0
    u = (mesh.points[:, :d] @ spin.T + 3.0).ravel()
    assert np.abs(nitsche.flux() @ u).max() < 1e-12 * np.abs(u).max()


def test_constant_term_of_a_uniform_stress() -> None:
    """Where F is uniform, ∫ γF_n² + γ_t|F_t|² is its value times the area: uniaxial strain, F_n = σ_yy/γ, F_t = 0."""
    mesh, material = _block("quadrilateral", 2), Material(210e3, 0.3)
    nitsche = nitsche_traction(mesh, material, surface_of(mesh, "top"))
    u = np.zeros((len(mesh.points), 2))
    u[:, 1] = 1e-3 * mesh.points[:, 1]
    λ, μ = material.lame
    normal = (λ + 2.0 * μ) * 1e-3
    γ = nitsche.stabiliser[:, 0]
    assert np.ptp(γ) < 1e-9 * γ[0]
    assert np.allclose((nitsche.flux() @ u.ravel()).reshape(-1, 2), [0.0, normal / γ[0]], atol=1e-14)
    assert u.ravel() @ (nitsche.constant_term() @ u.ravel()) == pytest.approx(2.0 * normal**2 / γ[0], rel=1e-10)
