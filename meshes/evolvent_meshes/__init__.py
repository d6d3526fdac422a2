"""Geometry and meshes of involute gears and verification shapes; independent of dolfinx."""
