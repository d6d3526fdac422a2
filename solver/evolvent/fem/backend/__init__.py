"""dolfinx, its form compiler and PETSc, with all that depends on their versions."""
