"""Cells, named groups, structured grids, mesh quality, gmsh and VTK files."""
