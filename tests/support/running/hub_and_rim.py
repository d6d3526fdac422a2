"""A pair of gears that each are a hub and a rim with a spring between them, on a linear mesh with a harmonic error."""

from __future__ import annotations

import numpy as np

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.dynamics.small_system import GearShapes
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair

GEAR = GearParameters.from_rack(
    z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=60.0
)
PAIR, HUB, RIM = GearPair(GEAR, GEAR, 150.0), 3.0, 4.4
RADIUS, POSITIONS, LOAD, ERROR = GEAR.base_radius, 40, 2500.0, 1e-4
LOCAL, SPRING = 1e6, 5e10
"""Stiffness of the mesh without its bodies [N/mm], and between hub and rim of each gear [N·mm/rad]: the bodies swing
4.6 times as fast as the pair on its mesh."""
STATIC = 1.0 / (1.0 / LOCAL + 2.0 * RADIUS**2 / SPRING)
"""Of the mesh between the bores [N/mm]."""


def excitation() -> MeshExcitation:
    """A linear mesh and a harmonic unloaded error."""
    phases, forces = np.arange(POSITIONS) / POSITIONS, LOAD * np.array([0.5, 1.0, 2.0])
    error = ERROR * np.cos(2.0 * np.pi * phases)
    stiffness = np.full((POSITIONS, 3), STATIC)
    return MeshExcitation(
        error, LoadedMesh(2.0 * np.pi / 50.0 * phases, forces, 1.0, error[:, None] + forces / STATIC, stiffness)
    )


def settings(spring: float = SPRING) -> DriveSettings:
    """spring: between hub and rim [N·mm/rad]."""
    gear = GearShapes(
        np.array([[HUB + RIM, RIM], [RIM, RIM]]), np.diag([0.0, spring]), np.array([RADIUS, RADIUS])
    )
    return DriveSettings((HUB + RIM, HUB + RIM), 0.03, 0.2, bodies=(gear, gear))
