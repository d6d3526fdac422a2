"""The part of the bore at which a gear is held."""

from __future__ import annotations

from dataclasses import replace

from evolvent_meshes.arrays import Ints
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.mesh.mesh_data import MeshData


def with_held_bore(gear: GearParameters, mesh: MeshData) -> MeshData:
    """The mesh with its facet group bore divided, where the support is partial: bore is held, bore_free is not."""
    if not gear.support.is_partial(gear.face_width) or mesh.dimension == 2:
        return mesh
    bore = mesh.facets["bore"]
    low, high = gear.support.ends(gear.face_width)
    middle = mesh.points[bore, 2].mean(axis=1)
    held = (middle > low) & (middle < high)
    groups: dict[str, Ints] = {"bore": bore[held], "bore_free": bore[~held]}
    return replace(mesh, facets=mesh.facets | groups)
