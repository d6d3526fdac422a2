"""A pair's oscillator on a mesh force that is given."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.excitation.force_surface import MeshExcitation, mirrored_law
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.oscillator.mesh_law import Jammed
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair

POSITIONS, STIFFNESS, LOAD = 20, 250e3, 2500.0
STATIC = LOAD / STIFFNESS
GEAR = GearParameters.from_rack(
    z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=60.0
)
PAIR = GearPair(GEAR, GEAR, 150.0)


def driven(error: Floats, backlash: float) -> Drive:
    """Constant stiffness on flanks with an unloaded error (20,) [mm]."""
    forces = LOAD * np.array([0.5, 1.0, 2.0])
    loaded = LoadedMesh(
        2.0 * np.pi / 50.0 * np.arange(POSITIONS) / POSITIONS, forces, error[:, None] + forces / STIFFNESS,
        np.full((POSITIONS, 3), STIFFNESS),
    )  # fmt: skip
    return drive(PAIR, MeshExcitation(error, loaded), LOAD, DriveSettings((7.4, 7.4), 0.05, backlash))


def test_relief_leaves_room_without_backlash() -> None:
    """A relief that sets in suddenly: the spline through it falls below 0, on both sides at once, but by less than a
    hundredth of the static deflection: the pair runs without backlash."""
    relief = 0.03 * STATIC * (np.arange(POSITIONS) < 4)
    law = driven(relief, 0.0).model.law
    with pytest.raises(Jammed) as jammed:
        mirrored_law(law.front, PAIR, 0.0)
    assert 0.0 < jammed.value.overlap < 0.01 * STATIC


def test_proud_flanks_jam_without_backlash() -> None:
    """Flanks that stand a tenth of the static deflection proud somewhere, on both sides: refused; with more than twice
    as much backlash they have room."""
    proud = -0.1 * STATIC * (np.arange(POSITIONS) % 10 == 0)
    with pytest.raises(Jammed, match=r"give so much more backlash"):
        driven(proud, 0.0)
    assert driven(proud, 0.25 * STATIC).model.load == LOAD
