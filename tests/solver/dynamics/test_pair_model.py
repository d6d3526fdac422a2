"""A pair's oscillator on a mesh force that is given."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from evolvent.dynamics.excitation.force_surface import MeshExcitation, mirrored_law
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.oscillator.mesh_law import Jammed, linear_side
from evolvent.dynamics.oscillator.mesh_speed import speeds_to_periods
from evolvent.dynamics.oscillator.response import response
from evolvent.dynamics.oscillator.speed_sweep import sweep_speeds
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive, lacking_room
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import load_scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.checkout import ROOT

POSITIONS, STIFFNESS, LOAD = 20, 250e3, 2500.0
STATIC = LOAD / STIFFNESS
GEAR = GearParameters.from_rack(
    z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=60.0
)
PAIR = GearPair(GEAR, GEAR, 150.0)


def driven(error: Floats, backlash: float, first: int = 0) -> Drive:
    """Constant stiffness on flanks with an unloaded error (20,) [mm]. first: number of the position that is the first.
    """
    forces, error = LOAD * np.array([0.5, 1.0, 2.0]), np.roll(error, -first)
    loaded = LoadedMesh(
        2.0 * np.pi / 50.0 * (first + np.arange(POSITIONS)) / POSITIONS, forces, 1.0,
        error[:, None] + forces / STIFFNESS, np.full((POSITIONS, 3), STIFFNESS),
    )
    return drive(PAIR, MeshExcitation(error, loaded), LOAD, DriveSettings((7.4, 7.4), 0.05, backlash))


def test_relief_leaves_room_without_backlash() -> None:
    """A relief that sets in suddenly: the spline through it falls below 0, on both sides at once, straight lines do
    not: the pair runs without backlash."""
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


def test_positions_may_begin_anywhere() -> None:
    """Flanks that touch on both sides of the teeth: the largest forces at twenty speeds are the same, 1e-7, from which
    position on the pitch is sampled; the back flanks stay where they are."""
    phase = 2.0 * np.pi * np.arange(POSITIONS) / POSITIONS
    error = 0.2 * STATIC * (np.cos(phase) + 0.5 * np.sin(2.0 * phase))
    found = []
    for first in (0, 5):
        pair = driven(error, 0.3 * STATIC, first)
        swept = sweep_speeds(pair.model, speeds_to_periods(np.linspace(3000.0, 5000.0, 20), 50))
        motions = zip(swept.periods, swept.up)
        found.append([response(pair.model, float(T), run.motion.state, run.repeats or 16) for T, run in motions])
    assert max(each.back_contact_share for each in found[0]) > 0.01
    one, other = ([each.largest_force for each in runs] for runs in found)
    assert other == pytest.approx(one, rel=1e-7)


@pytest.mark.parametrize("mesh", ["force_surface", "tangent"])
def test_driving_wheel_runs_the_mesh_backwards(mesh: Literal["force_surface", "tangent"]) -> None:
    """Problem: stiffness and unloaded error that are not symmetric over the pitch, twenty speeds. Exact: the wheel
    drives, and the largest forces are those of a driving pinion whose positions follow each other in the opposite
    order, 1e-12. With the positions as they are they are up to 40 % others: the mesh that varies feeds in another
    energy."""
    phase = 2.0 * np.pi * np.arange(POSITIONS) / POSITIONS
    error = 0.2 * STATIC * (np.cos(phase) + 0.5 * np.sin(2.0 * phase) + 0.3 * np.cos(3.0 * phase))
    stiffness = STIFFNESS * (1.0 + 0.2 * np.sin(phase) + 0.1 * np.cos(2.0 * phase))
    order = -np.arange(POSITIONS) % POSITIONS

    def forces(error: Floats, stiffness: Floats, driving: Member) -> list[float]:
        torques = LOAD * np.array([0.5, 1.0, 2.0])
        loaded = LoadedMesh(
            2.0 * np.pi / 50.0 * np.arange(POSITIONS) / POSITIONS, torques, 1.0,
            error[:, None] + torques / stiffness[:, None], np.repeat(stiffness[:, None], 3, axis=1),
        )
        settings = DriveSettings((7.4, 7.4), 0.05, 10.0 * STATIC, mesh=mesh, driving=driving)
        model = drive(PAIR, MeshExcitation(error, loaded), LOAD, settings).model
        swept = sweep_speeds(model, speeds_to_periods(np.linspace(1000.0, 5000.0, 20), 50))
        runs = zip(swept.periods, swept.up)
        return [response(model, float(T), run.motion.state, run.repeats or 16).largest_force for T, run in runs]

    wheel = forces(error, stiffness, Member.WHEEL)
    assert wheel == pytest.approx(forces(error[order], stiffness[order], Member.PINION), rel=1e-12)
    assert np.abs(np.array(wheel) / forces(error, stiffness, Member.PINION) - 1.0).max() > 0.3


@pytest.mark.parametrize(("scene", "settings"), [
    ("he2022", ("pinion.tip_relief_um=20", "wheel.tip_relief_um=20")),  # kinks beside which a spline rings
    ("yang2022", ("pair.misalignment_um=30", "mesh.level=quick")),  # flanks that stand proud
])
def test_room_is_known_before_contact_is_solved(scene: str, settings: tuple[str, ...]) -> None:
    """Without backlash the flanks lack room by their unloaded errors alone: the splines of `drive` overlap by the same
    figure to the nanometre, and with so much backlash they have room as they are. With a nanometre less they overlap.
    Once, room for a micrometre less was taken for room, and `drive` failed after all contact had been solved."""
    problem = gear_problem(load_scene(ROOT / f"demos/{scene}.toml", settings))
    pair, angles = problem.pair, np.array(uniform_pitch(problem.pair.pinion.z, POSITIONS).angles)
    error = unloaded_error(RigidFlanks(pair, problem.flanks), angles, problem.torque_on)
    side = linear_side(np.ones(POSITIONS), error)
    lacking = lacking_room(problem, POSITIONS, DriveSettings((1, 1), 1, 0))
    assert lacking > 5e-5
    with pytest.raises(Jammed) as jammed:
        mirrored_law(side, pair, 0.0)
    assert lacking == pytest.approx(jammed.value.overlap, abs=1e-6)
    mirrored_law(side, pair, lacking)
    assert lacking_room(problem, POSITIONS, DriveSettings((1, 1), 1, lacking)) == 0.0
    assert lacking_room(problem, POSITIONS, DriveSettings((1, 1), 1, lacking - 2e-6)) > 0.0


def test_worn_flanks_keep_their_room() -> None:
    """Flanks with room that wear in places: the spline through their errors rings by 2 % of the static deflection and
    more, but material is only taken away: the pair runs on. Once, a block of wear ended with Jammed."""
    worn = 0.3 * STATIC * (np.arange(POSITIONS) % 7 < 2)
    pair = driven(worn, 0.0)
    with pytest.raises(Jammed) as jammed:
        mirrored_law(pair.model.law.front, PAIR, 0.0)
    assert jammed.value.overlap > 0.02 * STATIC
