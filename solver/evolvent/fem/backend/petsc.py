"""PETSc, started with Evolvent's options: import PETSc from here, before dolfinx starts it.

A .petscrc in the current folder or the home directory and the variable PETSC_OPTIONS belong to other programs; here
they would change tolerances and with them results. EVOLVENT_PETSC_OPTIONS (`evolvent run --petsc-options "..."`) is
read instead. A program that has started PETSc before keeps its options.

Each rank starts PETSc on its own (MPI.COMM_SELF), as all PETSc objects here belong to one rank. A collective start
would wait for ranks that do not use PETSc, such as the others of `mpirun -n 2 evolvent plot`.
"""

from __future__ import annotations

import os

import petsc4py
from mpi4py import MPI

OPTIONS = "EVOLVENT_PETSC_OPTIONS"
OURS = ("-skip_petscrc", "-no_signal_handler")
"""No options file; signals are handled by Python, which saves the results so far."""


def _start() -> None:
    foreign = os.environ.pop("PETSC_OPTIONS", None)
    try:
        petsc4py.init(["evolvent", *OURS, *os.environ.get(OPTIONS, "").split()], comm=MPI.COMM_SELF)
    finally:
        if foreign is not None:
            os.environ["PETSC_OPTIONS"] = foreign


_start()

from petsc4py import PETSc  # noqa: E402

__all__ = ["OPTIONS", "PETSc"]
