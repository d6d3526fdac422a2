"""Newton's method by PETSc's SNES for problems that provide their own inverse of the tangent."""

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
REVERSED = 0.9
"""A step is shortened if the work along it changes sign by more than this fraction of its initial value."""
LENGTH_TOLERANCE = {"xtol": 1e-6, "rtol": 1e-2}
"""Accuracy of the length of a shortened step: more gains nothing, as the next step has another direction."""


class NotConverged(ResultError):
    """No equilibrium was found; the message says at which stage, and the residual that was left."""


class NonlinearProblem(Protocol):
    """A residual and the inverse of its tangent."""

    def residual(self, x: Floats) -> Floats:
        """Residual (n,) at x (n,)."""
        ...

    def solve(self, x: Floats, right: Floats) -> Floats:
        """T(x)⁻¹ right (n,), with T the derivative of the residual."""
        ...

    def scale(self, x: Floats) -> float:
        """The value that the norm of a converged residual is small against."""
        ...

    def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
        """Function of the step length α: the work of the residual forces at x − α step along the step [N·mm].

        It is the derivative of the energy along the step, if there is an energy; negative while a longer step comes
        closer to equilibrium.
        """
        ...


@dataclass(frozen=True)
class Root:
    """Result of SNES.

    x: (n,).
    iterations: number of Newton iterations.
    residual: norm of the residual at x.
    converged: whether it is small enough.
    """

    x: Floats
    iterations: int
    residual: float
    converged: bool


class _SnesTangent:
    """Matrix and preconditioner in one for petsc4py: `apply` is the exact inverse, times the step length.

    at: x of the tangent.
    error: exception of a callback, that of a signal included, raised again after SNES has returned: one that unwinds
        through PETSc leaves SNES in an undefined state, and the process ends in a segmentation fault, or PETSc puts an
        error of its own in its place.
    """

    def __init__(self, problem: NonlinearProblem) -> None:
        self.problem = problem
        self.at: Floats = np.zeros(0)
        self.error: BaseException | None = None

    def apply(self, _: PETSc.PC, right: PETSc.Vec, result: PETSc.Vec) -> None:
        try:
            residual = np.array(right.array_r)
            result.array[:] = self._shortened(self.problem.solve(self.at, residual))
        except BaseException as error:
            self.error = error
            result.array[:] = 0.0

    def _shortened(self, step: Floats) -> Floats:
        """The step (n,); if it goes too far, shortened to the length at which the work along it vanishes."""
        work = self.problem.work(self.at, step)
        begin, end = work(0.0), work(1.0)
        if begin >= 0.0 or not end > REVERSED * -begin:
            return step
        return float(brentq(work, 0.0, 1.0, **LENGTH_TOLERANCE)) * step


def solve(problem: NonlinearProblem, start: Floats, stage: str, limit: int, tolerance: float) -> Root:
    """Newton's method until |residual| <= tolerance·scale(x), with full steps, and shorter ones if these go too far.

    stage: name of the solve in messages. limit: largest number of iterations.

    The residual is no measure of a good step length. It need not decrease while the set of points in contact still
    changes, and if one body is 200 times as stiff as the other, γ makes it a thousand times the load in states near the
    solution: choosing the length by it cycled at μ = 0.73. The work along the step is such a measure. Without friction
    it is the derivative of a convex energy, and Newton's step is a direction of descent, so that shortening the step to
    where the derivative vanishes leads to the solution from everywhere. With friction there is no energy, but it works
    as well. Most steps are full. The length is chosen inside the preconditioner because Debian's petsc4py has no call
    for a user's own line search.

    Raises NotConverged on NaN or a singular tangent. Whether too many iterations are an error is left to the caller
    (`Root.converged`).
    """
    tangent = _SnesTangent(problem)
    x = PETSc.Vec().createWithArray(start.copy(), comm=PETSc.COMM_SELF)
    snes = _snes(tangent, x)

    def residual(_: PETSc.SNES, at: PETSc.Vec, out: PETSc.Vec) -> None:
        try:
            out.array[:] = problem.residual(np.array(at.array_r))
        except BaseException as error:
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


def _snes(tangent: _SnesTangent, x: PETSc.Vec) -> PETSc.SNES:
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
