"""Forces and tilting moments on the shafts.

Problem: a helical pair, right-hand pinion, and He's spur pair in 2D. Exact without friction, at the pitch point: F_t =
T/r_w, F_r = F_t tan α_wt, F_a = F_t tan β_w, the axial force tilting the gear by F_a r_w; the gears press on each other
with equal and opposite forces whatever the friction.
"""

from __future__ import annotations

from dataclasses import astuple

import numpy as np
import pytest

from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.results.archive.gear_shapes import gear_shape
from evolvent.results.run_data import RunData, run_data
from evolvent.results.shaft_forces import ShaftForces, shaft_forces
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of, spur_scene

FRICTION = 0.1


def solved(scene: Scene) -> RunData:
    model, frictions = model_of(scene), scene.contact.friction
    pitch = uniform_pitch(scene.pinion.teeth, scene.sweep.positions)
    shapes = [gear_shape(MeshedGear.of(body)) for body in model.bodies]
    return run_data(scene, (shapes[0], shapes[1]), list(sweep_pitch(model, pitch, frictions, initial_state(frictions))))


@pytest.fixture(scope="module")
def helical() -> RunData:
    return solved(helical_scene(f"contact.friction=[0.0, {FRICTION}]", "sweep.positions=2", "load.torque_Nm=20"))


@pytest.fixture(scope="module")
def spur() -> RunData:
    return solved(spur_scene(f"contact.friction=[0.0, {FRICTION}]", "mesh.level=quick", "sweep.positions=4"))


@pytest.fixture(params=["helical", "spur"])
def run(request: pytest.FixtureRequest) -> RunData:
    found: RunData = request.getfixturevalue(request.param)
    return found


def textbook(run: RunData, gear: Member) -> tuple[float, float, float, float]:
    """Tangential, radial, axial force [N] and tilting moment [N·m] for the torque that was found."""
    pair, radius = run.pair, run.pair.working_pitch_diameters[gear] / 2.0
    torque = run.width * np.mean([each[0].result.torques[gear] for each in run.positions])
    tangential = float(torque) / radius
    tilt = radius / pair.gears[gear].base_radius * np.tan(pair.pinion.base_helix_angle)  # tan β_w
    axial = tangential * float(tilt)
    return tangential, tangential * float(np.tan(pair.working_pressure_angle)), axial, 1e-3 * axial * radius


@pytest.mark.parametrize("gear", Member)
def test_shaft_forces_without_friction_are_those_of_the_standard(gear: Member, run: RunData) -> None:
    """Within 0.2 %, all signs included: a right-hand pinion is pushed along +z, which tilts it about −y."""
    found, (tangential, radial, axial, moment) = shaft_forces(run, gear, 0), textbook(run, gear)
    sign = 1.0 if gear == 0 else -1.0
    assert found.tangential_N == pytest.approx(tangential, rel=2e-3)
    assert found.radial_N == pytest.approx(radial, rel=2e-3)
    assert found.axial_N == pytest.approx(sign * axial, rel=2e-3, abs=1e-9)
    assert found.moment_y_Nm == pytest.approx(-moment, rel=2e-3, abs=1e-9)
    assert abs(found.moment_x_Nm) <= 0.05 * moment  # the load lies at mid-face
    assert found.tangential_peak_to_peak_N < 2e-3 * tangential


@pytest.mark.parametrize("index", [0, 1])
def test_shaft_forces_on_both_gears_are_opposite(index: int, run: RunData) -> None:
    """Positive apart and with T_2, against T_1: the same figures on both gears; the axial ones opposite."""
    pinion, wheel = (shaft_forces(run, gear, index) for gear in Member)
    swings = [(each.tangential_peak_to_peak_N, each.radial_peak_to_peak_N) for each in (pinion, wheel)]
    forces = [(each.tangential_N, each.radial_N) for each in (pinion, wheel)]
    assert forces[0] == pytest.approx(forces[1], rel=1e-4, abs=1e-3 * pinion.tangential_N)
    assert swings[0] == pytest.approx(swings[1], rel=1e-4, abs=1e-3 * pinion.tangential_N)
    assert pinion.axial_N == pytest.approx(-wheel.axial_N, rel=1e-4, abs=1e-9)


def test_friction_makes_the_radial_force_alternate(spur: RunData) -> None:
    """Friction turns about at the pitch point, and with it the direction of the force: the radial force swings by about
    2 μ F, the tangential one by no more than it does by 2 μ F tan α_wt."""
    smooth, rough = shaft_forces(spur, Member.PINION, 0), shaft_forces(spur, Member.PINION, 1)
    swing = 2.0 * FRICTION * smooth.tangential_N / np.cos(spur.pair.working_pressure_angle)
    assert 0.3 * swing < rough.radial_peak_to_peak_N < swing
    assert rough.tangential_peak_to_peak_N < swing * np.tan(spur.pair.working_pressure_angle)
    assert smooth.radial_peak_to_peak_N < 0.01 * swing


def test_load_at_a_face_end_tilts_the_shafts() -> None:
    """Under misalignment that opens the flanks at z > 0 the load lies at z < 0: the tangential force, along −y on the
    pinion, tilts it about −x by up to half the face width, the axial one a little more, and the wheel the other way."""
    scene = helical_scene("contact.friction=0.0", "pair.misalignment_um=60", "sweep.positions=2", "load.torque_Nm=20")
    run = solved(scene)
    pinion, wheel = (shaft_forces(run, gear, 0) for gear in Member)
    arm = -1e3 * pinion.moment_x_Nm / pinion.tangential_N
    farthest = max(np.abs(run.pair.path_of_contact)) * np.cos(run.pair.working_pressure_angle)
    assert 0.5 < arm < run.pair.face_width / 2.0 + farthest * pinion.axial_N / pinion.tangential_N
    assert wheel.moment_x_Nm == pytest.approx(-pinion.moment_x_Nm, rel=0.05)


def test_shaft_forces_are_finite(run: RunData) -> None:
    """For every gear and friction coefficient."""
    for gear in Member:
        for index in (0, 1):
            found: ShaftForces = shaft_forces(run, gear, index)
            assert np.isfinite(astuple(found)).all()
