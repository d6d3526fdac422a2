"""Points moved onto the loaded flank."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.sector.flank_points import on_flank
from tests.support.meshes.sector_cases import gear_and_start, nodes_of, sector


@pytest.mark.parametrize("name", ["yang pinion", "yang wheel"])
def test_nodes_of_a_sector_stay(name: str) -> None:
    """The flank's nodes lie on the helicoid: they do not move, and points turned by 1 µm come back to them. Exact."""
    gear, _ = gear_and_start(name)
    points = nodes_of(sector(name), "flank")
    beside = points + 1e-3 * np.cross([0.0, 0.0, 1.0], points) / np.hypot(points[:, 0], points[:, 1])[:, None]
    beside[:, :2] *= (np.hypot(*points[:, :2].T) / np.hypot(*beside[:, :2].T))[:, None]
    for given in (points, beside):
        assert on_flank(gear, given) == pytest.approx(points, abs=1e-11)


def test_modified_flank_is_an_offset_along_the_normal() -> None:
    """Tip relief and crowning: the distance of the moved points from the helicoid is the modification, but for the
    square of it: 2 µm shift the foot of the normal by 2 µm, over which the relief grows by 3 nm."""
    gear, _ = gear_and_start("yang pinion")
    relieved = replace(gear, modifications=Modifications(
        tip_relief_um=2.0, tip_relief_start_diameter=45.0, lead_crowning_um=1.0,
    ))
    points = on_flank(relieved, nodes_of(sector("yang pinion"), "flank"))
    flank, plain = Flank(relieved), Flank(gear)
    roll = flank.roll_length(np.hypot(points[:, 0], points[:, 1]))
    normal = plain.helicoid_normal(roll, points[:, 2])
    offset = np.einsum("na,na->n", plain.helicoid_point(roll, points[:, 2]) - points, normal)
    assert offset == pytest.approx(flank.modification(roll, points[:, 2]), abs=5e-6)
    assert offset.max() > 2e-3
