"""Newton's method by PETSc's SNES for problems that bring their own reduced tangent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from petsc4py import PETSc

from meshes.data import Floats

NOT_A_NUMBER = (PETSc.SNES.ConvergedReason.DIVERGED_FNORM_NAN, PETSc.SNES.ConvergedReason.DIVERGED_FUNCTION_DOMAIN)
PATIENCE = 12
"""Full steps in which the smallest residual must fall, before steps are cut."""
AGAIN = 1e-3
"""Residuals as near to each other as this (relative) tell that the same states come again."""
ENOUGH = 0.9
"""Where steps are cut, a full one is still taken if it lowers the residual to this share of it."""
SHORTER = (0.7, 0.4, 0.2, 0.1, 0.03, 0.01)
"""Else the best of these lengths and the full one."""


class NotConverged(RuntimeError):
    """No solution was found; the message says at which stage and how far it was."""


class Nonlinear(Protocol):
    """Residual, and the inverse of its tangent."""

    def residual(self, x: Floats) -> Floats:
        """Residual (n,) at x (n,)."""
        ...

    def solve(self, x: Floats, right: Floats) -> Floats:
        """T(x)⁻¹ right, with T the derivative of the residual."""
        ...

    def scale(self, x: Floats) -> float:
        """What the norm of the residual is small against."""
        ...


@dataclass(frozen=True)
class Root:
    """x (n,), the iterations it took and the norm of the residual that is left."""

    x: Floats
    iterations: int
    residual: float
    converged: bool


class _Tangent:
    """Matrix and preconditioner in one for petsc4py: `apply` is the exact inverse, times the length of the step.

    sizes: of the residuals so far; cycles: whether these come again.
    error: what a callback raised. It is kept and raised again outside: an exception that unwinds through PETSc leaves
    SNES half-way, and the process ends in a segmentation fault.
    """

    def __init__(self, problem: Nonlinear) -> None:
        self.problem = problem
        self.at: Floats = np.zeros(0)
        self.error: Exception | None = None
        self.sizes: list[float] = []
        self.cycles = False

    def apply(self, _: PETSc.PC, right: PETSc.Vec, result: PETSc.Vec) -> None:
        try:
            residual = np.array(right.array_r)
            result.array[:] = self._shortened(self.problem.solve(self.at, residual), float(np.linalg.norm(residual)))
        except Exception as error:
            self.error = error
            result.array[:] = 0.0

    def _shortened(self, step: Floats, size: float) -> Floats:
        """The step (n,); where full steps cycle, cut to the length whose residual is smallest. size: of the residual
        here."""
        again = bool(np.isclose(self.sizes, size, rtol=AGAIN, atol=0.0).any())
        self.sizes.append(size)
        self.cycles |= again or min(self.sizes[-PATIENCE:]) > min(self.sizes)
        if not self.cycles:
            return step

        def left(α: float) -> float:
            return float(np.linalg.norm(self.problem.residual(self.at - α * step)))

        full = left(1.0)
        if full <= ENOUGH * size:
            return step
        return min([(full, 1.0), *((left(α), α) for α in SHORTER)])[1] * step


def solve(problem: Nonlinear, start: Floats, stage: str, limit: int, tolerance: float) -> Root:
    """SNES until |residual| <= tolerance·scale(x), with full steps, and shorter ones where these cycle.

    Full steps are best while the set of points in contact is still moving: the residual need not fall on the way. With
    friction they may cycle for ever where sliding nodes change their direction (seen at μ = 0.3): then the residual is
    compared at a few lengths, which costs a fifth of a step. SNES' l2 search, which takes the residual for smooth along
    the step, cycled itself in four of 90 random gear pairs. The length is chosen where the step is made, as petsc4py of
    Debian has no call for a line search of one's own.

    Raises NotConverged on NaN or a singular tangent; whether too many iterations are an error is left to the caller
    (Root.converged).
    """
    tangent = _Tangent(problem)
    x = PETSc.Vec().createWithArray(start.copy(), comm=PETSc.COMM_SELF)
    snes = _snes(tangent, x)

    def residual(_: PETSc.SNES, at: PETSc.Vec, out: PETSc.Vec) -> None:
        try:
            out.array[:] = problem.residual(np.array(at.array_r))
        except Exception as error:
            tangent.error = error
            out.array[:] = np.nan

    def linearise(_: PETSc.SNES, at: PETSc.Vec, *matrices: PETSc.Mat) -> None:
        tangent.at = np.array(at.array_r)

    def converged(_: PETSc.SNES, iteration: int, norms: tuple[float, float, float]) -> int:
        if tangent.error is not None or not np.isfinite(norms[2]):
            return PETSc.SNES.ConvergedReason.DIVERGED_FNORM_NAN
        if norms[2] <= tolerance * problem.scale(np.array(x.array_r)):
            return PETSc.SNES.ConvergedReason.CONVERGED_FNORM_ABS
        return PETSc.SNES.ConvergedReason.DIVERGED_MAX_IT if iteration >= limit else 0

    snes.setFunction(residual, x.duplicate())
    snes.setJacobian(linearise, snes.getJacobian()[0])
    snes.setConvergenceTest(converged)
    snes.setTolerances(max_it=limit + 1)
    snes.solve(None, x)
    result = Root(np.array(x.array_r), snes.getIterationNumber(), snes.getFunctionNorm(), snes.getConvergedReason() > 0)
    lost = snes.getConvergedReason() in NOT_A_NUMBER  # the norm is then zero, or that of the step before
    snes.destroy()
    if tangent.error is not None:
        raise tangent.error
    if lost or not np.isfinite(result.residual):
        raise NotConverged(f"{stage}: the residual is not a number after {result.iterations} iterations")
    return result


def _snes(tangent: _Tangent, x: PETSc.Vec) -> PETSc.SNES:
    snes = PETSc.SNES().create(comm=PETSc.COMM_SELF)
    options = PETSc.Options("evolvent_")  # petsc4py of Debian has no call for the line search
    options["snes_type"] = "newtonls"
    options["snes_linesearch_type"] = "basic"
    matrix = PETSc.Mat().createPython(x.getSize(), context=tangent, comm=PETSc.COMM_SELF)
    matrix.setUp()
    snes.setJacobian(lambda *_: None, matrix)
    snes.setOptionsPrefix("evolvent_")
    snes.setFromOptions()
    ksp = snes.getKSP()
    ksp.setType("preonly")
    ksp.getPC().setType("python")
    ksp.getPC().setPythonContext(tangent)
    return snes
