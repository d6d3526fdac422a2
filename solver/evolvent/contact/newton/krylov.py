"""GMRES of PETSc for a matrix and a preconditioner that are known by products."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from evolvent.fem.backend.petsc import PETSc
from evolvent_meshes.arrays import Reals

Product = Callable[[Reals], Reals]


class _Product:
    """A product as PETSc wants it; an exception in it is kept, as it cannot pass through PETSc."""

    def __init__(self, product: Product, dtype: type) -> None:
        self.product, self.dtype = product, dtype
        self.error: Exception | None = None

    def mult(self, _: object, x: PETSc.Vec, y: PETSc.Vec) -> None:
        self.apply(_, x, y)

    def apply(self, _: object, x: PETSc.Vec, y: PETSc.Vec) -> None:
        try:
            y.array[:] = self.product(x.array_r.astype(self.dtype))
        except Exception as error:
            self.error = error
            y.array[:] = np.nan


def gmres(
    times: Product, inverse: Product, right: Reals, relative: float, limit: int
) -> tuple[Reals, bool]:
    """Solution y (n,) with |right − T y| ≤ relative |right|, and whether that was reached in `limit` iterations.

    times: T y. inverse: nearly T⁻¹ y, applied from the right, so that the residual is that of T. Both get vectors of
    the precision of `right`, and their exceptions are raised again.
    """
    matrix, preconditioner = (_Product(product, right.dtype.type) for product in (times, inverse))
    size = len(right)
    ksp = PETSc.KSP().create(comm=PETSc.COMM_SELF)
    operator = PETSc.Mat().createPython(size, context=matrix, comm=PETSc.COMM_SELF)
    operator.setUp()
    ksp.setOperators(operator)
    ksp.setType("gmres")
    ksp.setPCSide(PETSc.PC.Side.RIGHT)
    ksp.setGMRESRestart(limit)
    ksp.setTolerances(rtol=relative, atol=0.0, divtol=1e10, max_it=limit)
    ksp.getPC().setType("python")
    ksp.getPC().setPythonContext(preconditioner)
    b = PETSc.Vec().createWithArray(right.astype(float), comm=PETSc.COMM_SELF)
    y = b.duplicate()
    ksp.solve(b, y)
    reached = ksp.getConvergedReason() > 0
    for each in (ksp, operator):  # PETSc holds its Python objects until then
        each.destroy()
    for product in (matrix, preconditioner):
        if product.error is not None:
            raise product.error
    return np.array(y.array_r, dtype=right.dtype), reached
