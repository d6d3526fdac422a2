"""The root of a tooth: the fillets of both sides of its sector, on which stress is looked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.fem.surface import Surface, surface_of
from evolvent.gears.meshing.root_meshes import BACK_ROOT, LOADED_ROOT
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.mesh.mesh_data import MeshData

ROUNDING = 1e-9
"""Relative tolerance of a radius: a node at the root form circle lies within it."""
LEAST_TANGENT = np.radians(20.0)
"""Least angle of the profile's tangent to the tooth's centre line at which bending stress is evaluated. At the
standard's critical section it is 30°, at the largest stress of finite elements 35 to 50°. A tip edge that presses above
the root form circle pulls at the profile below: on Yang's pinion, without relief, by 1100 MPa at the circle, where the
tangent is at 5°, by 410 at 19°. Bending has its largest tension, 795 MPa, later and at 38°."""


@dataclass(frozen=True, eq=False)
class RootSurface:
    """Root of one side of tooth 0 in the gear's frame, from the start of the flank's mesh to the middle of the
    space."""

    gear: GearParameters
    """Gear of the root."""
    surface: Surface
    """Surface with n nodes, numbered as in the sector's mesh by `nodes`."""

    @property
    def heights(self) -> Floats:
        """Axial positions (n,) [mm]; 0 in plane strain."""
        x = self.surface.points
        return np.asarray(x[:, 2]) if x.shape[1] == 3 else np.zeros(len(x))

    @property
    def radii(self) -> Floats:
        """Radii (n,) of the nodes [mm]."""
        return np.hypot(self.surface.points[:, 0], self.surface.points[:, 1])

    @property
    def is_fillet(self) -> Bools:
        """Whether stress at a node is the root's (n,): the tangent has `LEAST_TANGENT`, and all facets of the node lie
        within the root form circle. Beyond it the involute begins, which the other gear's tip may touch: stress there
        and close below is that of a contact, and facets under pressure are not free."""
        beyond = 2.0 * self.radii > self.gear.root_form_diameter * (1.0 + ROUNDING)
        facets = self.surface.facets
        below = np.ones(len(beyond), dtype=bool)
        below[facets[beyond[facets].any(axis=1)]] = False
        return below & (self.tangent_angles >= LEAST_TANGENT)

    @property
    def tangent_angles(self) -> Floats:
        """Angles (n,) [rad] between the profile's tangent and the tooth's centre line in the node's transverse section:
        about the pressure angle at the flank, 30° at the standard's critical section, 90° at the root circle."""
        turn = self.gear.twist * self.heights
        n = self.surface.normals
        along = np.cos(turn) * n[:, 0] + np.sin(turn) * n[:, 1]
        across = np.cos(turn) * n[:, 1] - np.sin(turn) * n[:, 0]
        return np.arctan2(np.abs(along), np.abs(across))


def tension_side(mesh: MeshData, gear: GearParameters) -> RootSurface:
    """The root below the loaded flank, which bending pulls. mesh: of `root_meshes`."""
    return RootSurface(gear, surface_of(mesh, LOADED_ROOT))


def compression_side(mesh: MeshData, gear: GearParameters) -> RootSurface:
    """The root of the back, up to the same radius, which bending presses. mesh: of `root_meshes`."""
    return RootSurface(gear, surface_of(mesh, BACK_ROOT))
