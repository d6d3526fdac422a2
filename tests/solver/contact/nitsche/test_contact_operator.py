"""The contact kernels against UFL forms on one merged mesh.

Two blocks of triangles (and tetrahedra) of order 1 meet in a plane with matching facets and become one dolfinx mesh.
There UFL and FFCx integrate jump, traction, contact law and bulk energy over cells and inner facets, and differentiate
the law, with nothing of the solver's own in between.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp
import ufl
from dolfinx import fem

from evidence.verification.references.full_system import FullContact
from evolvent import (
    Body,
    Contact,
    Fixed,
    Freedom,
    Material,
    MeshData,
    Nitsche,
    Problem,
    Rigid,
    Step,
    StepSystem,
    condense_bodies,
)
from evolvent.contact.nitsche.contact_operator import sandwiched
from evolvent.contact.nitsche.coulomb import coulomb
from evolvent.contact.nitsche.flux_recovery import nitsche_traction
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.surface import surface_of
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.shapes.blocks import box, rectangle
from tests.support.meshes.merged_mesh import Merged

STEEL, ALUMINIUM = Material(210e3, 0.3), Material(70e3, 0.35)
FRICTION = 0.2


@pytest.fixture(scope="module", params=["triangle", "tetrahedron"])
def merged(request: pytest.FixtureRequest) -> Merged:
    if request.param == "triangle":
        upper = rectangle(2.0, 1.0, 8, 2, 1, "triangle")
        lower = rectangle(2.0, 1.0, 8, 3, 1, "triangle", origin=(0.0, -1.0))
    else:
        upper = box((2.0, 2.0, 1.0), (2, 2, 1), 1, "tetrahedron")
        lower = box((2.0, 2.0, 1.0), (2, 2, 2), 1, "tetrahedron", origin=(0.0, 0.0, -1.0))
    return Merged(upper, lower, (STEEL, ALUMINIUM))


def _position(merged: Merged, friction: float = FRICTION, theta: float = 1.0) -> StepSystem:
    down = "yz"[merged.d - 2]
    bodies = (
        Body(merged.upper, STEEL, rigid=Rigid("top", (Freedom(down, load=-1000.0),))),
        Body(merged.lower, ALUMINIUM, supports=(Fixed("bottom"),)),
    )
    problem = Problem(bodies, (Contact((0, "bottom"), (1, "top"), friction, reach=0.5),), Nitsche(theta=theta))
    return StepSystem(problem, condense_bodies(problem), Step())


def _surface_dofs(merged: Merged) -> tuple[Ints, Ints]:
    """Degrees of freedom of the nodes of both contact surfaces among those of both bodies."""
    first, second = surface_of(merged.upper, "bottom").nodes, surface_of(merged.lower, "top").nodes
    upper, lower = (
        (merged.d * nodes[:, None] + np.arange(merged.d)).ravel()
        for nodes in (first, len(merged.upper.points) + second)
    )
    return upper, lower


def test_projection_agrees_with_ufl(merged: Merged) -> None:
    """M = ∫N_k N_l and MΠ = ∫N_1 N_2 of the operator over segments; UFL integrates them over inner facets."""
    op, (dofs1, dofs2) = _position(merged).operators[0], _surface_dofs(merged)
    u, v = ufl.TrialFunction(merged.space), ufl.TestFunction(merged.space)
    (u1, u2), (v1, _) = merged.sides(u), merged.sides(v)
    own = merged.matrix(ufl.inner(u1, v1) * merged.interface)[dofs1][:, dofs1]
    other = merged.matrix(ufl.inner(u2, v1) * merged.interface)[dofs1][:, dofs2]
    mass = op.shape.T @ sp.diags(op.weights) @ op.shape
    eye = sp.identity(merged.d)
    assert np.abs(sp.kron(mass, eye) - own).max() < 1e-13
    assert np.abs(own @ sp.kron(op.jump2.matrix(), eye) - other).max() < 1e-13
    assert np.abs(op.gap).max() < 1e-14


def _traction(merged: Merged) -> sp.csr_matrix:
    """S by UFL: the stress of order 1 is constant in a cell, so ∫ψ_j σn/|F| = σn/d there; the mean over the facets."""
    u, v = ufl.TrialFunction(merged.space), ufl.TestFunction(merged.space)
    area = ufl.FacetArea(merged.mesh)
    (v1, _), (σ1, _) = merged.sides(v), merged.sides(merged.stress(u))
    form = merged.d / ufl.avg(area) * ufl.inner(ufl.dot(σ1, _normal(merged)), v1) * merged.interface
    surface = surface_of(merged.upper, "bottom")
    facets_at = np.repeat(np.bincount(surface.facets.ravel()), merged.d)
    return (sp.diags(1.0 / facets_at) @ merged.matrix(form)[_surface_dofs(merged)[0]]).tocsr()


def _normal(merged: Merged) -> Any:
    return ufl.as_vector([0.0] * (merged.d - 1) + [-1.0])


def test_recovered_traction_agrees_with_ufl(merged: Merged) -> None:
    """S of flux_recovery.py against UFL's σ(u)n."""
    found = nitsche_traction(merged.upper, STEEL, surface_of(merged.upper, "bottom")).traction
    exact = _traction(merged)
    assert np.abs(exact[:, found.shape[1] :]).max() < 1e-9
    assert np.abs(found - exact[:, : found.shape[1]]).max() < 1e-12 * np.abs(exact).max()


def _stabilisers(merged: Merged, values: Floats) -> list[Any]:
    """γ and γ_t on the interface, from the values (n, 2) at the surface's nodes."""
    result = []
    for column in values.T:
        nodal = np.zeros(len(merged.upper.points))
        nodal[surface_of(merged.upper, "bottom").nodes] = column
        result.append(merged.sides(merged.per_node(nodal))[0])
    return result


def _flux(merged: Merged, values: Floats) -> sp.csr_matrix:
    """F = Γ⁻¹S at the surface's nodes in the displacements of all nodes; elsewhere zero."""
    d, (dofs, _) = merged.d, _surface_dofs(merged)
    Γ = np.repeat(values[:, 1:], d, axis=1)
    Γ[:, -1] = values[:, 0]  # the interface is flat: its normal is the last axis
    S = _traction(merged)
    place = sp.csr_matrix((np.ones(len(dofs)), (dofs, np.arange(len(dofs)))), (S.shape[1], len(dofs)))
    return (place @ sp.diags(1.0 / Γ.ravel()) @ S).tocsr()


def _constant_term(merged: Merged, values: Floats) -> sp.csr_matrix:
    u, v = ufl.TrialFunction(merged.space), ufl.TestFunction(merged.space)
    (u1, _), (v1, _), n = merged.sides(u), merged.sides(v), _normal(merged)
    γ, γ_t = _stabilisers(merged, values)
    un, vn = ufl.dot(u1, n), ufl.dot(v1, n)
    form = (γ * un * vn + γ_t * (ufl.inner(u1, v1) - un * vn)) * merged.interface
    F = _flux(merged, values)
    return (F.T @ merged.matrix(form) @ F).tocsr()


def test_constant_term_agrees_with_ufl(merged: Merged) -> None:
    """∫ γF_n² + γ_t|F_t|² against UFL's integral of the recovered flux."""
    nitsche = nitsche_traction(merged.upper, STEEL, surface_of(merged.upper, "bottom"))
    n = merged.d * len(merged.upper.points)
    exact = _constant_term(merged, nitsche.stabiliser)[:n, :n]
    assert np.abs(nitsche.constant_term() - exact).max() < 1e-11 * np.abs(exact).max()


class _UflContact:
    """∫ (λn + τ)·[v] and its derivative, differentiated by UFL, at a jump of nodal fields (extended trace above)."""

    def __init__(self, merged: Merged, values: Floats, friction: float) -> None:
        self.merged, self.state = merged, fem.Function(merged.space)
        n, degree = _normal(merged), 5 if merged.d == 2 else 4  # the search's own rule: 3 points, 6 points
        γ, γ_t = _stabilisers(merged, values)
        (w1, w2), (v1, v2) = merged.sides(self.state), merged.sides(ufl.TestFunction(merged.space))
        jump = w1 - w2
        p, q = γ * ufl.dot(jump, n), γ_t * (jump - ufl.dot(jump, n) * n)
        bound, size = friction * p, ufl.sqrt(ufl.dot(q, q))
        share = ufl.conditional(ufl.le(size, bound), 1.0, bound / size)
        touches = ufl.conditional(ufl.gt(p, 0.0), 1.0, 0.0)
        measure = merged.interface(metadata={"quadrature_degree": degree})
        form = ufl.inner(touches * (p * n + share * q), v1 - v2) * measure
        self.force = dolfinx_compat.compile_form(form)
        self.slope = dolfinx_compat.compile_form(ufl.derivative(form, self.state, ufl.TrialFunction(merged.space)))

    def __call__(self, w: Floats) -> tuple[Floats, sp.csr_matrix]:
        R = self.merged.nodes_of_dofs
        self.state.x.array[:] = R @ w
        slope = R.T @ dolfinx_compat.assemble_csr(self.slope) @ R
        return R.T @ dolfinx_compat.assemble_array(self.force), slope.tocsr()


@pytest.mark.parametrize("θ", [1.0, 0.0, -1.0])
def test_residual_and_tangent_agree_with_ufl(merged: Merged, θ: float) -> None:
    """The full residual and tangent of the solver at random states, with open, stuck and sliding points, against
    a(u,v) − θ∫F(u)·ΓF(v) + ∫(λn + τ)·([v] − θF(v)) with UFL's integrals and UFL's derivative."""
    position = _position(merged, theta=θ)
    system = FullContact(position, lambda t: coulomb(t, FRICTION), None)
    values = position.condensed[0].tractions["bottom"].stabiliser
    u, v = ufl.TrialFunction(merged.space), ufl.TestFunction(merged.space)
    energy = ufl.inner(merged.stress(u), ufl.sym(ufl.grad(v))) * ufl.Measure("dx", domain=merged.mesh)
    K = merged.matrix(energy) - θ * _constant_term(merged, values)
    F, T, contact = _flux(merged, values), _unknowns(position, system.size), _UflContact(merged, values, FRICTION)
    seen = []
    for seed in range(4):
        x = 1e-3 * np.random.default_rng(seed).normal(size=system.size)
        everywhere = T @ x
        force, slope = contact(everywhere - F @ everywhere)
        residual = T.T @ (K @ everywhere + force - θ * F.T @ force)
        residual[-1] += 1000.0  # the load on the free motion
        eye = sp.identity(len(everywhere))
        tangent = T.T @ (K + (eye - θ * F).T @ slope @ (eye - F)) @ T
        assert np.abs(system.residual(x) - residual).max() < 1e-11 * np.abs(residual).max()
        assert np.abs(system.tangent(x) - tangent).max() < 1e-11 * np.abs(tangent).max()
        seen.append(system.state(x).traction)
    λ, τ = np.vstack(seen)[:, 0], np.linalg.norm(np.vstack(seen)[:, 1:], axis=1)
    slides = τ > 0.999 * FRICTION * λ
    assert all(state.any() for state in (λ == 0.0, (λ > 0.0) & slides, (λ > 0.0) & ~slides)), "a state was not met"


def test_sandwiched_product_agrees_with_dense_matrices() -> None:
    """Σ_q N_qi D_q N_qj for points of three facets, of two and of three nodes, one of them visited twice, against the
    same sum in dense arrays, exact but for rounding; and no points at all: zero."""
    rng = np.random.default_rng(1)
    nodes = [[4, 1]] * 3 + [[1, 2, 0]] * 2 + [[0, 3]] * 4 + [[4, 1]]
    values = [rng.normal(size=len(row)) for row in nodes]
    ends = np.cumsum([0] + [len(row) for row in nodes])
    N = sp.csr_matrix((np.concatenate(values), np.concatenate(nodes), ends), (len(nodes), 6))
    for k in (1, 2, 3):
        D = rng.normal(size=(len(nodes), k, k))
        wanted = np.einsum("qi,qab,qj->iajb", N.toarray(), D, N.toarray()).reshape(6 * k, 6 * k)
        assert np.abs(sandwiched(N, D).toarray() - wanted).max() < 1e-14 * np.abs(wanted).max()
        assert sandwiched(N[:0], D[:0]).shape == wanted.shape and sandwiched(N[:0], D[:0]).nnz == 0


def _unknowns(position: StepSystem, size: int) -> Floats:
    """(nodal displacements of both bodies) from (free degrees of freedom, the upper body's rigid motion)."""
    first, second = (b.assembled for b in position.condensed)
    n = first.stiffness.shape[0]
    T = np.zeros((n + second.stiffness.shape[0], size))
    T[first.free, np.arange(len(first.free))] = 1.0
    T[n + second.free, len(first.free) + np.arange(len(second.free))] = 1.0
    T[:n, -1] = first.motions.shapes[:, :, 0].ravel()
    return T


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", ["triangle", "quadrilateral", "tetrahedron", "hexahedron"])
def test_inverse_trace_constants_agree_with_eigenvalues_of_ufl_forms(shape: str, order: int) -> None:
    """C_n and C_t of one sheared cell: the largest eigenvalue of UFL's ∫σ_n(v)² against its a(v, v)."""
    mesh = _one_cell(shape, order)
    surface = surface_of(mesh, "top")
    found = nitsche_traction(mesh, ALUMINIUM, surface, safety=1.0).stabiliser[0]
    domain = dolfinx_compat.create_mesh(mesh.points, mesh.cells, mesh.shape, mesh.order)
    space = dolfinx_compat.vector_space(domain, order)
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    λ, μ = ALUMINIUM.lame
    degree = {"quadrature_degree": 2 * order}

    def σ(w: Any) -> Any:
        return λ * ufl.tr(ufl.grad(w)) * ufl.Identity(mesh.dimension) + 2.0 * μ * ufl.sym(ufl.grad(w))

    dx = ufl.Measure("dx", domain=domain, metadata=degree)
    tags = dolfinx_compat.facet_tags(domain, [mesh.facets["top"]])
    ds = ufl.Measure("ds", domain=domain, subdomain_data=tags, metadata={"quadrature_degree": 2 * order + 4})(1)
    n = ufl.FacetNormal(domain)
    a = dolfinx_compat.assemble_csr(ufl.inner(σ(u), ufl.sym(ufl.grad(v))) * dx).toarray()
    normal = dolfinx_compat.assemble_csr(ufl.dot(n, σ(u) * n) * ufl.dot(n, σ(v) * n) * ds).toarray()
    all_of_it = dolfinx_compat.assemble_csr(ufl.inner(σ(u) * n, σ(v) * n) * ds).toarray()
    for constant, form in zip(found, (normal, all_of_it - normal), strict=True):
        values, vectors = la.eigh(a)
        stretch = vectors[:, values > 1e-9 * values[-1]]
        exact = la.eigh(stretch.T @ form @ stretch, stretch.T @ a @ stretch, eigvals_only=True)[-1]
        assert constant == pytest.approx(exact, rel=1e-8)


def _one_cell(shape: str, order: int) -> MeshData:
    """A sheared, stretched block's cell under its top."""
    plane = shape in ("triangle", "quadrilateral")
    whole = rectangle(1.0, 1.0, 1, 1, order, shape) if plane else box((1.0, 1.0, 1.0), (1, 1, 1), order, shape)
    top = whole.facets["top"][:1]
    cell = next(c for c in whole.cells if set(top[0]) <= set(c))
    used, inverse = np.unique(cell, return_inverse=True)
    number = np.full(len(whole.points), -1)
    number[used] = np.arange(len(used))
    points = whole.points[used].copy()
    points[:, 0] *= 1.3
    points[:, 0] += 0.4 * points[:, 1 if plane else 2]
    return MeshData(points, shape, order, inverse.reshape(1, -1), {"top": number[top]}, {"body": np.arange(1)})
