"""The same equilibrium on all degrees of freedom, without condensation: the check that elimination changed nothing.

    K'u + Pᵀ Eᵀ f(J) = load,   J = E P u + H δ,   Hᵀ f = F
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from evolvent.contact.newton import snes
from evolvent.contact.newton.equilibrium import ITERATIONS
from evolvent.contact.nitsche.contact_operator import LawOf
from evolvent.contact.nitsche.coulomb import Law, coulomb, starting_guess
from evolvent.contact.problem.condensed_body import prepare
from evolvent.contact.problem.definition import Problem, Step
from evolvent.contact.step.step_system import Position
from evolvent_meshes.arrays import Floats


class FullContact:
    """Residual and tangent over x = (u of all bodies' free degrees of freedom, δ of all free motions)."""

    def __init__(self, position: Position, law: LawOf, slip: Floats | None) -> None:
        self.law, self.slip = law, slip
        self.condensed = position.system()
        self.op = self.condensed.operator
        bodies = position.prepared
        free = [b.assembled.free for b in bodies]
        self.K = sp.block_diag([b.stiffness for b in bodies], format="csr")
        self.seen = sp.hstack([E @ b.functionals[:, f] for E, b, f in zip(position.maps, bodies, free)]).tocsr()
        self.pushed = sp.hstack([E @ b.forces[:, f] for E, b, f in zip(position.maps, bodies, free)]).tocsr()
        self.load = position.step.load * np.concatenate([b.load for b in bodies])
        held = sum(E @ (b.functionals @ b.assembled.prescribed) for E, b in zip(position.maps, bodies))
        self.prescribed = self.condensed.jump - position.load_jump() + position.step.load * held

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.K.shape[0] + len(self.condensed.load)

    def state(self, x: Floats) -> Law:
        """The law at x; jumps are (n, d)."""
        u, δ = x[: self.K.shape[0]], x[self.K.shape[0] :]
        jump = (self.seen @ u + self.prescribed + self.condensed.motion @ δ).reshape(len(self.op.nodes), -1)
        return self.law(self.op.trial(jump, self.slip))

    def residual(self, x: Floats) -> Floats:
        """(size,) [N, N·mm]."""
        f = self.op.forces(self.state(x).traction).ravel()
        bulk = self.K @ x[: self.K.shape[0]] + self.pushed.T @ f - self.load
        return np.concatenate([bulk, self.condensed.motion.T @ f - self.condensed.load])

    def tangent(self, x: Floats) -> sp.csc_matrix:
        """∂residual/∂x, sparse."""
        slope = self.op.tangent(self.state(x))
        H = sp.csr_matrix(self.condensed.motion)
        left, right = sp.hstack([self.pushed, H]), sp.hstack([self.seen, H])
        return (sp.block_diag([self.K, sp.csr_matrix((H.shape[1], H.shape[1]))]) + left.T @ slope @ right).tocsc()

    def solve(self, x: Floats, right: Floats) -> Floats:
        """tangent⁻¹ right."""
        return spla.splu(self.tangent(x)).solve(right)

    def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
        """See `newton.Nonlinear.work`: the residual is the energy's gradient itself."""
        return lambda α: -float(step @ self.residual(x - α * step))

    def scale(self, x: Floats) -> float:
        """The contact force [N]."""
        return float(np.abs(self.op.weights[:, None] * self.state(x).traction).sum()) + float(np.abs(self.load).sum())


def full_solution(problem: Problem, step: Step, start: Floats | None = None) -> tuple[Floats, FullContact]:
    """Displacements and free motions x (size,) of the first step of a problem, and the system they solve.

    start: x to begin with; by default that of the linear problem with all nodes in contact. Raises NotConverged.
    """
    position = Position(problem, prepare(problem), step)
    return full_equilibrium(position, position.slip(None), start)


def full_equilibrium(position: Position, slip: Floats, start: Floats | None = None) -> tuple[Floats, FullContact]:
    """The same at any position of a sweep; slip (Σn, d−1) since the step before, of `Position.slip`."""
    μ = position.friction
    smooth = FullContact(position, lambda t: coulomb(t, 0.0), None)
    root = snes.solve(smooth, _glued(position) if start is None else start, "full system", ITERATIONS, 1e-11)
    contact = smooth
    if μ.any() and root.converged:
        stuck = FullContact(position, lambda t: starting_guess(t, μ, np.zeros((len(t), t.shape[1] - 1))), slip)
        contact = FullContact(position, lambda t: coulomb(t, μ), slip)
        guess = snes.solve(stuck, root.x, "full system, stuck", 1, 1e-11)
        root = snes.solve(contact, guess.x, "full system with friction", ITERATIONS, 1e-11)
    if not root.converged:
        raise snes.NotConverged(f"full system: residual {root.residual:.1e} N after {root.iterations} iterations")
    return root.x, contact


def _glued(position: Position) -> Floats:
    def law(trial: Floats) -> Law:
        traction, derivative = np.zeros_like(trial), np.zeros((*trial.shape, trial.shape[1]))
        traction[:, 0], derivative[:, 0, 0] = trial[:, 0], 1.0
        return Law(traction, derivative)

    glued = FullContact(position, law, None)
    zero = np.zeros(glued.size)
    return -glued.solve(zero, glued.residual(zero))
