"""Static shapes of gear bodies, against natural modes of the whole ring and against what they are in statics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.dynamics.modes.mean_load import mean_load
from evolvent.dynamics.modes.static_shapes import static_shapes, with_elastic_bodies
from evolvent.dynamics.of_scene import drive_settings
from evolvent.dynamics.one_degree import one_degree
from evolvent.dynamics.small_system import pair_system
from evolvent.dynamics.transient.driven_pair import driven_pair, resolved_modes
from evolvent.dynamics.transient.own_frequency import own_frequency
from evolvent.fem.surface import surface_of
from evolvent.gears.kinematics import spin
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_inertia import polar_moment
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of, spur_scene

DENSITY, MODES = 7.85e-9, 3


def bored(bore: float) -> tuple[str, ...]:
    return "mesh.level=quick", "mesh.order=1", f"pinion.bore_diameter_mm={bore}", f"wheel.bore_diameter_mm={bore}"


@pytest.mark.parametrize(
    ("bore", "rigid", "within"),
    [
        (16.0, 0.464, 5e-3), (36.0, 0.19, 3e-3), pytest.param(70.0, 0.055, 3e-3, marks=pytest.mark.slow),
        pytest.param(100.0, 0.020, 3e-3, marks=pytest.mark.slow),
    ],
)
def test_natural_frequency_with_static_shapes(bore: float, rigid: float, within: float) -> None:
    """Problem: `evolvent dynamics` took gear bodies as rigid, so that the natural frequency of He's pair was 2 to 20 %
    too low. Right is that with natural modes of both whole rings, three of each harmonic, at the stiffness of the same
    positions: with static shapes it is within 0.3 %, with rigid bodies too low by what is said here. With a bore of a
    tenth of the diameter, within 0.5 %; once the hubs' own motion was taken for it, twenty times as fast."""
    scene = spur_scene(*bored(bore))
    problem, model = gear_problem(scene), model_of(scene)
    solved = sweep_pitch(model, uniform_pitch(50, 6), [0.0], initial_state([0.0]))
    static = [position.results[0] for position in solved]
    heavier = tuple((1.0 + 1e-3) * polar_moment(gear, DENSITY) for gear in problem.pair.gears)
    settings = replace(drive_settings(problem.pair, DynamicsSection()), inertias=(heavier[0], heavier[1]))
    modes = resolved_modes(problem, model, DENSITY, 0.0, MODES)
    exact = own_frequency(driven_pair(model, modes, settings, static, 0.01, constant_speed=False), static)
    gears = with_elastic_bodies(settings, problem, DENSITY).bodies
    assert gears is not None
    system = pair_system(*(gear.with_inertia(moment) for gear, moment in zip(gears, heavier)))
    stiffness = model.width_factor * float(np.mean([position.stiffness for position in static]))
    body = one_degree(system, stiffness)
    found = np.sqrt(1.0 / (1.0 / stiffness - body.stiffer) / body.mass) / (2.0 * np.pi)
    assert found == pytest.approx(exact, rel=within)
    assert np.sqrt(stiffness / system.rigid_mass) / (2.0 * np.pi) == pytest.approx((1.0 - rigid) * exact, rel=5e-3)


@pytest.mark.parametrize("kind", ["spur", pytest.param("helical", marks=pytest.mark.slow)])
@pytest.mark.parametrize("member", Member)
def test_shapes_are_static_answers(kind: str, member: Member) -> None:
    """u_1 = K⁻¹f, u_2 = K⁻¹Mr and u_3 = K⁻¹Mu_1: their work under f, Mr and Mu_1 is their stiffness, to 1e-8 of it;
    the moment of inertia is that of the section, and one shape of all inertia has at most all of it."""
    problem = gear_problem(spur_scene(*bored(70.0)) if kind == "spur" else helical_scene())
    gear = static_shapes(problem, member, DENSITY)
    K, M, g = gear.stiffness, gear.mass, gear.closing
    assert g[0] == pytest.approx(problem.pair.gears[member].base_radius)
    assert K[1, 1:] == pytest.approx(-g[1:], rel=1e-8)
    assert K[2, 1:] == pytest.approx(M[0, 1:], rel=1e-8)
    assert K[3, 1:] == pytest.approx(M[1, 1:], rel=1e-8)
    width = problem.pair.gears[member].face_width if problem.is_plane else 1.0
    assert width * M[0, 0] == pytest.approx(polar_moment(problem.pair.gears[member], DENSITY), rel=2e-2)
    assert np.linalg.eigvalsh(M).min() > 0.0 and np.linalg.eigvalsh(K[1:, 1:]).min() > 0.0


@pytest.mark.parametrize("member", Member)
def test_mean_load_is_a_unit_mesh_force(member: Member) -> None:
    """Forces on the teeth of a helical pair: their moment about the axis is the base radius, to 1e-9, and their axial
    force that of the base helix angle, tan β_b, within 2 % of a flank of flat first-order facets; on three teeth at
    least."""
    problem = gear_problem(helical_scene())
    flank = surface_of(gear_mesh(problem, member), "flank")
    loads = mean_load(problem.pair, member, flank)
    gear, arm = problem.pair.gears[member], spin(flank.points, np.zeros(3))
    assert abs(sum(np.sum(forces * arm) for forces in loads.values())) == pytest.approx(gear.base_radius, rel=1e-9)
    axial = sum(float(forces[:, 2].sum()) for forces in loads.values())
    assert abs(axial) == pytest.approx(np.tan(gear.base_helix_angle), rel=2e-2)
    assert len(loads) >= 3


def test_less_inertia_than_the_body_is_refused() -> None:
    """Half the inertia of the wheel's body, all of which moves: refused with the key, and what to do."""
    problem = gear_problem(spur_scene(*bored(70.0)))
    full, half = (factor * polar_moment(problem.pair.pinion, DENSITY) for factor in (1.01, 0.5))
    settings = replace(drive_settings(problem.pair, DynamicsSection()), inertias=(full, half))
    with pytest.raises(InputError, match=r"wheel_inertia_kg_m2.*rigid") as refused:
        with_elastic_bodies(settings, problem, DENSITY)
    assert "delete the key" in str(refused.value)
