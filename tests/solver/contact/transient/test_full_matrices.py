"""Condensed transients against the same time steps on all degrees of freedom."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from evolvent import Body, Contact, Fixed, InitialState, Problem, Rigid, Step, Traction, Transient, TransientSettings
from evolvent.contact.problem.condensed_body import CondensedBody, condense_bodies
from evolvent.contact.step.step_system import StepSystem
from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.fem.boundary import Freedom
from evolvent.fem.mass_matrix import mass_matrix
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle

H, STEPS, DROP = 4e-7, 100, -2500.0  # s, mm/s
RADIUS = 0.5


def hammer() -> Problem:
    """A block under a lid that moves up and down falls on one that is held below, and is pressed; contact opens and
    closes."""
    upper = Body(
        rectangle(3.0, 2.0, 3, 2, origin=(0.5, 2.0005)), loads=(Traction("left", (0.0, -20.0)),),
        rigid=Rigid("top", (Freedom("y", load=-50.0),)), name="hammer",
    )
    lower = Body(rectangle(4.0, 2.0, 5, 2), supports=(Fixed("bottom"),), name="anvil")
    return Problem((upper, lower), (Contact((0, "bottom"), (1, "top"), reach=0.5),))


def basis(body: CondensedBody) -> sp.csr_matrix:
    """(N·d, n + s): from free degrees of freedom and free rigid motions to all displacements."""
    a = body.assembled
    size = a.stiffness.shape[0]
    kept = sp.csr_matrix((np.ones(len(a.free)), (a.free, np.arange(len(a.free)))), (size, len(a.free)))
    return sp.hstack([kept, a.motions.shapes.reshape(size, -1)[:, a.motions.free]]).tocsr()


def by_full_matrices(problem: Problem) -> tuple[Floats, Floats]:
    """Force and height of the hammer's lid after each step: M, K' and the contact law on all degrees of freedom, with
    an active set of quadrature points, nothing of the transient but the weights of its scheme."""
    bodies = condense_bodies(problem)
    system = StepSystem(problem, bodies, Step())
    op, T = system.operators[0], [basis(body) for body in bodies]
    M = sp.block_diag([t.T @ mass_matrix(b.assembled.body) @ t for t, b in zip(T, bodies)]).tocsc()
    stiff = [b.assembled.stiffness - sum(t.constant_term() for t in b.tractions.values()) for b in bodies]
    K = sp.block_diag([t.T @ k @ t for t, k in zip(T, stiff)]).tocsc()
    B = sp.hstack([E @ b.functionals @ t for E, b, t in zip(system.maps, bodies, T)]).tocsr()[:: op.d]
    N, γ, w = op.shape, op.stabiliser[:, 0], op.weights
    load = np.concatenate([t.T @ b.assembled.load for t, b in zip(T, bodies)])
    lid = bodies[0].assembled.free.size
    load[lid] += -50.0
    z, v = np.zeros(len(load)), np.zeros(len(load))
    v[lid] = DROP
    a = spla.spsolve(M, load)
    s = TimeScheme(RADIUS)
    forces, heights = [], []
    for _ in range(STEPS):
        drifted = z + H * v + H**2 * (0.5 - s.beta) * a
        c = (1.0 - s.alpha) / (s.beta * H**2)
        right = load + M @ (c * drifted - s.alpha * a)
        A = (c * M + K).tocsc()
        on = np.zeros(len(γ), dtype=bool)
        for _ in range(60):
            P = sp.diags(w * γ * on)
            G = (N @ B).tocsr()
            z_new = spla.spsolve((A + G.T @ P @ G).tocsc(), right + G.T @ (P @ op.gap))
            λ = γ * (G @ z_new - op.gap)
            if np.array_equal(λ > 0.0, on):
                break
            on = λ > 0.0
        else:
            pytest.fail("the active set does not settle")
        a_new = (z_new - drifted) / (s.beta * H**2)
        v = v + H * ((1.0 - s.gamma) * a + s.gamma * a_new)
        z, a = z_new, a_new
        forces.append(float(w @ np.maximum(λ, 0.0)))
        heights.append(float(z[lid]))
    return np.array(forces), np.array(heights)


def by_modes(problem: Problem, modes: int) -> tuple[Floats, Floats]:
    """The same by `Transient`. Heights are those of the lid, not of the mean axes."""
    run = Transient(problem, TransientSettings(H, modes, spectral_radius=RADIUS),
                    InitialState(velocities={0: (0.0, DROP)}))
    forces, heights = [], []
    top = np.unique(problem.bodies[0].mesh.facets["top"])
    for moment in run.run(STEPS):
        forces.append(-moment.solution.contacts[0].force[1])
        heights.append(float(moment.solution.displacement(0)[top, 1].mean()))
    return np.abs(forces), np.array(heights)


def test_all_modes_are_the_full_matrices() -> None:
    """With all modes: contact force and height of the lid to 1e-7 of their largest, over blows and rebounds."""
    problem = hammer()
    force, height = by_full_matrices(problem)
    assert 0 < np.count_nonzero(force) < STEPS
    found, at = by_modes(problem, 10_000)
    assert np.abs(found - force).max() < 1e-7 * force.max()
    assert np.abs(at - height).max() < 1e-7 * np.abs(height).max()


def test_a_few_modes_converge_to_them() -> None:
    """Heights of the lid with no modes, four and forty: each nearer to the full matrices, the last within 1 %
    of its largest; impulse within 1 % too."""
    problem = hammer()
    force, height = by_full_matrices(problem)
    errors = []
    for modes in (0, 4, 40):
        found, at = by_modes(problem, modes)
        errors.append(np.abs(at - height).max() / np.abs(height).max())
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 0.01
    assert found.sum() == pytest.approx(force.sum(), rel=0.01)
