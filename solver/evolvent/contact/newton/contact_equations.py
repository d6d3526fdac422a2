"""The equations of a condensed contact system, on the nodal contact forces and the free rigid motions.

Unknowns x = (f, δ), f (n, k) nodal contact forces in local frames, k = 1 without friction, else d:

    f − F(J) = 0,   J = J_0 + H δ − A f              (contact)
    Hᵀ f + D δ = F                                   (balance of the free rigid motions)

D is zero in statics; in a time step it is their inertia. The bodies are eliminated exactly (A is their compliance), so
that this is the finite element system itself. The tangent is in tangent.py, its inverse in newton_steps.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.newton.jump_compliance import JumpCompliance
from evolvent.contact.newton.newton_steps import NewtonSteps
from evolvent.contact.newton.reduced_tangent import FreeMotions
from evolvent.contact.newton.tangent import Tangent
from evolvent.contact.nitsche.contact_operator import ContactLaw, ContactOperator
from evolvent.contact.nitsche.coulomb import LawValues
from evolvent_meshes.arrays import Floats

TOLERANCE = 1e-10  # residual force over the force in the system, where nothing else is wanted
QUADRATIC = 30.0  # lower bound of a relative residual over the square of the one before (200 to 1000 were observed)
ROUGHEST, FINEST = 1e-2, 1e-7  # limits of the accuracy to which a Newton step is solved
LAST_STEP = 1e-2  # of the tolerance: residual that the linear solve of the last step may leave


@dataclass(frozen=True)
class CondensedSystem:
    """The bodies of a contact problem in the local jumps of its contacts, k components a node.

    operator: contact at q points, jumps at n nodes.
    compliance: A (n·k, n·k).
    motion: H (n·k, r), jumps by unit amplitudes of the r free rigid motions.
    jump: J_0 (n·k,), jumps by external loads and prescribed motions [mm].
    load: F (r,), loads on the free rigid motions [N, N·mm].
    resistance: D (r, r), forces against unit amplitudes of the free rigid motions [N/mm, N, N·mm], symmetric.
    lever: (r,) largest jump by a unit amplitude of each motion [mm per unit], to compare forces with moments.
    least_scale: force [N] with which residuals are compared at least.
    tolerance: residual force, over the force in the system, at which Newton's method ends.
    """

    operator: ContactOperator
    compliance: JumpCompliance
    motion: Floats
    jump: Floats
    load: Floats
    resistance: Floats
    lever: Floats
    least_scale: float = 0.0
    tolerance: float = TOLERANCE

    @cached_property
    def motions(self) -> FreeMotions:
        """The free rigid motions in amplitudes times the lever."""
        return FreeMotions(self.motion / self.lever, self.resistance / np.outer(self.lever, self.lever))

    @cached_property
    def steps(self) -> NewtonSteps:
        """Solver of the Newton steps; all friction coefficients share it."""
        return NewtonSteps(self.compliance, self.motions)

    @property
    def k(self) -> int:
        """Number of local components a node: 1 (normal) or d."""
        return len(self.jump) // self.operator.n

    def jumps(self, force: Floats, motion: Floats) -> Floats:
        """J (n, k) [mm] from nodal forces (n, k) [N] and amplitudes of the motions (r,)."""
        return (self.jump + self.motion @ motion - self.compliance.times(force.ravel())).reshape(-1, self.k)

    @property
    def scale(self) -> float:
        """The force [N] that residuals are compared with."""
        return float(np.abs(self.load / self.lever).max(initial=self.least_scale))


@dataclass(frozen=True)
class _State:
    """Contact forces and values of the contact law at some unknowns x.

    force: nodal forces f (n, k) [N].
    jump: J (n, k) [mm].
    law: its values at the points.
    contact: F(J) (n, k) [N].
    """

    force: Floats
    jump: Floats
    law: LawValues
    contact: Floats


class ContactEquations:
    """Residual and tangent of the contact system (a `NonlinearProblem`), over x = (f, δ·lever)."""

    def __init__(self, system: CondensedSystem, law: ContactLaw, slip: Floats | None = None) -> None:
        self.system, self.law, self.slip = system, law, slip
        self.n, self.k, self.r = system.operator.n, system.k, len(system.load)
        self._last: tuple[Floats, _State] | None = None

    def split(self, x: Floats) -> tuple[Floats, Floats]:
        """Forces f (n, k) [N] and motions δ (r,) of x; x has δ times the lever, so that all residuals are forces."""
        return x[: self.n * self.k].reshape(self.n, self.k), x[self.n * self.k :] / self.system.lever

    def join(self, force: Floats, motion: Floats) -> Floats:
        """Unknowns x of forces f (n, k) and motions δ (r,)."""
        return np.concatenate([force.ravel(), motion * self.system.lever])

    def scale(self, x: Floats) -> float:
        """Force with which the residual is compared: load or normal contact force, whichever is larger [N]."""
        return max(self.system.scale, float(np.abs(self.split(x)[0][:, 0]).sum()))

    def state(self, x: Floats) -> _State:
        """Contact state at x. It is stored, since residual, tangent and work are needed at the same x."""
        if self._last is None or not np.array_equal(self._last[0], x):
            force, motion = self.split(x)
            jump = self.system.jumps(force, motion)
            law = self._law(jump)
            self._last = x.copy(), _State(force.copy(), jump, law, self.system.operator.forces(law.traction))
        return self._last[1]

    def residual(self, x: Floats) -> Floats:
        """Residual f − F(J), then Hᵀ f + D δ − F over the lever, (n·k + r,) [N]."""
        at, (_, δ) = self.state(x), self.split(x)
        return np.concatenate([(at.force - at.contact).ravel(), self._balance(at.force, δ) / self.system.lever])

    def _balance(self, force: Floats, motion: Floats) -> Floats:
        """Residual Hᵀ f + D δ − F of the free rigid motions (r,) [N, N·mm]."""
        system = self.system
        return system.motion.T @ force.ravel() + system.resistance @ motion - system.load

    def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
        """Work of the residual forces at x − α step along the step, as function of α [N·mm]. The energy ½fᵀAf +
        ∫(contact) + ½δᵀDδ − Fᵀδ of bodies under any nodal forces f has the derivatives A(f − F(J)) and Hᵀ F(J) + Dδ −
        F."""
        system, (df, dδ), (_, δ) = self.system, self.split(step), self.split(x)
        at = self.state(x)
        after = self.state(x - step)  # stored: the next state if the full step is taken
        change = at.jump - after.jump
        elastic = (system.motion @ dδ).reshape(change.shape) - change  # A df
        known = {0.0: at.contact, 1.0: after.contact}

        def along(α: float) -> float:
            contact = known[α] if α in known else system.operator.forces(self._law(at.jump - α * change).traction)
            return -float(np.sum(elastic * (at.force - α * df - contact)) + dδ @ self._balance(contact, δ - α * dδ))

        return along

    def solve(self, x: Floats, right: Floats) -> Floats:
        """Newton step T(x)⁻¹ right, as accurate as this step needs."""
        accuracy = _accuracy(float(np.linalg.norm(right)), self.scale(x), self.system.tolerance)
        return self.system.steps.solve(self.tangent(x), right, accuracy)

    def tangent(self, x: Floats) -> Tangent:
        """Tangent T at x."""
        steps = self.system.steps
        return Tangent.of(self.system.operator, self.state(x).law, steps.A, steps.motions)

    def _law(self, jump: Floats) -> LawValues:
        """Values of the contact law at the points under jumps (n, k)."""
        return self.law(self.system.operator.trial(jump, self.slip))


def _accuracy(residual: float, scale: float, tolerance: float) -> float:
    """Fraction of the residual to which a Newton step's equations are solved: well below the residual that the
    nonlinearity of the contact law leaves anyway, and no further below the tolerance than results show."""
    relative = residual / scale if scale > 0.0 else 1.0
    roughest = ROUGHEST / max(relative, 1.0)  # of the load too: a start from the right points is not to be lost
    return max(min(QUADRATIC * relative, roughest), LAST_STEP * tolerance / max(relative, tolerance), FINEST)
