"""Tooth sectors of the papers' gears: exact nodes, matching cuts, groups, quality."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.gears.profile import Profile
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.sector.section import SectorResolution, section_mesh
from evolvent_meshes.sector.sector import layer_heights, sector_mesh
from tests.support.meshes.mesh_measures import covers_boundary, measure
from tests.support.meshes.modified_gears import fully_modified
from tests.support.meshes.sector_cases import COARSE, GEARS, gear_and_start, nodes_of, sector, turned


@pytest.mark.parametrize("name", GEARS)
def test_quick_sectors_are_small_and_well_shaped(name: str) -> None:
    """The quick section: at most 880 nodes, 27 elements on the flank, scaled Jacobian at least 0.3, all gears."""
    gear, start = gear_and_start(name)
    section = section_mesh(gear, SectorResolution(flank_start_diameter=start))
    flat = sector_mesh(gear, SectorResolution(flank_start_diameter=start), "quadrilateral")
    assert len(section.points) <= 880
    assert len(section.edges["flank"]) == 27
    assert scaled_jacobians(flat).min() >= 0.3
    swept = sector_mesh(gear, SectorResolution(flank_start_diameter=start, face_elements=6))
    assert scaled_jacobians(swept).min() >= 0.25


@pytest.mark.parametrize("name", GEARS)
def test_flank_lies_on_the_helicoid(name: str) -> None:
    """Every flank node, middle nodes too, is on the exact involute helicoid; tip, bore and faces at theirs."""
    gear, start = gear_and_start(name)
    mesh = sector(name)
    flank = nodes_of(mesh, "flank")
    assert abs(Flank(gear).distance(flank)).max() < 1e-10
    radius = np.hypot(flank[:, 0], flank[:, 1])
    assert radius.min() == pytest.approx(start / 2, abs=1e-12)
    assert radius.max() == pytest.approx(gear.tip_diameter / 2, abs=1e-12)
    np.testing.assert_allclose(np.hypot(*nodes_of(mesh, "tip")[:, :2].T), gear.tip_diameter / 2, rtol=1e-13)
    np.testing.assert_allclose(np.hypot(*nodes_of(mesh, "bore")[:, :2].T), gear.bore_diameter / 2, rtol=1e-13)
    assert (nodes_of(mesh, "face_low")[:, 2] == -gear.face_width / 2).all()
    assert (nodes_of(mesh, "face_high")[:, 2] == gear.face_width / 2).all()


@pytest.mark.parametrize("name", GEARS)
def test_fillet_and_back_lie_on_the_profile(name: str) -> None:
    """Nodes of fillet and back lie on the exact profile: distance to its dense polygon at most the polygon's sag."""
    gear, _ = gear_and_start(name)
    mesh = sector(name, "quadrilateral")
    outline = Profile(gear).outline(2000)
    start, step = outline[:-1], np.diff(outline, axis=0)
    keep = (step**2).sum(axis=1) > 0
    start, step = start[keep], step[keep]
    for group in ("fillet", "back"):
        offset = nodes_of(mesh, group)[:, None, :2] - start
        along = np.clip((offset * step).sum(axis=2) / (step**2).sum(axis=1), 0, 1)
        assert np.linalg.norm(offset - along[..., None] * step, axis=2).min(axis=1).max() < 2e-6


@pytest.mark.parametrize(("name", "shape"), product(GEARS, ("hexahedron", "tetrahedron")))
def test_cuts_match_under_rotation(name: str, shape: str) -> None:
    """cut_low turned by one pitch is cut_high: nodes to 1e-9 and the same facets, hexahedra and tetrahedra."""
    gear, _ = gear_and_start(name)
    mesh = sector(name, shape)
    low, high = (np.unique(mesh.facets[group]) for group in ("cut_low", "cut_high"))
    distance = np.linalg.norm(turned(mesh.points[low], 2 * np.pi / gear.z)[:, None] - mesh.points[high][None], axis=2)
    partner = dict(zip(low.tolist(), high[distance.argmin(axis=1)].tolist(), strict=True))
    assert distance.min(axis=1).max() < 1e-9
    assert len(set(partner.values())) == len(high)
    wanted = {tuple(sorted(partner[n] for n in facet)) for facet in mesh.facets["cut_low"].tolist()}
    assert wanted == {tuple(sorted(facet)) for facet in mesh.facets["cut_high"].tolist()}


@pytest.mark.parametrize("name", ["yang pinion", "yang wheel"])
def test_sections_follow_the_helix(name: str) -> None:
    """The nodes at every height are those at mid-face turned by hand·z·tan β/(d/2), layers shrink to the ends."""
    gear, _ = gear_and_start(name)
    mesh = sector(name)
    levels = mesh.points.reshape(2 * COARSE.face_elements + 1, -1, 3)
    middle = levels[COARSE.face_elements]
    for level in levels:
        z = level[0, 2]
        turn = gear.hand * z * np.tan(gear.helix_angle) / (gear.reference_diameter / 2)
        np.testing.assert_allclose(level, turned(middle, turn) + np.array([0, 0, z]), atol=1e-12)
    lengths = np.diff(layer_heights(gear.face_width, COARSE)[::2])
    assert lengths[0] < lengths[1]
    np.testing.assert_allclose(lengths, lengths[::-1])


@pytest.mark.parametrize(("name", "shape"), product(("yang wheel", "he"), ("hexahedron", "tetrahedron")))
def test_groups_are_the_boundary_and_volume_is_right(name: str, shape: str) -> None:
    """The groups cover the boundary once; volume = exact section area × face width."""
    gear, _ = gear_and_start(name)
    mesh = sector(name, shape)
    assert covers_boundary(mesh)
    x, y = Profile(gear).outline(2000).T
    area = 0.5 * float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()) - np.pi / gear.z * (gear.bore_diameter / 2) ** 2
    assert measure(mesh) == pytest.approx(area * gear.face_width, rel=2e-5)
    assert len(mesh.volumes["tooth"]) == len(mesh.cells)


@pytest.mark.parametrize("name", ["yang pinion", "yang wheel", "he"])
def test_flank_nodes_follow_the_modifications(name: str) -> None:
    """Tip relief 20 µm and crowning 10 µm: nodes on the modified flank, at the same radii and heights, rest unmoved."""
    gear, start = gear_and_start(name)
    changed = replace(gear, modifications=Modifications(20.0, gear.tip_diameter - 2.0, True, 10.0))
    plain = sector(name)
    mesh = sector_mesh(changed, replace(COARSE, flank_start_diameter=start))
    assert abs(Flank(changed).distance(nodes_of(mesh, "flank"))).max() < 1e-9
    moved = np.linalg.norm(mesh.points - plain.points, axis=1)
    assert 0.029 < moved.max() < 0.06
    np.testing.assert_allclose(np.hypot(*mesh.points[:, :2].T), np.hypot(*plain.points[:, :2].T), rtol=1e-13)
    for group in ("back", "bore", "cut_low", "cut_high"):
        assert moved[np.unique(mesh.facets[group])].max() < 1e-12


@pytest.mark.parametrize(("name", "shape"), product(("yang pinion", "yang wheel", "he"), ("hexahedron", "tetrahedron")))
def test_flank_nodes_lie_on_a_flank_with_every_modification(name: str, shape: str) -> None:
    """Reliefs of tip, root and ends, crownings, slopes and twist, spur and helical: 1e-6 mm."""
    gear, start = gear_and_start(name)
    changed = fully_modified(gear)
    mesh = sector_mesh(changed, replace(COARSE, flank_start_diameter=start), shape)
    assert abs(Flank(changed).distance(nodes_of(mesh, "flank"))).max() < 1e-6
    assert abs(Flank(gear).distance(nodes_of(mesh, "flank"))).max() > 0.03


def test_unknown_cell_shape_is_refused() -> None:
    """A prism is no cell shape of a sector; the message names those that are."""
    gear, _ = gear_and_start("he")
    with pytest.raises(MeshError, match=r"one of quadrilateral, hexahedron.*'prism'"):
        sector_mesh(gear, COARSE, "prism")
