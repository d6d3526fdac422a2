"""Geometry and meshes: involute gears and verification shapes, made with gmsh. Knows nothing of dolfinx."""
