"""The transverse section of a sector: cell sizes along the flank, refused resolutions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.sector.section import SectorResolution, section_mesh
from tests.support.meshes.sector_cases import gear_and_start


def test_size_function_grades_the_flank() -> None:
    """Element lengths along the involute in proportion to a size that doubles from flank start to tip, within 3 %."""
    gear, start = gear_and_start("he")
    low, high = start / 2, gear.tip_diameter / 2

    def size_at(radius: Floats) -> Floats:
        return 1 + (radius - low) / (high - low)

    section = section_mesh(gear, SectorResolution(flank_start_diameter=start, size_at=size_at))
    edges = section.points[section.edges["flank"]]
    length = np.linalg.norm(edges[:, 2] - edges[:, 0], axis=1) + np.linalg.norm(edges[:, 1] - edges[:, 2], axis=1)
    ratio = length / size_at(np.hypot(*edges[:, 2].T))
    np.testing.assert_allclose(ratio, ratio.mean(), rtol=0.03)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"profile_elements": 28}, "multiple of 3"),
        ({"layer_depths": (0.1, 0.2)}, "3 layers"),
        ({"rim_elements": 0}, "positive counts"),
        ({"fillet_elements": 3}, "more fillet and back elements than neck elements"),
    ],
)
def test_impossible_resolutions_are_refused(change: dict[str, Any], message: str) -> None:
    """A profile that three fine rows to a coarse one do not divide, missing layers, no cells, too few at the fillet."""
    with pytest.raises(MeshError, match=message):
        SectorResolution(**change)


def test_flank_start_off_the_involute_is_refused() -> None:
    """100 mm is far below the form circle of He's gear, 145 mm: the message gives the range of the involute."""
    gear, _ = gear_and_start("he")
    with pytest.raises(MeshError, match=r"on the involute, from 14\d\.\d+ \(root form\)"):
        section_mesh(gear, SectorResolution(flank_start_diameter=100.0))
