"""A bore that is held on a part of the face: exact ends, the flank as it was, cuts that match."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.meshes.mesh_measures import covers_boundary, measure
from tests.support.meshes.sector_cases import COARSE, ROUNDING, gear_and_start, nodes_of, sector, turned

SUPPORTS = [Support(6.0, 1.3), Support(8.45, -4.225), Support(16.0, 0.0), Support(0.9, 7.0)]


@pytest.mark.parametrize("support", SUPPORTS, ids=["inside", "half", "nearly all", "narrow"])
@pytest.mark.parametrize("shape", ["hexahedron", "tetrahedron"])
def test_bore_is_held_between_the_ends_of_the_support(support: Support, shape: str) -> None:
    """Yang's wheel, 16.9 mm wide: the held facets reach from end to end within 1e-12 mm, the free ones lie outside;
    both together are the bore of the plain mesh, whose flank and volume do not change; the cuts match."""
    gear, start = gear_and_start("yang wheel")
    resolution = replace(COARSE, flank_start_diameter=start, face_elements=8)
    held = replace(gear, support=support)
    mesh, plain = sector_mesh(held, resolution, shape), sector_mesh(gear, resolution, shape)
    z, (low, high) = nodes_of(mesh, "bore")[:, 2], support.ends(gear.face_width)
    assert (z.min(), z.max()) == pytest.approx((low, high), abs=1e-12)
    free = mesh.points[mesh.facets["bore_free"], 2].mean(axis=1)
    assert not ((free > low) & (free < high)).any()
    assert len(mesh.facets["bore"]) + len(free) == len(plain.facets["bore"])
    np.testing.assert_allclose(nodes_of(mesh, "flank"), nodes_of(plain, "flank"), rtol=0.0, atol=ROUNDING)
    assert abs(Flank(held).distance(nodes_of(mesh, "flank"))).max() < 1e-9
    assert covers_boundary(mesh)
    assert measure(mesh) == pytest.approx(measure(plain), rel=1e-6)
    cuts = [mesh.points[np.unique(mesh.facets[name])] for name in ("cut_low", "cut_high")]
    distance = np.linalg.norm(turned(cuts[0], 2 * np.pi / gear.z)[:, None] - cuts[1][None], axis=2)
    assert distance.min(axis=1).max() < 1e-9


def test_whole_face_is_one_group() -> None:
    """A support as wide as the face is the default: the same mesh."""
    gear, start = gear_and_start("yang wheel")
    mesh = sector_mesh(replace(gear, support=Support(16.9)), replace(COARSE, flank_start_diameter=start))
    assert "bore_free" not in mesh.facets
    np.testing.assert_allclose(mesh.points, sector("yang wheel").points, rtol=0.0, atol=ROUNDING)


def test_too_few_layers_are_refused() -> None:
    """Two layers cannot end at two places inside the face."""
    gear, start = gear_and_start("yang wheel")
    resolution = replace(COARSE, flank_start_diameter=start, face_elements=2)
    with pytest.raises(MeshError, match="at least 3 layers"):
        sector_mesh(replace(gear, support=Support(6.0)), resolution)
