"""Meshes as arrays with named groups; structured grids, mesh quality, gmsh and VTK files."""
