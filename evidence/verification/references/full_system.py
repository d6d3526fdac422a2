"""The equilibrium of a step on all degrees of freedom, without condensation: the reference for the condensed system.

    K'u + Pᵀ Eᵀ f(J) = load,   J = E P u + H δ,   Hᵀ f = F
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from evolvent.contact.newton import snes
from evolvent.contact.newton.equilibrium import ITERATIONS
from evolvent.contact.nitsche.contact_operator import ContactLaw
from evolvent.contact.nitsche.coulomb import LawValues, coulomb, starting_guess
from evolvent.contact.problem.condensed_body import condense_bodies
from evolvent.contact.problem.definition import Problem, Step
from evolvent.contact.step.step_system import StepSystem
from evolvent_meshes.arrays import Floats


class FullContact:
    """Residual and tangent over x = (u of all bodies' free degrees of freedom, δ of all free motions).

    step_system: pairs, bodies and loads. law: tractions from trial tractions. slip: (Σn, d−1) since the step before
    [mm], as of `StepSystem.slip`.
    """

    def __init__(self, step_system: StepSystem, law: ContactLaw, slip: Floats | None) -> None:
        self.law, self.slip = law, slip
        self.condensed = step_system.system()
        self.op = self.condensed.operator
        bodies, maps, load = step_system.condensed, step_system.maps, step_system.step.load
        free = [b.assembled.free for b in bodies]
        self.K = sp.block_diag([b.stiffness for b in bodies], format="csr")
        self.trial = sp.hstack([E @ b.functionals[:, f] for E, b, f in zip(maps, bodies, free)]).tocsr()
        self.test = sp.hstack([E @ b.test_functionals[:, f] for E, b, f in zip(maps, bodies, free)]).tocsr()
        self.load = load * np.concatenate([b.load for b in bodies])
        held = sum(E @ (b.functionals @ b.assembled.prescribed) for E, b in zip(maps, bodies))
        self.prescribed = self.condensed.jump - step_system.load_jump() + load * held

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.K.shape[0] + len(self.condensed.load)

    def state(self, x: Floats) -> LawValues:
        """Values of the contact law at x."""
        u, δ = x[: self.K.shape[0]], x[self.K.shape[0] :]
        jump = (self.trial @ u + self.prescribed + self.condensed.motion @ δ).reshape(len(self.op.nodes), -1)
        slip = None if self.slip is None else self.op.shape @ self.slip
        return self.law(self.op.trial(jump, slip))

    def residual(self, x: Floats) -> Floats:
        """Residual forces and moments, (size,) [N, N·mm]."""
        f = self.op.forces(self.state(x).traction).ravel()
        bulk = self.K @ x[: self.K.shape[0]] + self.test.T @ f - self.load
        return np.concatenate([bulk, self.condensed.motion.T @ f - self.condensed.load])

    def tangent(self, x: Floats) -> sp.csc_matrix:
        """Sparse matrix ∂residual/∂x."""
        slope = self.op.tangent(self.state(x))
        H = sp.csr_matrix(self.condensed.motion)
        left, right = sp.hstack([self.test, H]), sp.hstack([self.trial, H])
        return (sp.block_diag([self.K, sp.csr_matrix((H.shape[1], H.shape[1]))]) + left.T @ slope @ right).tocsc()

    def solve(self, x: Floats, right: Floats) -> Floats:
        """Newton step tangent⁻¹ right."""
        return spla.splu(self.tangent(x)).solve(right)

    def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
        """Work of the residual forces at x − α step along the step, as function of α [N·mm]: the residual is the
        gradient of the energy."""
        return lambda α: -float(step @ self.residual(x - α * step))

    def scale(self, x: Floats) -> float:
        """Contact force and load [N], with which the residual is compared."""
        return float(np.abs(self.op.weights[:, None] * self.state(x).traction).sum()) + float(np.abs(self.load).sum())


def full_solution(problem: Problem, step: Step, start: Floats | None = None) -> tuple[Floats, FullContact]:
    """Displacements and free motions x (size,) of the first step of a problem, and the system that they solve.

    start: initial x; by default that of the linear problem with all nodes in contact. Raises NotConverged.
    """
    step_system = StepSystem(problem, condense_bodies(problem), step)
    return full_equilibrium(step_system, step_system.slip(None), start)


def full_equilibrium(step_system: StepSystem, slip: Floats, start: Floats | None = None) -> tuple[Floats, FullContact]:
    """Displacements and free motions x (size,) at any step of a sweep, and the system that they solve. slip: (Σn, d−1)
    since the step before, as of `StepSystem.slip`. start: as of `full_solution`. Raises NotConverged."""
    μ = step_system.friction
    smooth = FullContact(step_system, lambda t: coulomb(t, 0.0), None)
    root = snes.solve(smooth, _bonded(step_system) if start is None else start, "full system", ITERATIONS, 1e-11)
    contact = smooth
    if μ.any() and root.converged:
        stuck = FullContact(step_system, lambda t: starting_guess(t, μ, np.zeros((len(t), t.shape[1] - 1))), slip)
        contact = FullContact(step_system, lambda t: coulomb(t, μ), slip)
        guess = snes.solve(stuck, root.x, "full system, stuck", 1, 1e-11)
        root = snes.solve(contact, guess.x, "full system with friction", ITERATIONS, 1e-11)
    if not root.converged:
        raise snes.NotConverged(f"full system: residual {root.residual:.1e} N after {root.iterations} iterations")
    return root.x, contact


def _bonded(step_system: StepSystem) -> Floats:
    """Solution x of the linear problem in which all points are in contact, without friction."""

    def law(trial: Floats) -> LawValues:
        traction, derivative = np.zeros_like(trial), np.zeros((*trial.shape, trial.shape[1]))
        traction[:, 0], derivative[:, 0, 0] = trial[:, 0], 1.0
        return LawValues(traction, derivative)

    bonded = FullContact(step_system, law, None)
    zero = np.zeros(bonded.size)
    return -bonded.solve(zero, bonded.residual(zero))
