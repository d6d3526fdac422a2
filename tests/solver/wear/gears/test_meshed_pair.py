"""Meshes of a gear pair that follow the wear: the same contact as by the gap, in 2D and 3D, orders 1 and 2."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.wear.gears.meshed_pair import MESHABLE_SLOPE
from evolvent.wear.mesh_motion import mesh_volume
from evolvent_meshes.mesh.quality import scaled_jacobians
from tests.support.gear_wear_cases import smooth_wear, wear_scene, wearing_gears


@pytest.mark.parametrize(
    ("kind", "order"),
    [("spur", 2), ("spur", 1), pytest.param("helical", 2, marks=pytest.mark.evidence), ("helical", 1)],
)
def test_wear_in_the_meshes_and_in_the_gap_give_the_same_contact(kind: str, order: int) -> None:
    """Problem: flanks worn by 5 µm in the middle, once in the gap and once in the meshes. Exact: the meshes lose that
    volume within 0.1 %, no cell worse by more than a hundredth. The transmission error changes by 5 µm or more, the
    same in both cases within 2 % of that; wear rates agree within 3 % of the volume."""
    narrow = ("pinion.face_width_mm=4", "wheel.face_width_mm=4") if (kind, order) == ("helical", 2) else ()
    scene = wear_scene(kind, f"mesh.order={order}", *narrow)
    gears = wearing_gears(scene)
    depth = smooth_wear(gears, 5e-3)
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


def test_meshable_depth_is_slope_limited() -> None:
    """Problem: smooth wear with random scratches. Exact: the meshable depth is nowhere larger, zero at the root's rim,
    within the largest slope, unchanged when limited again, and the whole depth where that is smooth."""
    gears = wearing_gears(wear_scene("helical"))
    rng = np.random.default_rng(0)
    depth = smooth_wear(gears, 2e-3) + 1e-3 * rng.random(len(gears.begin))
    found = gears.geometry.meshable(depth)
    assert (found <= depth).all() and found.min() >= 0.0
    np.testing.assert_allclose(gears.geometry.meshable(found), found, atol=1e-15)
    for grid, own in zip(gears.grids, gears.by_gear(found)):
        slope = MESHABLE_SLOPE * (1.0 + 1e-9)
        assert (own[grid.node[:, 0]] == 0.0).all()
        assert (np.abs(np.diff(own[grid.node], axis=1)) <= slope * np.diff(grid.arcs)).all()
        assert (np.abs(np.diff(own[grid.node], axis=0)) <= slope * np.diff(grid.heights)[:, None]).all()
    smooth = smooth_wear(gears, 1e-3)
    np.testing.assert_allclose(gears.geometry.meshable(smooth), smooth, atol=1e-15)
