"""Equilibrium at one position: SNES on the nodal contact forces and the free rigid motions.

Unknowns x = (f, δ), f (n, k) nodal contact forces in local frames, k = 1 without friction, else d:

    f − F(J) = 0,   J = J_0 + H δ − A f          (contact)
    Hᵀ f = F                                         (balance of the free rigid motions)

The bodies are eliminated exactly (A is their compliance), so this is the finite element system and not a model of it.
The tangent is reduced to the nodes in contact and factored densely.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from meshes.data import Floats
from solver import newton
from solver.friction import Law, coulomb, starting_guess
from solver.newton import NotConverged
from solver.nitsche import ContactOperator, LawOf

TOLERANCE = 1e-10  # residual force over the force in the system
ITERATIONS = 60
PATIENCE = 10  # iterations that a start from a neighbouring solution is given


@dataclass(frozen=True)
class CondensedSystem:
    """What a position's equilibrium needs of the bodies.

    operator: contact at q points, jumps at n nodes. compliance: A (n·k, n·k) [mm/N]. motion: H (n·k, r), free rigid
    motions. jump: J_0 (n·k,) jumps of the external loads and prescribed motions [mm]. load: F (r,) [N, N·mm].
    lever: (r,) what one unit of each motion moves the contact [mm per unit], to compare forces with moments.
    """

    operator: ContactOperator
    compliance: Floats
    motion: Floats
    jump: Floats
    load: Floats
    lever: Floats

    @property
    def k(self) -> int:
        """Local components a node: 1 (normal) or d."""
        return len(self.jump) // len(self.operator.nodes)

    def jumps(self, force: Floats, motion: Floats) -> Floats:
        """J (n, k) from forces (n, k) and motions (r,)."""
        return (self.jump + self.motion @ motion - self.compliance @ force.ravel()).reshape(-1, self.k)

    @property
    def scale(self) -> float:
        """The force [N] that residuals are compared with."""
        return float(np.abs(self.load / self.lever).max(initial=0.0))


@dataclass(frozen=True)
class Equilibrium:
    """A converged state: nodal forces f (n, k) [N] and tractions at the points (q, k) [MPa] in local frames, motions δ
    (r,), jumps (n, k)
    [mm]; Newton iterations and the residual [N] that was left."""

    force: Floats
    traction: Floats
    motion: Floats
    jump: Floats
    iterations: int
    residual: float


def normal_part(system: CondensedSystem) -> CondensedSystem:
    """The frictionless system: normal components only."""
    k = system.k
    return CondensedSystem(
        system.operator, system.compliance[::k, ::k], system.motion[::k], system.jump[::k], system.load, system.lever
    )


def frictionless(system: CondensedSystem, start: np.ndarray | None = None) -> Equilibrium:
    """Equilibrium without friction, of a system with k = 1.

    start: (q,) bool, the points assumed in contact for the first, linear, solve; by default all. Raises NotConverged.
    """
    chosen = np.ones(len(system.operator.weights), dtype=bool) if start is None else start
    problem = _Contact(system, lambda t: coulomb(t, 0.0))
    return _converged(problem, _assumed_contact(system, chosen), "contact without friction")


def stuck(system: CondensedSystem, slip: Floats) -> Equilibrium:
    """The state in which whatever touches sticks, however large the traction: a start for `frictional`, and the only
    one where friction alone carries a load. slip: as there. It is only nearly in equilibrium: at the edge, where stuck
    traction is singular, a point may open and close for ever. Raises NotConverged where it is singular."""
    law = _Contact(system, lambda t: starting_guess(t, 0.0, np.zeros((len(t), system.k - 1))), slip)
    every = np.ones(len(system.operator.weights), dtype=bool)
    start = _assumed_contact(system, every, slip)
    return _equilibrium(law, newton.solve(law, start, "contact without slip", ITERATIONS // 2, TOLERANCE))


def frictional(
    system: CondensedSystem, friction: Floats | float, slip: Floats, heading: Floats, start: Equilibrium,
    neighbour: Equilibrium | None = None,
) -> Equilibrium:  # fmt: skip
    """Equilibrium with Coulomb friction.

    friction: a number or (q,). slip: (n, d−1) what slipped since the last state apart from the present displacement
    [mm]; heading: (q, d−1) the known direction of slip, or zero; start: the equilibrium without friction, or `stuck`.
    neighbour: the equilibrium at another friction coefficient near by, tried first. Raises NotConverged.
    """
    law = _Contact(system, lambda t: coulomb(t, friction), slip)
    if neighbour is not None and neighbour.force.shape[1] == system.k:
        root = newton.solve(law, law.join(neighbour.force, neighbour.motion), "Coulomb friction", PATIENCE, TOLERANCE)
        if root.converged:
            return _equilibrium(law, root)
    try:
        return _converged(law, _guessed(system, friction, slip, heading, start), "Coulomb friction")
    except NotConverged:
        if not heading.any():
            raise
    return _converged(law, _guessed(system, friction, slip, np.zeros_like(heading), start), "Coulomb friction")


def _guessed(
    system: CondensedSystem, friction: Floats | float, slip: Floats, heading: Floats, start: Equilibrium
) -> Floats:
    """x after one iteration with the known directions of slip, all else stuck."""
    force = np.zeros((len(system.operator.nodes), system.k))
    force[:, : start.force.shape[1]] = start.force
    guess = _Contact(system, lambda t: starting_guess(t, friction, heading), slip)
    return newton.solve(guess, guess.join(force, start.motion), "first guess of slip", 1, TOLERANCE).x


class _Contact:
    """Residual and reduced tangent of the contact system."""

    def __init__(self, system: CondensedSystem, law: LawOf, slip: Floats | None = None) -> None:
        self.system, self.law, self.slip = system, law, slip
        self.n, self.k, self.r = len(system.operator.nodes), system.k, len(system.load)

    def split(self, x: Floats) -> tuple[Floats, Floats]:
        """(f, δ) of x; δ is scaled by the lever so that all residuals are forces."""
        return x[: self.n * self.k].reshape(self.n, self.k), x[self.n * self.k :] / self.system.lever

    def join(self, force: Floats, motion: Floats) -> Floats:
        return np.concatenate([force.ravel(), motion * self.system.lever])

    def scale(self, x: Floats) -> float:
        return max(self.system.scale, float(np.abs(self.split(x)[0][:, 0]).sum()))

    def state(self, x: Floats) -> tuple[Floats, Floats, Law]:
        """Forces, jumps and the law there."""
        force, motion = self.split(x)
        jump = self.system.jumps(force, motion)
        return force, jump, self.law(self.system.operator.trial(jump, self.slip))

    def residual(self, x: Floats) -> Floats:
        force, _, law = self.state(x)
        contact = force - self.system.operator.forces(law.traction)
        balance = (self.system.motion.T @ force.ravel() - self.system.load) / self.system.lever
        return np.concatenate([contact.ravel(), balance])

    def solve(self, x: Floats, right: Floats) -> Floats:
        """The tangent's inverse: dense on the nodes in contact, the others only take their own residual."""
        k, r, system = self.k, self.r, self.system
        M = self.system.operator.tangent(self.state(x)[2])
        rows = _rows_of_nodes(M, k)
        if len(rows) == 0 and r:
            raise NotConverged(
                "no node in contact while a motion is free: bring the bodies together, or hold the motion"
            )
        rest = np.setdiff1d(np.arange(self.n * k), rows)
        A, H = system.compliance, system.motion / system.lever
        M, H_a = M[rows][:, rows], H[rows]
        known = A[np.ix_(rows, rest)] @ right[rest] if np.any(right[rest]) else np.zeros(len(rows))
        b = np.concatenate([right[rows] - M @ known, right[self.n * k :] - H[rest].T @ right[rest]])
        y = _regular_solve(_bordered(M, A[np.ix_(rows, rows)], H_a), b)
        result = right.copy()
        result[rows], result[self.n * k :] = y[: len(rows)], y[len(rows) :]
        return result


def _regular_solve(matrix: Floats, right: Floats) -> Floats:
    """matrix⁻¹ right, overwriting the matrix. Raises NotConverged where it is singular to rounding."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", la.LinAlgWarning)
        try:
            return la.solve(matrix, right, overwrite_a=True, check_finite=False)
        except (la.LinAlgError, la.LinAlgWarning) as error:
            raise NotConverged(
                "a free rigid motion meets no resistance: wanted a support, or friction that sticks somewhere; "
                "support the body, prescribe the motion, or lower the load"
            ) from error


def _rows_of_nodes(M: sp.csr_matrix, k: int) -> np.ndarray:
    """The rows of all nodes that M, (n·k, n·k), couples to anything."""
    touched = np.flatnonzero(np.diff(M.indptr).reshape(-1, k).any(axis=1))
    return (k * touched[:, None] + np.arange(k)).ravel()


def _bordered(M: sp.csr_matrix, A: Floats, H: Floats) -> Floats:
    """[I + M A, −M H; Hᵀ, 0]."""
    a, r = H.shape
    T = np.zeros((a + r, a + r))
    T[:a, :a] = M @ A
    T[np.arange(a), np.arange(a)] += 1.0
    T[:a, a:] = -(M @ H)
    T[a:, :a] = H.T
    return T


def _assumed_contact(system: CondensedSystem, chosen: np.ndarray, slip: Floats | None = None) -> Floats:
    """x of the linear problem in which the chosen points touch (and may pull)."""

    def law(trial: Floats) -> Law:
        return Law(np.where(chosen[:, None], trial, 0.0), chosen[:, None, None] * np.eye(system.k))

    problem = _Contact(system, law, slip)
    zero = np.zeros(problem.n * problem.k + problem.r)
    return -problem.solve(zero, problem.residual(zero))


def _converged(problem: _Contact, start: Floats, stage: str) -> Equilibrium:
    root = newton.solve(problem, start, stage, ITERATIONS, TOLERANCE)
    if not root.converged:
        left = root.residual / problem.scale(root.x)
        raise NotConverged(
            f"{stage}: residual {left:.1e} of the load after {root.iterations} iterations; a smaller step may help"
        )
    return _equilibrium(problem, root)


def _equilibrium(problem: _Contact, root: newton.Root) -> Equilibrium:
    force, motion = problem.split(root.x)
    _, jump, law = problem.state(root.x)
    return Equilibrium(force, law.traction, motion, jump, root.iterations, root.residual)
