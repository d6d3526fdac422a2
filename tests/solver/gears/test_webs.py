"""Gears with a web: twist of the web against its closed form, limits, reactions, ranks."""

from __future__ import annotations

import json

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.fem.material import STEEL
from evolvent.gears import condense, solve_pitches
from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import scene_from_text
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.rotation import turn
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.gear_cases import helical_scene, model_of
from tests.support.gear_reactions import reaction_imbalance
from tests.support.running.processes import RunScript
from tests.support.running.webbed_pair import WEB
from tests.support.scene_texts import HE

TEETH, FACE = 30, 12.0
FEW_CELLS = SectorResolution(profile_elements=6, face_elements=5, core_elements=1, rim_elements=2)
HE_WEB = "wheel.rim_thickness_mm=10", "wheel.hub_diameter_mm=90"


def wheel(bore: float, thickness: float, helix: float, shape: str) -> GearBody:
    """A gear on a web that reaches its bore, all teeth condensed."""
    gear = GearParameters.from_rack(
        z=TEETH, normal_module=3.0, normal_pressure_angle_deg=20.0, helix_angle_deg=helix, face_width=FACE,
        bore_diameter=bore, web=Web(thickness, 6.0),
    )
    return condensed_gear(gear, sector_mesh(gear, FEW_CELLS, shape), STEEL, range(TEETH), Member.PINION, False)


def twist(body: GearBody) -> float:
    """Rotation [rad] of the flanks under a torque of 1 N·mm, the same tangential forces on all teeth."""
    points, nodes = body.flank.points, np.arange(len(body.flank.points))
    around = np.column_stack([-points[:, 1], points[:, 0], np.zeros(len(points))])
    force = around / (points[:, :2] ** 2).sum(axis=1)[:, None] / (len(points) * TEETH)
    work = 0.0
    for tooth in range(TEETH):
        turned = force @ turn(2.0 * np.pi * tooth / TEETH, 3).T
        work += float(np.sum(body.chain.apply(body.rows(tooth, nodes), turned, body.rows(0, nodes)) * force))
    return TEETH * work


@pytest.mark.parametrize(
    ("helix", "shape"), [(0.0, "hexahedron"), (20.0, "hexahedron"), (20.0, "tetrahedron")], ids=str
)
def test_web_twists_as_a_disc_under_torque(helix: float, shape: str) -> None:
    """Problem: a torque on all teeth alike of two gears that differ in their bores, 24 and 40 mm, at which a web of a
    quarter of the face is held. Exact: between the bores a disc is in pure shear, T/(2π b_s r²) at every height, and
    twists by T/(4π G b_s) (1/r_1² − 1/r_2²); what teeth, rim and the corner at the rim do is the same in both, and
    dies out within a few thicknesses of the web, whose smallest length is five of them. Within 0.1 %, which four
    cells along the web reach."""
    thickness, radii = 0.25 * FACE, np.array([12.0, 20.0])
    found = -np.diff([twist(wheel(2.0 * radius, thickness, helix, shape)) for radius in radii])
    shear_modulus = 0.5 * STEEL.youngs_modulus / (1.0 + STEEL.poissons_ratio)
    exact = -np.diff(1.0 / radii**2) / (4.0 * np.pi * shear_modulus * thickness)
    assert found == pytest.approx(exact, rel=1e-3)


def softness(body: GearBody) -> float:
    """Displacement [mm/N] of tooth 0's flank along its mean normal, the same force on all its nodes."""
    rows, n = body.rows(0, np.arange(len(body.flank.points))), body.flank.normals.mean(axis=0)
    moved = body.chain.apply(rows, np.tile(n / len(rows), (len(rows), 1)), rows)
    return float((moved @ n).mean())


def test_gears_are_softer_the_less_there_is_of_them() -> None:
    """The narrow helical wheel: a web as wide as the face is the full ring to the last digit; less thickness, then no
    hub, is material less and by energy a softer gear."""
    scenes = {
        "plain": [], "full": [*WEB, "wheel.web_thickness_mm=8", "wheel.web_offset_mm=0"], "web": [*WEB],
        "thin": [*WEB, "wheel.web_thickness_mm=1"],
        "no hub": ["wheel.rim_thickness_mm=4", "wheel.web_thickness_mm=3", "wheel.web_offset_mm=0.5"],
    }
    soft = {name: softness(model_of(helical_scene(*keys)).bodies[Member.WHEEL]) for name, keys in scenes.items()}
    assert soft["full"] == soft["plain"]
    assert soft["plain"] < soft["web"] < soft["thin"]
    assert soft["web"] < soft["no hub"]


@pytest.mark.parametrize("shape", ["hexahedron", "tetrahedron"])
def test_one_sector_stands_for_all(shape: str) -> None:
    """Sectors without the cells beside the web fit together: the ring of one condensed sector is the whole gear meshed
    and condensed at once, 1e-8."""
    problem = gear_problem(helical_scene(*WEB, f"mesh.shape={shape}"))
    gear, mesh = problem.pair.wheel, gear_mesh(problem, Member.WHEEL)
    ring, whole = (
        condensed_gear(gear, mesh, STEEL, [-1, 0, 1], Member.WHEEL, False, whole=whole) for whole in (False, True)
    )
    assert softness(ring) == pytest.approx(softness(whole), rel=1e-8)


def test_reactions_at_the_hub_balance_the_forces() -> None:
    """Two teeth of the webbed wheel under random forces. Exact: what holds the bore of all z sectors, K u there, is the
    negative of their sum, 1e-6, and so is its moment about the axis."""
    problem = gear_problem(helical_scene(*WEB))
    gear, mesh, member = problem.pair.wheel, gear_mesh(problem, Member.WHEEL), Member.WHEEL
    body = condensed_gear(gear, mesh, STEEL, range(gear.z), member, carries_pressure=False)
    assert (reaction_imbalance(body) < 1e-6).all()


def test_spur_pairs_with_webs_are_solved_in_space() -> None:
    """He's pair is plane; its wheel with a web is not, with one as wide as the face it is again."""
    for thickness, plane in ((8.0, False), (20.0, True)):
        scene = scene_from_text(HE, [*HE_WEB, f"wheel.web_thickness_mm={thickness}"])
        assert gear_problem(scene).is_plane == plane


@pytest.mark.filterwarnings("ignore:gear pair:evolvent.gears.CoarseContactWarning")
@pytest.mark.mpi
def test_transmission_error_is_that_of_one_rank(run_script: RunScript) -> None:
    """The webbed pair, two positions without friction and at μ = 0.1: the same curves on two ranks as on one, 1e-9; the
    web adds to them."""
    frictions = [0.0, 0.1]
    done = run_script("tests/support/running/webbed_pair.py", "2", *map(str, frictions), ranks=2)
    assert done.returncode == 0, done.stderr[-3000:]
    webbed, plain = (
        np.array([each.transmission_error for each in solve_pitches(condense(gear_problem(helical_scene(*keys)),
                                                                             MPI.COMM_SELF), frictions, 2)])
        for keys in (WEB, ())
    )
    np.testing.assert_allclose(json.loads(done.stdout), webbed, rtol=1e-9)
    assert (np.abs(webbed) > np.abs(plain)).all()
