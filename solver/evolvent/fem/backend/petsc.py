"""PETSc with options of our own: import PETSc from here, before dolfinx or anybody else starts it.

A .petscrc in the current folder or at home and the variable PETSC_OPTIONS belong to other programs; read here, they
changed tolerances and with them results. EVOLVENT_PETSC_OPTIONS (`evolvent run --petsc-options "..."`) is read
instead. A program that has started PETSc itself keeps its own options.

Each rank starts PETSc by itself, as all of its objects here live on one rank: started for all ranks it would wait for
those that have no use for it, such as the others of `mpirun -n 2 evolvent plot`.
"""

from __future__ import annotations

import os

import petsc4py
from mpi4py import MPI

OPTIONS = "EVOLVENT_PETSC_OPTIONS"
OURS = ("-skip_petscrc", "-no_signal_handler")
"""No options file; signals are for Python, which keeps what is computed."""


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
