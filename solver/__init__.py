"""Evolvent's solver: frictional contact of elastic bodies, and of gear pairs, with dolfinx and PETSc."""
