"""dolfinx, its form compiler and PETSc: start-up, options, versions, compiled forms."""
