"""Newton's method by PETSc's SNES for problems that bring their own reduced tangent."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.optimize import brentq

from evolvent.fem.backend.petsc import PETSc
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError

NOT_A_NUMBER = (PETSc.SNES.ConvergedReason.DIVERGED_FNORM_NAN, PETSc.SNES.ConvergedReason.DIVERGED_FUNCTION_DOMAIN)
TURNED = 0.9
"""A step is cut where the work at its end is against it by more than this share of what was with it at its start."""
CLOSE = {"xtol": 1e-6, "rtol": 1e-2}
"""How well the length of a cut step is found: more gains nothing, the next step has another direction."""


class NotConverged(ResultError):
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

    def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
        """Of the length α: what the forces out of balance at x − α step do on the step [N·mm], which is the slope of
        the energy along it where there is one. Negative while going on brings equilibrium nearer."""
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

    error: what a callback raised. It is kept and raised again outside: an exception that unwinds through PETSc leaves
    SNES half-way, and the process ends in a segmentation fault.
    """

    def __init__(self, problem: Nonlinear) -> None:
        self.problem = problem
        self.at: Floats = np.zeros(0)
        self.error: Exception | None = None

    def apply(self, _: PETSc.PC, right: PETSc.Vec, result: PETSc.Vec) -> None:
        try:
            residual = np.array(right.array_r)
            result.array[:] = self._shortened(self.problem.solve(self.at, residual))
        except Exception as error:
            self.error = error
            result.array[:] = 0.0

    def _shortened(self, step: Floats) -> Floats:
        """The step (n,); where it goes too far, cut to the length at which no work is left along it."""
        work = self.problem.work(self.at, step)
        begin, end = work(0.0), work(1.0)
        if begin >= 0.0 or not end > TURNED * -begin:
            return step
        return float(brentq(work, 0.0, 1.0, **CLOSE)) * step


def solve(problem: Nonlinear, start: Floats, stage: str, limit: int, tolerance: float) -> Root:
    """SNES until |residual| <= tolerance·scale(x), with full steps, and shorter ones where these go too far.

    The residual need not fall on the way, as the set of points in contact is still moving, and says little about how
    good a length is: where one body is 200 times as stiff as the other, γ makes it a thousand times the load in states
    near the solution, and choosing the length by it cycled at μ = 0.73. The work along the step does say it: without
    friction it is the slope of a convex energy, of which Newton's step is a direction of descent, so that cutting a
    step where the slope vanishes leads to the solution from everywhere; with friction it has no potential, but works as
    well. Most steps are whole. The length is chosen where the step is made, as petsc4py of Debian has no call for a
    line search of one's own.

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
