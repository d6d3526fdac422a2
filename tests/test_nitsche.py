"""The contact kernels against UFL forms on one merged mesh.

Two blocks of triangles (and tetrahedra) of order 1 meet in a plane with matching facets, so that ψ_j = N_j, and become
one dolfinx mesh. There UFL and FFCx integrate the jump across the inner facets, the traction and the bulk energy, with
nothing of the solver's own in between.
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp
import ufl
from merged_mesh import Merged

from meshes.blocks import box, rectangle
from meshes.data import MeshData
from solver import compat
from solver.body import Body, Fixed, Freedom, Rigid
from solver.friction import coulomb
from solver.full import FullContact
from solver.material import Material
from solver.nitsche import tangent_frames
from solver.problem import Contact, Nitsche, Position, Problem, Step, prepare
from solver.surface import surface_of
from solver.traction import nitsche_traction

STEEL, ALUMINIUM = Material(210e3, 0.3), Material(70e3, 0.35)
FRICTION = 0.2


@pytest.fixture(scope="module", params=["triangle", "tetrahedron"])
def merged(request):
    if request.param == "triangle":
        upper = rectangle(2.0, 1.0, 8, 2, 1, "triangle")
        lower = rectangle(2.0, 1.0, 8, 3, 1, "triangle", origin=(0.0, -1.0))
    else:
        upper = box((2.0, 2.0, 1.0), (2, 2, 1), 1, "tetrahedron")
        lower = box((2.0, 2.0, 1.0), (2, 2, 2), 1, "tetrahedron", origin=(0.0, 0.0, -1.0))
    return Merged(upper, lower, (STEEL, ALUMINIUM))


def _position(merged: Merged, friction: float = FRICTION, theta: float = 1.0) -> Position:
    down = "yz"[merged.d - 2]
    bodies = (
        Body(merged.upper, STEEL, rigid=Rigid("top", (Freedom(down, load=-1000.0),))),
        Body(merged.lower, ALUMINIUM, supports=(Fixed("bottom"),)),
    )
    problem = Problem(bodies, (Contact((0, "bottom"), (1, "top"), friction, reach=0.5),), Nitsche(theta=theta))
    return Position(problem, prepare(problem), Step())


def _jump(merged: Merged) -> tuple[sp.csr_matrix, np.ndarray]:
    """∫ψ_j [u] for all nodes of both bodies, and m_j on the upper one, both by UFL."""
    u, v = ufl.TrialFunction(merged.space), ufl.TestFunction(merged.space)
    (u1, u2), (v1, _) = merged.sides(u), merged.sides(v)
    jump = merged.matrix(ufl.inner(u1 - u2, v1) * merged.interface)
    mass = merged.matrix(ufl.inner(u1, v1) * merged.interface)
    return jump, np.asarray(mass.sum(axis=1)).ravel()


def _surface_dofs(merged: Merged) -> tuple[np.ndarray, np.ndarray]:
    """Degrees of freedom of the nodes of both contact surfaces among those of both bodies."""
    first, second = surface_of(merged.upper, "bottom").nodes, surface_of(merged.lower, "top").nodes
    every = (first, len(merged.upper.points) + second)
    return tuple((merged.d * n[:, None] + np.arange(merged.d)).ravel() for n in every)


def test_weighted_jump(merged):
    """jump1, jump2 and m_j of the operator are ∫ψ_j N_k over segments; UFL integrates them over inner facets."""
    op, d = _position(merged).operators[0], merged.d
    jump, m = _jump(merged)
    dofs1, dofs2 = _surface_dofs(merged)
    assert np.allclose(op.weights, m[dofs1[::d]], rtol=1e-12)
    for found, exact in ((op.jump1, jump[dofs1][:, dofs1]), (-op.jump2, jump[dofs1][:, dofs2])):
        assert np.abs(sp.kron(found, sp.identity(d)) - sp.diags(1.0 / m[dofs1]) @ exact).max() < 1e-13
    assert np.abs(op.gap).max() < 1e-14


def _traction(merged: Merged) -> sp.csr_matrix:
    """S by UFL: the stress of order 1 is constant in a cell, so ∫ψ_j σn/|F| = σn/d there; the mean over the facets."""
    u, v = ufl.TrialFunction(merged.space), ufl.TestFunction(merged.space)
    area = ufl.FacetArea(merged.mesh)
    (v1, _), n = merged.sides(v), ufl.as_vector([0.0] * (merged.d - 1) + [-1.0])
    σ1, _ = merged.sides(merged.stress(u))
    form = merged.d / ufl.avg(area) * ufl.inner(ufl.dot(σ1, n), v1) * merged.interface
    surface = surface_of(merged.upper, "bottom")
    facets_at = np.repeat(np.bincount(surface.facets.ravel()), merged.d)
    return (sp.diags(1.0 / facets_at) @ merged.matrix(form)[_surface_dofs(merged)[0]]).tocsr()


def test_recovered_traction(merged):
    """S of solver/traction.py against UFL's σ(u)n."""
    surface = surface_of(merged.upper, "bottom")
    found = nitsche_traction(merged.upper, STEEL, surface).traction
    exact = _traction(merged)
    assert np.abs(exact[:, found.shape[1] :]).max() < 1e-9
    assert np.abs(found - exact[:, : found.shape[1]]).max() < 1e-12 * np.abs(exact).max()


def _ufl_residual(merged: Merged, position: Position, θ: float, friction: float):
    """Residual and tangent over the nodes of both bodies, put together from UFL's matrices and the formulas of the
    brief: a(u,v) − θ Σ m F̄·ΓF̄ + Σ m (λ n + τ)·([v] − θ F̄(v))."""
    jump, m_all = _jump(merged)
    dofs1, _ = _surface_dofs(merged)
    d, m = merged.d, m_all[dofs1][:: merged.d]
    u, v = ufl.TrialFunction(merged.space), ufl.TestFunction(merged.space)
    K = merged.matrix(ufl.inner(merged.stress(u), ufl.sym(ufl.grad(v))) * ufl.Measure("dx", domain=merged.mesh))
    γ = position.operators[0].stabiliser
    Γ = np.repeat(γ[:, 1:], d, axis=1)
    Γ[:, -1] = γ[:, 0]  # the interface is flat: its normal is the last axis
    average = sp.diags(1.0 / m_all[dofs1])
    mass1 = jump[dofs1][:, dofs1]
    F = average @ mass1 @ sp.diags(1.0 / Γ.ravel()) @ _traction(merged)
    B = average @ jump[dofs1]
    K = K - θ * F.T @ sp.diags(np.repeat(m, d) * Γ.ravel()) @ F
    frames = tangent_frames(np.tile([0.0] * (d - 1) + [-1.0], (len(m), 1)))
    local = sp.block_diag(list(frames), format="csr")
    trial_of, push = local @ (B - F), local @ (B - θ * F)
    slope = np.hstack([γ[:, :1]] + [γ[:, 1:]] * (d - 1))

    def both(x):
        law = coulomb((trial_of @ x).reshape(-1, d) * slope, friction)
        D = sp.block_diag(list(m[:, None, None] * law.derivative * slope[:, None, :]), format="csr")
        return K @ x + push.T @ (m[:, None] * law.traction).ravel(), K + push.T @ D @ trial_of

    return both


@pytest.mark.parametrize("θ", [1.0, 0.0, -1.0])
def test_residual_and_tangent(merged, θ):
    """The full residual and tangent of the solver at random states, among them open, stuck and sliding nodes, against
    the ones put together from UFL's matrices."""
    position = _position(merged, theta=θ)
    system = FullContact(position, lambda t: coulomb(t, FRICTION), None)
    by_ufl, T = _ufl_residual(merged, position, θ, FRICTION), _unknowns(position, system.size)
    seen = []
    for seed in range(6):
        x = 1e-3 * np.random.default_rng(seed).normal(size=system.size)
        residual, tangent = by_ufl(T @ x)
        wanted = T.T @ residual
        wanted[-1] += 1000.0  # the load on the free motion
        assert np.abs(system.residual(x) - wanted).max() < 1e-11 * np.abs(residual).max()
        assert np.abs(system.tangent(x) - T.T @ tangent @ T).max() < 1e-11 * np.abs(tangent).max()
        seen.append(system.state(x).traction)
    λ, τ = np.vstack(seen)[:, 0], np.linalg.norm(np.vstack(seen)[:, 1:], axis=1)
    slides = τ > 0.999 * FRICTION * λ
    assert all(state.any() for state in (λ == 0.0, (λ > 0.0) & slides, (λ > 0.0) & ~slides)), "a state was not met"


def _unknowns(position: Position, size: int) -> np.ndarray:
    """(nodal displacements of both bodies) from (free degrees of freedom, the upper body's rigid motion)."""
    first, second = (b.assembled for b in position.prepared)
    n = first.stiffness.shape[0]
    T = np.zeros((n + second.stiffness.shape[0], size))
    T[first.free, np.arange(len(first.free))] = 1.0
    T[n + second.free, len(first.free) + np.arange(len(second.free))] = 1.0
    T[:n, -1] = first.motions.shapes[:, :, 0].ravel()
    return T


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", ["triangle", "quadrilateral", "tetrahedron", "hexahedron"])
def test_inverse_trace_constants(shape, order):
    """C_n and C_t of one sheared cell: the largest eigenvalue of UFL's ∫σ_n(v)² against its a(v, v)."""
    mesh = _one_cell(shape, order)
    surface = surface_of(mesh, "top")
    found = nitsche_traction(mesh, ALUMINIUM, surface, safety=1.0).stabiliser[0]
    domain = compat.create_mesh(mesh.points, mesh.cells, mesh.shape, mesh.order)
    space = compat.vector_space(domain, order)
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    λ, μ = ALUMINIUM.lame
    degree = {"quadrature_degree": 2 * order}

    def σ(w):
        return λ * ufl.tr(ufl.grad(w)) * ufl.Identity(mesh.dimension) + 2.0 * μ * ufl.sym(ufl.grad(w))

    dx = ufl.Measure("dx", domain=domain, metadata=degree)
    tags = compat.facet_tags(domain, [mesh.facets["top"]])
    ds = ufl.Measure("ds", domain=domain, subdomain_data=tags, metadata={"quadrature_degree": 2 * order + 4})(1)
    n = ufl.FacetNormal(domain)
    a = compat.assemble_csr(ufl.inner(σ(u), ufl.sym(ufl.grad(v))) * dx).toarray()
    normal = compat.assemble_csr(ufl.dot(n, σ(u) * n) * ufl.dot(n, σ(v) * n) * ds).toarray()
    all_of_it = compat.assemble_csr(ufl.inner(σ(u) * n, σ(v) * n) * ds).toarray()
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
