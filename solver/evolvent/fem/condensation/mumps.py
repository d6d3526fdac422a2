"""MUMPS through PETSc on one process: Cholesky factor and dense Schur complement of a sparse symmetric matrix.

petsc4py has no call for the Schur complement, the PETSc C library has. It is reached by ctypes through petsc4py's
extension module, whose symbols include those of the libpetsc that it is linked to: no path has to be known.
Sources: PETSc manual pages MatFactorSetSchurIS, MatFactorGetSchurComplement; MUMPS users' guide 5.5, ICNTL(14, 27,
31), INFOG(1, 2, 12, 16).
"""

from __future__ import annotations

import ctypes
import weakref
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.fem.backend.petsc import PETSc
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import EvolventError, InputError

# INFOG(1) where MUMPS asks for a larger ICNTL(14)
_WORKSPACE_TOO_SMALL = (-8, -9, -11, -14, -15, -17, -20)
_NOT_POSITIVE_DEFINITE = (-10, -40)


class NotPositiveDefinite(InputError):
    """A stiffness that has to be positive definite is not; the message says what to check."""


def not_positive_definite(rows: int, negative: int) -> NotPositiveDefinite:
    """The error of a block of `rows` rows with at least `negative` negative or zero pivots."""
    return NotPositiveDefinite(
        f"a positive definite stiffness is wanted, found {negative} or more negative or zero pivots in {rows} of its "
        "rows: check that the body is held in every direction, that no cell is inverted, and that Nitsche's γ is "
        "above C_n (2 C_n is recommended) on every contact facet"
    )


class OutOfMemory(EvolventError, MemoryError):
    """MUMPS could not allocate its memory; the message gives INFOG(1), INFOG(2) and the size of the problem."""


@dataclass(frozen=True)
class FactorSettings:
    """Settings of one factorisation by MUMPS.

    workspace: allowances above MUMPS' memory estimate [%] (ICNTL(14)), tried one after the other.
    block: right-hand sides solved together (ICNTL(27)).
    """

    workspace: tuple[int, ...] = (20, 60, 200)
    block: int = 128


DEFAULT_FACTOR = FactorSettings()


class SparseCholesky:
    """Cholesky factor LLᵀ of a sparse symmetric positive definite matrix.

    upper: its upper triangle (n × n).
    Raises NotPositiveDefinite and OutOfMemory.
    """

    def __init__(self, upper: sp.spmatrix, settings: FactorSettings = DEFAULT_FACTOR) -> None:
        # kept as long as the factor: MUMPS points into the matrix, and reads it in iterative refinement
        matrix = symmetric_matrix(upper)
        self._factor = _factorise(matrix, 0, settings)
        weakref.finalize(self, _destroy, self._factor, matrix).atexit = False

    def solve(self, right: Floats) -> Floats:
        """X (n × c) with A X = `right` (n × c)."""
        columns = np.asfortranarray(right, dtype=np.float64)
        solution = np.zeros_like(columns, order="F")
        b = PETSc.Mat().createDense(columns.shape, array=columns, comm=PETSc.COMM_SELF)
        x = PETSc.Mat().createDense(columns.shape, array=solution, comm=PETSc.COMM_SELF)
        self._factor.matSolve(b, x)
        _destroy(b, x)
        return solution


def schur_complement(upper: sp.spmatrix, size: int, settings: FactorSettings = DEFAULT_FACTOR) -> Floats:
    """Schur complement S = A₂₂ − A₂₁A₁₁⁻¹A₁₂ (size × size, C order) of the last `size` rows of a symmetric A.

    Only the upper triangle of S is defined: it is the memory that MUMPS wrote to, without a copy. The factor is not
    stored.

    upper: upper triangle of A (n × n); A₁₁ must be positive definite, A₂₂ may be indefinite or empty.
    Raises NotPositiveDefinite and OutOfMemory.
    """
    matrix = symmetric_matrix(upper)
    factor = _factorise(matrix, size, settings)
    schur, status, data = ctypes.c_void_p(), ctypes.c_int(), ctypes.POINTER(ctypes.c_double)()
    _call("MatFactorGetSchurComplement", _handle(factor), ctypes.byref(schur), ctypes.byref(status))
    # the factor is destroyed, and with it the memory of MUMPS; the dense matrix stays
    _call("PetscObjectReference", schur)
    _call("MatDenseGetArray", schur, ctypes.byref(data))
    _destroy(factor, matrix)
    complement = np.ctypeslib.as_array(data, (size, size))
    weakref.finalize(complement, _release, schur, data).atexit = False
    return complement


def upper_triangle(matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Upper triangle of a matrix (n × n or wider); column indices stay in their order, negative ones are left out.

    SciPy's `triu` takes several times longer.
    """
    rows = np.repeat(np.arange(matrix.shape[0], dtype=matrix.indices.dtype), np.diff(matrix.indptr))
    kept = matrix.indices >= rows
    ends = np.concatenate([[0], np.cumsum(kept, dtype=matrix.indptr.dtype)])[matrix.indptr]
    return sp.csr_matrix((matrix.data[kept], matrix.indices[kept], ends), shape=matrix.shape)


def symmetric_matrix(upper: sp.spmatrix) -> PETSc.Mat:
    """PETSc matrix (SBAIJ, marked positive definite) from the upper triangle (n × n) of a symmetric matrix."""
    csr = upper.tocsc().tocsr()  # sorts the indices, in half the time of `sort_indices`
    arrays = (csr.indptr.astype(np.int32), csr.indices.astype(np.int32), csr.data)
    matrix = PETSc.Mat().createSBAIJ(csr.shape, 1, csr=arrays, comm=PETSc.COMM_SELF)
    # MUMPS' SYM = 1: no pivoting, and INFOG(12) counts the negative pivots
    matrix.setOption(PETSc.Mat.Option.SPD, True)
    return matrix


def fill_symmetric(matrix: Floats, tile: int = 512) -> None:
    """Copy the upper triangle of `matrix` (m × m) into its lower one, in place, by tiles."""
    for start in range(0, len(matrix), tile):
        rows = slice(start, start + tile)
        diagonal = matrix[rows, rows]
        diagonal[:] = np.triu(diagonal) + np.triu(diagonal, 1).T
        matrix[start + tile :, rows] = matrix[rows, start + tile :].T


def library() -> ctypes.CDLL:
    """The PETSc C library that petsc4py is linked to.

    Raises RuntimeError where PETSc has complex or single-precision scalars or 64-bit indices.
    """
    scalar, integer = np.dtype(PETSc.ScalarType), np.dtype(PETSc.IntType)
    if scalar != np.float64 or integer != np.int32:
        raise RuntimeError(
            f"a PETSc with float64 scalars and int32 indices is wanted, found {scalar} and {integer}: "
            "point PETSC_DIR to a real build with 32-bit indices"
        )
    return ctypes.CDLL(PETSc.__file__)


def _call(name: str, *arguments: object) -> None:
    error = getattr(library(), name)(*arguments)
    if error:
        raise RuntimeError(f"PETSc's {name} returned error code {error}; run with -on_error_attach_debugger for more")


def _handle(obj: PETSc.Object) -> ctypes.c_void_p:
    return ctypes.c_void_p(obj.handle)


def _destroy(*objects: PETSc.Object) -> None:
    """Free gigabytes at once: petsc4py delays the destruction of objects that go out of scope."""
    for obj in objects:
        obj.destroy()


def _release(schur: ctypes.c_void_p, data: ctypes._Pointer[ctypes.c_double]) -> None:
    if not PETSc.Sys.isFinalized():
        _call("MatDenseRestoreArray", schur, ctypes.byref(data))
        _call("MatDestroy", ctypes.byref(schur))


def _factorise(matrix: PETSc.Mat, schur_size: int, settings: FactorSettings) -> PETSc.Mat:
    size = matrix.getSize()[0]
    for workspace in settings.workspace:
        factor = _attempt(matrix, schur_size, settings, workspace)
        if factor.getMumpsInfog(1) not in _WORKSPACE_TOO_SMALL or workspace == settings.workspace[-1]:
            break
        _destroy(factor)
    try:
        _check(factor, size, schur_size)
    except (NotPositiveDefinite, OutOfMemory):
        _destroy(factor, matrix)
        raise
    return factor


def _attempt(matrix: PETSc.Mat, schur_size: int, settings: FactorSettings, workspace: int) -> PETSc.Mat:
    pc = PETSc.PC().create(PETSc.COMM_SELF)
    pc.setType("cholesky")
    pc.setFactorSolverType("mumps")
    pc.setOperators(matrix)
    pc.setFactorSetUpSolverType()
    factor = pc.getFactorMatrix()
    factor.setMumpsIcntl(14, workspace)
    factor.setMumpsIcntl(27, settings.block)
    if schur_size:
        factor.setMumpsIcntl(31, 1)
        first = matrix.getSize()[0] - schur_size
        last = PETSc.IS().createStride(schur_size, first, 1, comm=PETSc.COMM_SELF)
        _call("MatFactorSetSchurIS", _handle(factor), _handle(last))
        _destroy(last)
    pc.setUp()
    _destroy(pc)
    return factor


def _check(factor: PETSc.Mat, size: int, schur_size: int) -> None:
    code, detail, negative = (factor.getMumpsInfog(i) for i in (1, 2, 12))
    if code in _NOT_POSITIVE_DEFINITE or (code >= 0 and negative > 0):
        raise not_positive_definite(size - schur_size, max(negative, 1))
    if code < 0:
        raise OutOfMemory(
            f"MUMPS stopped with INFOG(1) = {code}, INFOG(2) = {detail} on {size} rows, {schur_size} of them in a "
            f"dense Schur complement of {8e-9 * schur_size**2:.1f} GB; its estimate was {factor.getMumpsInfog(16)} MB: "
            "take a coarser mesh, fewer contact nodes or a machine with more memory"
        )
