"""Worn gears whose meshes follow: the same contact as by the gap, in 2D and 3D, orders 1 and 2; blocks that go on."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.wear.archard import Archard
from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.gears.gear_study import StudyState, checkpoint_of, study_states
from evolvent.wear.gears.gear_wear import GearWear
from evolvent.wear.gears.pair_geometry import MESHABLE_SLOPE, GearMeshMotion
from evolvent.wear.mesh_motion import mesh_volume
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.quality import scaled_jacobians
from tests.support.gear_cases import helical_scene, spur_scene

K = 1.3832e-10  # mm²/N, He 2022
RELIEF = tuple(f"{gear}.tip_relief_{key}" for gear in ("pinion", "wheel") for key in ("um=30", "form=parabolic"))


def scene_of(kind: str, *settings: str) -> Scene:
    """A spur pair without loaded tip edges, or a coarse helical one."""
    if kind == "spur":
        return spur_scene("mesh.level=quick", *RELIEF, *settings)
    return helical_scene("contact.friction=0", *settings)


def condenser(scene: Scene) -> Callable[[Callable[[Member], MeshData]], GearModel]:
    """See GearMeshMotion."""
    return lambda mesh: prepare_model(gear_problem(scene), MPI.COMM_SELF, lambda _, gear: mesh(gear)).model


def gears_of(scene: Scene, positions: int = 4, refresh: float = np.inf) -> GearWear:
    """Both gears wear alike."""
    model = prepare_model(gear_problem(scene), MPI.COMM_SELF).model
    pitch, following = uniform_pitch(model.pair.pinion.z, positions), GearMeshMotion(refresh, condenser(scene))
    return GearWear(model, pitch, 0.0, Archard(K, K), MPI.COMM_SELF, following)


def hollow(gears: GearWear, depth: float) -> np.ndarray:
    """A smooth wear of both flanks: nothing at root and tip, `depth` in the middle."""
    parts = []
    for grid in gears.grids:
        own, x = np.empty(grid.node.size), (grid.arcs - grid.arcs[0]) / np.ptp(grid.arcs)
        own[grid.node] = depth * np.sin(np.pi * x) ** 2
        parts.append(own)
    return np.concatenate(parts)


@pytest.mark.parametrize(
    ("kind", "order"), [("spur", 2), ("spur", 1), ("helical", 2), ("helical", 1)]
)  # fmt: skip
def test_meshes_that_follow_make_the_same_contact(kind: str, order: int) -> None:
    """Flanks worn by 5 µm in the middle, once as a gap and once by meshes that have lost it (their volume within
    0.1 %, no cell worse by more than a hundredth): the transmission error changes by 5 µm or more, and by which of both
    only within 2 % of that; wear rates are the same within 3 % of the volume."""
    scene = scene_of(kind, f"mesh.order={order}")
    gears = gears_of(scene)
    depth = hollow(gears, 5e-3)
    fresh, gap = gears.evaluate(gears.begin), gears.evaluate(depth)
    before = [body.mesh for body in gears.model.bodies]
    gears.update_meshes(depth)
    np.testing.assert_allclose(gears.mesh_depth, depth, atol=1e-12)
    for old, body, areas, own in zip(before, gears.model.bodies, gears.by_gear(gears.areas), gears.by_gear(depth)):
        assert mesh_volume(old) - mesh_volume(body.mesh) == pytest.approx(float(areas @ own), rel=1e-3)
        assert scaled_jacobians(body.mesh).min() > scaled_jacobians(old).min() - 0.01
    followed = gears.evaluate(depth, gap)
    assert followed.searched == len(gears.pitch.angles)  # what was kept stands on other meshes
    te = [np.array([p.transmission_error for p in state.positions]) for state in (fresh, gap, followed)]
    assert np.abs(te[1] - te[0]).max() > 5e-3
    assert np.abs(te[2] - te[1]).max() < 0.02 * np.abs(te[1] - te[0]).max()
    assert gears.areas @ np.abs(followed.rate - gap.rate) < 0.03 * gears.areas @ gap.rate


def test_a_block_on_other_meshes_is_refused() -> None:
    """A pitch solved before the meshes followed has nothing for a block after it."""
    scene = scene_of("spur")
    gears = gears_of(scene)
    now = gears.evaluate(gears.begin)
    gears.update_meshes(hollow(gears, 1e-3))
    with pytest.raises(ValueError, match="found one on others"):
        gears.implicit_block(gears.begin, now, 1e3)


def test_what_meshes_can_follow() -> None:
    """A pit at the tip's edge and random scratches: what is left is nowhere deeper, nothing at the root's rim, as
    gentle as wanted, itself where it is made gentle again, and the whole where the whole is gentle."""
    gears = gears_of(scene_of("helical"))
    rng = np.random.default_rng(0)
    depth = hollow(gears, 2e-3) + 1e-3 * rng.random(len(gears.begin))
    found = gears.geometry.meshable(depth)
    assert (found <= depth).all() and found.min() >= 0.0
    np.testing.assert_allclose(gears.geometry.meshable(found), found, atol=1e-15)
    for grid, own in zip(gears.grids, gears.by_gear(found)):
        slope = MESHABLE_SLOPE * (1.0 + 1e-9)
        assert (own[grid.node[:, 0]] == 0.0).all()
        assert (np.abs(np.diff(own[grid.node], axis=1)) <= slope * np.diff(grid.arcs)).all()
        assert (np.abs(np.diff(own[grid.node], axis=0)) <= slope * np.diff(grid.heights)[:, None]).all()
    smooth = hollow(gears, 1e-3)
    np.testing.assert_allclose(gears.geometry.meshable(smooth), smooth, atol=1e-15)


@cache
def studied(refresh: float) -> tuple[GearWear, list[StudyState]]:
    """A spur pair worn by 3 µm."""
    gears = gears_of(scene_of("spur"), 8, refresh)
    return gears, list(study_states(gears, (2e5, 8e5), BlockSettings(4e4)))


def test_study_with_meshes_that_follow() -> None:
    """Meshes that follow each 0.5 µm or not at all: depths within 1 % of the volume; both lose what was worn off."""
    (never, fixed), (often, moved) = studied(np.inf), studied(5e-4)
    assert never.mesh_updates == 0 and often.mesh_updates >= 3
    one, other = fixed[-1].state.depth, moved[-1].state.depth
    assert never.areas @ np.abs(one - other) < 0.01 * never.areas @ one
    assert [stage.report for stage in moved].count(True) == 3


def test_study_goes_on_from_what_was_kept() -> None:
    """Kept after the third block, when the meshes had followed, and gone on with by other objects: the same blocks and
    depths as without a stop within 1e-9 of the deepest."""
    _, whole = studied(5e-4)
    scene = scene_of("spur")
    first = gears_of(scene, 8, 5e-4)
    sweep = study_states(first, (2e5, 8e5), BlockSettings(4e4))
    stage = next(stage for k, stage in enumerate(sweep) if k == 4)
    assert first.mesh_updates > 0
    second, kept = gears_of(scene, 8, 5e-4), checkpoint_of(first, stage)
    rest = list(study_states(second, (2e5, 8e5), BlockSettings(4e4), kept))
    assert [s.state.cycles for s in rest] == pytest.approx([s.state.cycles for s in whole[4:]], rel=1e-9)
    deepest = whole[-1].state.depth.max()
    np.testing.assert_allclose(rest[-1].state.depth, whole[-1].state.depth, atol=1e-9 * deepest)
