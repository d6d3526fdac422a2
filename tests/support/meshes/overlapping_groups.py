"""A gmsh file of a rectangle whose entities are in several physical groups."""

from __future__ import annotations

from pathlib import Path

import gmsh

from evolvent_meshes.mesh.gmsh_io import gmsh_model

WIDTH, HEIGHT = 10.0, 5.0
"""Of the rectangle [mm]."""


def write_overlapping(path: Path, version: float, order: int = 1) -> None:
    """The surface in groups `body` and `steel`, its sides in `boundary`, the lower one in `held` and the upper one in
    `top` as well. version: of the MSH format."""
    with gmsh_model("overlapping"):
        surface = gmsh.model.occ.addRectangle(0, 0, 0, WIDTH, HEIGHT)
        gmsh.model.occ.synchronize()
        sides = [tag for _, tag in gmsh.model.getBoundary([(2, surface)], oriented=False)]
        middles = {tag: gmsh.model.occ.getCenterOfMass(1, tag)[1] for tag in sides}
        named = {
            "held": [tag for tag in sides if middles[tag] < 0.1],
            "top": [tag for tag in sides if middles[tag] > HEIGHT - 0.1],
            "boundary": sides,
        }
        for name in ("body", "steel"):
            gmsh.model.addPhysicalGroup(2, [surface], name=name)
        for name, tags in named.items():
            gmsh.model.addPhysicalGroup(1, tags, name=name)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 1.0)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        before = gmsh.option.getNumber("Mesh.MshFileVersion")
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        try:
            gmsh.write(str(path))
        finally:
            gmsh.option.setNumber("Mesh.MshFileVersion", before)
