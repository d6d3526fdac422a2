"""Friction of a line contact: closed forms of the torques, the reversal at the pitch point, the resolved contact."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.gears.gear_model import prepare_model
from evolvent.gears.line.line_friction import direction_at, sliding_direction
from evolvent.gears.line.line_gears import LineGears, LinePosition
from evolvent.gears.line.line_position import loaded_nodes
from evolvent.gears.line.line_result import LineResult
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.problem.gear_problem import MeshSettings
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member
from tests.solver.gears.line.test_line_gears import RELIEVED, helical_model
from tests.support.gear_cases import helical_scene, model_of, spur_scene

FRICTION = 0.1


@cache
def spur(friction: bool = True) -> LineGears:
    return LineGears.of(model_of(spur_scene(*RELIEVED, "mesh.level=line")), friction)


@cache
def helical(friction: bool = True) -> LineGears:
    return LineGears.of(helical_model(), friction)


@pytest.mark.parametrize("driving", Member)
@pytest.mark.parametrize("holds", Member)
@pytest.mark.parametrize("angle", [-0.012, 0.0, 0.012])
def test_one_pair_in_the_plane_by_hand(driving: Member, holds: Member, angle: float) -> None:
    """Problem: He's pair where one tooth pair bears, before, at and behind the pitch point, as either gear passes it.
    Exact, with d = −1 up to the pitch point and 1 behind it: q = T / (r_b + μ d ρ) on the gear whose torque T is given,
    ρ its roll length; the torque of the other one is q (r_b + μ d ρ) by its own; the lost power is μ q |ξ| (1 + 1/u).
    """
    gears, force = replace(spur(), driving=driving), 100.0
    pair, found = gears.pair, LineResult.of(gears.position(angle), force, FRICTION, holds)
    ξ = pair.pinion.base_radius * angle
    d = 1.0 if driving.sign * ξ > 0.0 else -1.0
    α = pair.working_pressure_angle
    rolls = pair.pinion.base_radius * np.tan(α) + ξ, pair.wheel.base_radius * np.tan(α) - ξ
    levers = [gear.base_radius + FRICTION * d * ρ for gear, ρ in zip(pair.gears, rolls)]
    q = force * pair.gears[holds].base_radius / levers[holds]
    assert found.force(0) == pytest.approx(q, rel=1e-12)
    assert sum(found.force(tooth) for tooth in found.teeth) == pytest.approx(q, rel=1e-12)
    torques = [each * gear.base_radius for each, gear in zip(found.forces, pair.gears)]
    assert torques == pytest.approx([q * lever for lever in levers], rel=1e-12)
    assert found.friction_power == pytest.approx(FRICTION * q * abs(ξ) * (1.0 + 1.0 / pair.ratio), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("angle", [-0.1, 0.0, 0.07])
@pytest.mark.parametrize("holds", Member)
@pytest.mark.parametrize("driving", Member)
def test_power_is_in_balance_at_every_position(angle: float, holds: Member, driving: Member) -> None:
    """Exact, a helical pair whose lines cross the pitch point: T_1 − T_2/u is the power of friction where the pinion
    drives, and less than 0 by it where the wheel does, 1e-12 of the input; the torque that is given is held; the loss
    is not nothing."""
    gears, force = replace(helical(), driving=driving), 1500.0
    found = LineResult.of(gears.position(angle), force, 0.2, holds)
    pinion, wheel = (each * gear.base_radius for each, gear in zip(found.forces, gears.pair.gears))
    assert abs(driving.sign * (pinion - wheel / gears.pair.ratio) - found.friction_power) < 1e-12 * pinion
    assert found.forces[holds] == pytest.approx(force, rel=1e-12)
    assert found.friction_power > 1e-3 * pinion


@pytest.mark.parametrize("gears", [spur, helical])
def test_gears_with_friction_are_as_before_without(gears) -> None:  # type: ignore[no-untyped-def]
    """Exact: at μ = 0 the same loads, approach and stiffness, bit for bit, whether gears are prepared with friction or
    not."""
    with_it, without = (LineResult.of(gears(friction).position(0.03), 100.0).equilibrium for friction in (True, False))
    assert np.array_equal(with_it.load, without.load)
    assert (with_it.approach, with_it.stiffness) == (without.approach, without.stiffness)


def test_direction_reverses_at_the_pitch_point() -> None:
    """Exact: −1 before and at the pitch point, 1 behind it. Of points of a helical line it is the mean over the part
    for which they stand, so that the sum over an even line about the pitch point vanishes."""
    plane = spur().pair
    assert direction_at(plane, np.array([-1e-3, 0.0, 1e-3]), np.ones(3), Member.PINION).tolist() == [-1.0, -1.0, 1.0]
    pair, stations = helical().pair, helical().position(0.0).stations
    d, ξ = sliding_direction(pair, stations, Member.PINION), stations.roll_distance
    extent = np.sin(pair.pinion.base_helix_angle) * np.asarray(stations.hats.sum(axis=1)).ravel()
    assert (d[ξ < -extent] == -1.0).all() and (d[ξ > extent] == 1.0).all()
    line = stations.point_tooth == 0
    assert ξ[line].min() < 0.0 < ξ[line].max()
    moved = direction_at(pair, np.array([-0.01, 0.0, 0.01]), np.full(3, 0.1), Member.PINION)
    assert moved[1] == 0.0 and -1.0 < moved[0] == -moved[2] < 0.0


def test_wheel_that_drives_reverses_friction() -> None:
    """Exact: at each point the direction is the opposite one, the pitch point of a spur pair excepted, which keeps its
    former one: towards the roots, as the contact comes from the driving gear's root either way."""
    for gears in (spur(), helical()):
        stations = gears.position(0.0).stations
        one, other = (sliding_direction(gears.pair, stations, driving) for driving in Member)
        away = stations.roll_distance != 0.0
        assert away.any() and np.array_equal(other[away], -one[away])
    assert direction_at(spur().pair, np.zeros(1), np.ones(1), Member.WHEEL).tolist() == [-1.0]


def test_driving_wheel_is_the_mirror_image_of_a_driving_pinion() -> None:
    """Problem: He's pair, both gears alike, at μ = 0.2. Exact: where the wheel drives and has the torque, the pair at
    −φ is that at φ where the pinion drives and has it, turned by half a turn about the pitch point: the same
    transmission error, power of friction and forces of tooth pairs, torques exchanged, 1e-9. At φ itself the
    transmission error differs by more than 0.5 %: so it would with friction as of a driving pinion."""
    gears, force = spur(), 2400.0 / 20.0
    pinion, wheel = (replace(gears, free=member, driving=member) for member in Member)
    assert gears.pair.ratio == 1.0
    apart = []
    for angle in 2.0 * np.pi / 50.0 * np.array([0.2, 0.45, 0.6, 0.9]):
        one = LineResult.of(pinion.position(angle), force, 0.2, Member.PINION)
        image, there = (LineResult.of(wheel.position(each), force, 0.2, Member.WHEEL) for each in (-angle, angle))
        assert image.transmission_error == pytest.approx(one.transmission_error, rel=1e-9)
        assert image.forces == pytest.approx(one.forces[::-1], rel=1e-9)
        assert image.friction_power == pytest.approx(one.friction_power, rel=1e-9) and one.friction_power > 0.0
        loads = sorted(image.force(tooth) for tooth in image.teeth)
        assert loads == pytest.approx(sorted(one.force(tooth) for tooth in one.teeth), rel=1e-9)
        apart.append(abs(there.transmission_error / one.transmission_error - 1.0))
    assert max(apart) > 5e-3


def test_helical_mirror_image_has_mirrored_heights() -> None:
    """Problem: a helical pair of equal gears but for their hands, at μ = 0.3. Exact: the wheel that drives and has the
    torque at −φ is the pinion that does at φ, turned by half a turn about the pitch point and mirrored at mid-face: the
    same transmission error, torques exchanged, the load over the face mirrored, 1e-9. At the same rotation the load
    over the face is more than 3 % off in some layer."""
    problem = gear_problem(helical_scene("wheel.teeth=20", "wheel.bore_diameter_mm=36"))
    model = prepare_model(replace(problem, mesh=MeshSettings("line")), mesh=companion_mesh).model
    pinion, wheel = (replace(LineGears.of(model, True), free=member, driving=member) for member in Member)
    layers, apart = np.linspace(-4.0, 4.0, 5), []
    for angle in (0.02, 0.13, 0.21):
        one = LineResult.of(pinion.position(angle), 1500.0, 0.3, Member.PINION)
        image, there = (LineResult.of(wheel.position(each), 1500.0, 0.3, Member.WHEEL) for each in (-angle, angle))
        assert image.transmission_error == pytest.approx(one.transmission_error, rel=1e-9)
        assert image.forces == pytest.approx(one.forces[::-1], rel=1e-9)
        assert image.layer_load(layers)[::-1] == pytest.approx(one.layer_load(layers), abs=1e-9)
        apart.append(np.abs(there.layer_load(layers) - one.layer_load(layers)).max())
    assert min(apart) > 0.03


def test_normal_displacement_by_friction_is_work_of_nodal_forces() -> None:
    """Problem: a helical pair with loads on all stations. Exact: with normal nodal forces N and those with friction
    N + μT on each condensed gear, displacements by N + μT do the work qᵀ(B + μC)q on N, 1e-6; and T acts by more than
    1e-3 of it."""
    model, gears = helical_model(), helical()
    position = gears.position(0.05)
    assert position.friction is not None
    load, μ = 50.0 + 10.0 * np.sin(position.stations.z), 0.3
    found = replace(
        LineResult.of(position, 1500.0), position=position,
        equilibrium=replace(LineResult.of(position, 1500.0).equilibrium, load=load),
    )
    work = 0.0
    for member in Member:
        normal, both = (loaded_nodes(gears, member, replace(found, friction=each)) for each in (0.0, μ))
        moved = model.bodies[member].chain.apply(both.rows, both.forces, normal.rows)
        work += float(np.sum(moved * normal.forces))
    B, C = position.system.B, position.friction.compliance
    assert float(load @ (B + μ * C) @ load) == pytest.approx(work, rel=1e-6)
    assert abs(μ * load @ C @ load) > 1e-3 * work


@pytest.mark.parametrize("driving", Member)
def test_friction_is_as_resolved(driving: Member) -> None:
    """Problem: He's pair with a parabolic relief of 20 µm, μ = 0.1, in plane strain, 8 positions, either gear driving
    and with the torque. Reference: the periodic pitch resolved at level fine. Transmission error within 0.3 % of the
    deflection, tooth forces within 0.5 % of the load, loss within 1 %. Without the normal displacement by tangential
    loads the transmission error is 3.6 to 4 % off at the worst position, and the force of a tooth pair 2 % of the
    load."""
    scene = spur_scene(*RELIEVED, "mesh.level=fine")
    fine, model = model_of(scene), model_of(spur_scene(*RELIEVED, "mesh.level=line"))
    fine = replace(fine, load=replace(fine.load, on=driving, driving=driving))
    pitch = uniform_pitch(scene.pinion.teeth, 8, 1, driving)
    (resolved,) = certified_pitch(fine, pitch, [FRICTION], MPI.COMM_SELF).by_friction
    gears, force = replace(spur(), free=driving, driving=driving), model.load.torque / model.base_radius
    angles = [result.stand.angle for result in resolved]
    lines = [LineResult.of(gears.position(angle), force, FRICTION, driving) for angle in angles]
    errors = [result.transmission_error for result in resolved]
    assert [line.transmission_error for line in lines] == pytest.approx(errors, rel=3e-3)
    for result, line in zip(resolved, lines):
        whole = sum(result.contact.normal_force(tooth) for tooth in line.teeth)
        for tooth in line.teeth:
            assert line.force(tooth) == pytest.approx(result.contact.normal_force(tooth), abs=5e-3 * whole)
    loss = sum(result.friction_loss for result in resolved)
    assert sum(line.friction_power for line in lines) == pytest.approx(loss, rel=1e-2)
    stiff = [LineResult.of(_without_displacement(gears, angle), force, FRICTION, driving) for angle in angles]
    assert 0.036 < max(abs(line.transmission_error / error - 1.0) for line, error in zip(stiff, errors)) < 0.04
    teeth = [0 if driving is Member.PINION or angle == 0.0 else -1 for angle in angles]  # of the mirror image
    apart = [abs(one.force(tooth) - other.force(tooth)) / force for one, other, tooth in zip(stiff, lines, teeth)]
    assert max(apart) == pytest.approx(0.02, abs=2e-3)


def _without_displacement(gears: LineGears, angle: float) -> LinePosition:
    """Position at which tangential loads do not move the flanks along their normals."""
    position = gears.position(angle)
    assert position.friction is not None
    return replace(position, friction=replace(position.friction, compliance=0.0 * position.friction.compliance))
