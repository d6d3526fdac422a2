"""Wear of nearly rigid bodies of the public API, against the worn shape of the removed volume."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from evolvent import Body, Contact, Fixed, Freedom, Material, Problem, Rigid
from evolvent.wear import (
    Archard,
    Block,
    BlockSettings,
    Cycle,
    CycleState,
    MeshMotion,
    Travel,
    WearStopped,
    WearStudy,
)
from evolvent.wear.mesh_motion import mesh_volume
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.shapes.blocks import rectangle
from tests.support.wear_cases import (
    CYLINDER_DEPTH,
    CYLINDER_WIDTH,
    LINE_LOAD,
    POINT_LOAD,
    SLIDING,
    SPHERE_DEPTH,
    K,
    cylinder,
    sphere,
    to_and_fro,
)

MILLIMETRE = Cycle(travel=(Travel(1, translation=(1.0, 0.0, 0.0)),))


@pytest.mark.parametrize("follows", [False, True])
def test_rigid_cylinder_wears_flat(follows: bool) -> None:
    """Problem: a nearly rigid cylinder, worn in the gap only, or with a mesh that follows each 1e-3 mm. Exact: a =
    (3RkF's/2)^⅓ = 0.19574 mm, h = a²/2R = 3.832e-3 mm, within 1 %; the volume kF's at the nodes within 1e-6; the mesh
    loses it within 0.1 %."""
    assert pytest.approx(0.19574, abs=5e-6) == CYLINDER_WIDTH
    assert pytest.approx(3.832e-3, abs=5e-7) == CYLINDER_DEPTH
    mesh_motion = MeshMotion(depth=1e-3) if follows else None
    study, volume = WearStudy(cylinder(), (Archard(K),), MILLIMETRE, mesh_motion), 0.0
    for block in study.blocks(SLIDING, BlockSettings(first=100.0)):
        volume += block.length * block.end.volumes[0, "arc"]
    depth = study.by_side(block.state.depth)[0, "arc"]
    assert study.mesh_updates == (3 if follows else 0)
    assert depth.max() == pytest.approx(CYLINDER_DEPTH, rel=0.01)
    assert volume == pytest.approx(K * LINE_LOAD * SLIDING, rel=1e-6)
    before, after = (mesh_volume(mesh) for mesh in (cylinder().bodies[0].mesh, study.meshes(block.state.depth)[0]))
    assert before - after == pytest.approx(volume, rel=1e-3)


def test_rigid_sphere_wears_flat() -> None:
    """Problem: a nearly rigid sphere. Exact: πh²(R − h/3) = kFs, h = 7.979e-3 mm, within 1 %."""
    study = WearStudy(sphere(), (Archard(K),), MILLIMETRE)
    *_, block = study.blocks(SLIDING, BlockSettings(first=500.0, tolerance=0.1))
    assert pytest.approx(7.979e-3, rel=5e-4) == SPHERE_DEPTH  # which leaves the h/3 out
    assert block.state.depth.max() == pytest.approx(SPHERE_DEPTH, rel=0.01)


@pytest.mark.parametrize("laws", [Archard(K), Archard(0.0, K), Archard(K, 3.0 * K)])
@pytest.mark.parametrize(("order", "friction"), [(1, 0.0), (1, 0.3), (2, 0.0), (2, 0.3)])
def test_volumes_of_one_or_both_worn_sides(laws: Archard, order: int, friction: float) -> None:
    """Problem: one or both bodies wear as the slab moves to and fro by 0.0005 mm. Exact: every side with a K/H, and no
    other, loses (K/H)∫∫p|v_s| within 1e-6 in every block; with friction that integral is the friction work over μ. The
    sliding distance is the stroke less the elastic displacement of the bodies."""
    study, stroke = WearStudy(cylinder(5.0, order, friction), (laws,), to_and_fro(5e-4)), 5e-4
    blocks = list(islice(study.blocks(9e5, BlockSettings(first=3e5, implicit=False)), 3))
    coefficients = {s: k for s, k in zip(((0, "arc"), (1, "near")), laws.coefficients) if k > 0.0}
    assert set(blocks[-1].state.evaluation.volumes) == set(coefficients)
    for state in (block.state.evaluation for block in blocks):
        for side, K_side in coefficients.items():
            work = sum(float(sliding.work.sum()) for sliding in state.contacts[0])
            assert state.volumes[side] == pytest.approx(K_side * work, rel=1e-6)
            assert 0.97 < work / (4.0 * stroke * LINE_LOAD) < 1.0 + 1e-5
        if friction:
            results = [own.result for own in state.contacts[0]]
            drag = [r.traction - r.pressure[:, None] * r.normals for r in results]
            lost = sum(r.weights @ np.einsum("qa,qa->q", τ, r.slip) for r, τ in zip(results, drag))
            # frames between the nodes of straight facets are shorter than one by 1e-6
            assert abs(lost) / friction == pytest.approx(work, rel=1e-5 if order == 1 else 1e-6)


def test_study_without_wear_or_laws_is_refused() -> None:
    """No K/H above zero, and no law for a contact, are refused."""
    with pytest.raises(ValueError, match="wanted a K/H above zero on some surface"):
        WearStudy(cylinder(3.0), (Archard(),), MILLIMETRE)
    with pytest.raises(ValueError, match="wanted a law for each of 1 contacts, found 0"):
        WearStudy(cylinder(3.0), (), MILLIMETRE)


def test_explicit_and_implicit_blocks_agree() -> None:
    """Problem: a soft cylinder, whose contact is three cells wide at first, by explicit and by implicit blocks at 2 %.
    Exact: the same depths; they differ by less than 2 % of the volume."""
    depths = []
    for implicit in (False, True):
        study = WearStudy(cylinder(material=Material(2.1e4, 0.3)), (Archard(K),), MILLIMETRE)
        begin = study.evaluate(np.zeros(len(study.areas)))
        assert begin.deformation > 0.0
        settings = BlockSettings(first=100.0, tolerance=0.02, implicit=implicit, deformation_share=0.3)
        *_, block = study.blocks(2e4, settings)
        depths.append(block.state.depth)
    assert study.areas @ np.abs(depths[0] - depths[1]) < 0.02 * study.areas @ depths[1]


def test_slip_cycle_is_periodic() -> None:
    """Problem: steel that moves to and fro by little more than it sticks. Exact: a periodic cycle, in which both legs
    slide equally far, and pressing wears nothing."""
    steel = Material(2.1e5, 0.3)
    study = WearStudy(cylinder(4.0, 1, 0.3, steel), (Archard(K),), to_and_fro(2e-4))
    state = study.evaluate(np.zeros(len(study.areas)))
    work = [float(own.work.sum()) for own in state.contacts[0]]
    assert work[0] == pytest.approx(0.0, abs=1e-9 * max(work))
    assert work[2] == pytest.approx(work[4], rel=1e-3)


def test_steps_longer_than_the_contact_are_refused() -> None:
    """A step of 0.3 mm over a contact of 0.05 mm, between whose ends nothing would wear, is refused."""
    steel = Material(2.1e5, 0.3)
    study = WearStudy(cylinder(4.0, 1, 0.0, steel), (Archard(K),), to_and_fro(0.3))
    with pytest.raises(ValueError, match="wanted steps that slide less than the contact is wide"):
        study.evaluate(np.zeros(len(study.areas)))


def slabs(E: float = 2.1e5) -> Problem:
    """A block of 2 × 1 mm on one of 4 × 2 mm, pressed with a thousandth of E."""
    steel = Material(E, 0.3)
    down = Rigid("top", (Freedom("y", -2e-3 * E),))
    upper = Body(rectangle(2.0, 1.0, 8, 4, 1, origin=(-1.0, 0.0)), steel, rigid=down)
    lower = Body(rectangle(4.0, 2.0, 20, 8, 1, origin=(-2.0, -2.0)), steel, (Fixed("bottom"),))
    return Problem((upper, lower), (Contact((0, "bottom"), (1, "top"), reach=0.05),))


def test_wear_beyond_the_reach_moves_the_mesh() -> None:
    """Problem: a block worn to a fifth of its height with a reach of 0.05 mm, the first block of cycles as long as the
    study. Exact: blocks are shortened, the meshes follow and the reach grows; the mesh has lost K F s within 0.1 %."""
    study = WearStudy(slabs(), (Archard(1e-6),), MILLIMETRE)
    cycles = 0.8 * 2.0 / (1e-6 * 2e-3 * 2.1e5)
    blocks = list(study.blocks(cycles, BlockSettings(first=cycles)))
    assert len(blocks) > 3 and blocks[0].refused > 0 and study.mesh_updates > 3
    assert scaled_jacobians(study.geometry.problem.bodies[0].mesh).min() > 0.3
    left = mesh_volume(study.meshes(blocks[-1].state.depth)[0])
    assert left == pytest.approx(2.0 - 1.6, rel=1e-3)


def test_body_worn_away_stops_the_study() -> None:
    """Problem: wear of ten times the block's height. Exact: WearStopped before the block is gone, and the last good
    state can be solved."""
    study, blocks = WearStudy(slabs(), (Archard(1.0),), MILLIMETRE), list[Block[CycleState]]()
    cycles = 10.0 * 2.0 / (1.0 * 2e-3 * 2.1e5)
    with pytest.raises(WearStopped, match=r"wanted scaled Jacobians.*last good state is kept"):
        blocks.extend(study.blocks(cycles, BlockSettings(first=cycles)))
    depth = blocks[-1].state.depth
    assert 0.5 < depth.min() < depth.max() < 1.0
    state = study.evaluate(depth)
    assert state.volumes[0, "bottom"] == pytest.approx(1.0 * 2e-3 * 2.1e5, rel=1e-6)


def test_travel_without_body_or_sliding_is_refused() -> None:
    """Travel of a body that does not exist, and a cycle without sliding, are refused."""
    with pytest.raises(ValueError, match="wanted travel of a body below 2, found body 5"):
        WearStudy(cylinder(3.0), (Archard(K),), Cycle(travel=(Travel(5, translation=(1.0, 0.0, 0.0)),)))
    still = WearStudy(cylinder(3.0), (Archard(K),), Cycle(travel=(Travel(1),)))
    with pytest.raises(ValueError, match="wanted a cycle in which something slides"):
        still.evaluate(np.zeros(len(still.areas)))


def test_mesh_of_a_worn_sphere_loses_the_worn_volume() -> None:
    """Problem: a quarter of a sphere, whose planes of symmetry move down with it. Exact: the mesh loses the worn volume
    within 0.1 %."""
    whole = mesh_volume(sphere().bodies[0].mesh)
    study = WearStudy(sphere(), (Archard(K),), MILLIMETRE, MeshMotion(depth=3e-3))
    *_, block = study.blocks(5e4, BlockSettings(first=5e3, tolerance=0.3))
    study.update_meshes(block.state.depth)
    assert study.mesh_updates >= 1
    lost = whole - mesh_volume(study.geometry.problem.bodies[0].mesh)
    assert lost == pytest.approx(K * POINT_LOAD / 4.0 * 5e4, rel=1e-3)
