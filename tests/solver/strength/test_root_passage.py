"""Root stress of Zhang's pair in plane strain, against the paper, statics, and finer fillets."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.fem.material import Material
from evolvent.gears.gear_model import Mesher, prepare_model
from evolvent.gears.meshing.root_meshes import RootMesh, adapted_root_mesh
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent.scene.gear_problem import gear_problem
from evolvent.strength.root_passage import GearRoots, RootPeak, root_passages
from evolvent.strength.standard.root_stress import RootLoad
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import spur_scene, swept
from tests.support.paper_pairs import zhang

STEEL = Material(212e3, 0.289)
TORQUE, POSITIONS = 500e3, 12


def fillets(factor: int) -> Mesher:
    """So many times the elements of a run in the root."""
    return partial(
        adapted_root_mesh,
        adapted=lambda root: replace(
            root, fillet_elements=factor * root.fillet_elements, back_elements=factor * root.back_elements,
            neck_elements=factor * root.neck_elements,
        ),
    )


@cache
def roots(fine: bool = False) -> tuple[GearRoots, GearRoots]:
    """Of both gears at 500 N·m, μ = 0.05, over 25 mm of both faces."""
    pair = zhang()
    pair = replace(pair, pinion=replace(pair.pinion, face_width=pair.wheel.face_width))
    problem = GearProblem(pair, torque=TORQUE, materials=(STEEL, STEEL), mesh=MeshSettings("quick"))
    model = prepare_model(problem, MPI.COMM_SELF, fillets(4 if fine else 1)).model
    (curves,) = swept(model, np.degrees(2.0 * np.pi / pair.pinion.z * np.arange(POSITIONS) / POSITIONS), [0.05])
    pinion, wheel = (root_passages(body, curves.results) for body in model.bodies)
    return pinion, wheel


@pytest.mark.parametrize(("member", "paper"), [(Member.PINION, 490.6), (Member.WHEEL, 487.01)])
def test_largest_tension_beside_the_paper(member: Member, paper: float) -> None:
    """Within 10 % of the paper's finite elements, and below: its tool tip radius is not known."""
    tension = roots(fine=True)[member].loaded_side.tension
    assert 0.9 * paper < tension.stress < paper
    assert np.radians(30.0) < tension.tangent_angle < np.radians(60.0)


@pytest.mark.parametrize("member", Member)
def test_fillets_of_the_usual_mesh(member: Member) -> None:
    """Six elements around the fillet: tension and compression within 4 % of four times as many."""
    usual, fine = roots()[member], roots(fine=True)[member]
    assert usual.loaded_side.tension.stress == pytest.approx(fine.loaded_side.tension.stress, rel=0.04)
    assert usual.back_side.compression.stress == pytest.approx(fine.back_side.compression.stress, rel=0.04)


@pytest.mark.parametrize("member", Member)
def test_back_is_pressed_while_the_loaded_side_is_pulled(member: Member) -> None:
    """At the rotation of the largest tension the back's smallest principal stress is as large, a fifth more or less,
    and below zero. Where the tooth bears no load, its neighbours, which share the middle of the space, leave less than
    a fifth of that where the profile is steeper than 45°."""
    own = roots()[member]
    loaded, back = own.loaded_side, own.back_side
    k = int(np.argmin(np.abs(loaded.angles - loaded.tension.angle)))
    assert -back.principal[k, :, 0].min() == pytest.approx(loaded.tension.stress, rel=0.2)
    for passage in (loaded, back):
        for end in (0, -1):
            own_part = passage.root.tangent_angles < np.radians(45.0)
            assert np.abs(passage.principal[end, own_part]).max() < 0.2 * loaded.tension.stress


@pytest.mark.parametrize("member", Member)
def test_mean_and_amplitude_are_of_one_direction(member: Member) -> None:
    """Their sum is the largest tension; neighbours under load press the root a little before it is loaded, so that the
    amplitude is more than half of the largest."""
    tension = roots()[member].loaded_side.tension
    assert tension.mean + tension.amplitude == pytest.approx(tension.stress, rel=1e-9)
    assert 0.5 < tension.amplitude / tension.stress < 0.6


@cache
def at_outer_point(member: Member, relief: float = 0.0) -> RootPeak:
    """Of He's pair, loaded at the outer point of single contact of a gear, tips relieved by so much [µm]."""
    problem = gear_problem(spur_scene("mesh.level=quick", *(f"{each.label}.tip_relief_um={relief}" for each in Member)))
    model = prepare_model(problem, MPI.COMM_SELF, RootMesh()).model
    load = RootLoad(problem.pair, member, problem.pinion_torque)
    angle, pitch = load.tooth_rotation(load.outer_point.below_tip), 2.0 * np.pi / problem.pair.pinion.z
    (curves,) = swept(model, np.degrees([angle % pitch]), [0.0])
    loaded = root_passages(model.bodies[member], curves.results).loaded_side
    return loaded.tension_at(int(np.argmin(np.abs(loaded.angles - angle))))


@pytest.mark.parametrize("member", Member)
def test_stress_with_the_whole_load_on_the_tooth(member: Member) -> None:
    """Problem: at the outer point of single contact of He's pair the next pair already bears: the tooth has 61 % of
    the load, and the stress is 36 % below that with all of it. Exact: the stress of the same pair with tips relieved by
    30 µm, which keeps the next pair off, so that the tooth bears all: 0.1 %. The stress over the share alone is 5 %
    above it, for the neighbour's force pulls this root, too."""
    alone, shared = at_outer_point(member, 30.0), at_outer_point(member)
    assert alone.load_share == 1.0 and alone.whole_load == pytest.approx(alone.stress, rel=1e-9)
    assert shared.load_share == pytest.approx(0.61, abs=0.01)
    assert shared.whole_load == pytest.approx(alone.stress, rel=1e-3)
    assert 1.04 < shared.stress / shared.load_share / alone.stress < 1.07


@pytest.mark.parametrize("member", Member)
def test_shares_of_all_teeth_add_up(member: Member) -> None:
    """Of one position all teeth together have the whole load; a tooth without load has no stress of its own."""
    own, pitch = roots()[member].loaded_side, 2.0 * np.pi / zhang().pinion.z
    phase = np.round(own.angles % pitch / pitch * POSITIONS).astype(int) % POSITIONS
    assert np.bincount(phase, own.load_share) == pytest.approx(np.ones(POSITIONS), rel=1e-9)
    assert np.array_equal(np.isnan(own.whole_load), own.load_share == 0.0)


def test_free_surface_bears_no_traction() -> None:
    """σ n = 0 at every node and rotation, 1e-9 of the largest stress."""
    passage = roots()[Member.PINION].loaded_side
    normals = np.pad(passage.root.surface.normals, ((0, 0), (0, 1)))
    traction = np.einsum("knab,nb->kna", passage.stress, normals)
    assert np.abs(traction).max() < 1e-9 * np.abs(passage.stress).max()


@pytest.mark.parametrize("member", Member)
def test_stress_of_a_contact_is_not_that_of_the_root(member: Member) -> None:
    """The tip of the other gear presses on the start of the flank: 10 GPa at the nodes beyond the root form circle, of
    which each root has some, change neither tension nor compression."""
    own = roots()[member].loaded_side
    beyond = 2.0 * own.root.radii > own.root.gear.root_form_diameter + 1e-6
    assert beyond.any() and not beyond.all()
    pressed = replace(own, stress=own.stress + 1e4 * beyond[:, None, None] * np.diag([1.0, -1.0, 0.0]))
    assert repr((pressed.tension, pressed.compression)) == repr((own.tension, own.compression))  # with NaN in them
    assert np.array_equal(pressed.largest, own.largest) and np.array_equal(pressed.smallest, own.smallest)
    assert repr(pressed.tension_at(3)) == repr(own.tension_at(3))
