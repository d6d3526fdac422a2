"""Tooth sectors of the papers' gears: exact nodes, matching cuts, groups, quality."""

from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.gear_geometry import Modifications
from evolvent_meshes.gears.profile import Profile
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.sector.section import SectorResolution, section_mesh
from evolvent_meshes.sector.sector import layer_heights, sector_mesh
from tests.meshes.shapes.test_blocks import covers_boundary, measure
from tests.support.paper_pairs import he, yang, zhang

GEARS = {
    "yang pinion": (yang, 0),
    "yang wheel": (yang, 1),
    "he": (he, 0),
    "zhang pinion": (zhang, 0),
    "zhang gear": (zhang, 1),
}
COARSE = SectorResolution(profile_elements=12, face_elements=4)


def gear_and_start(name: str) -> tuple[GearParameters, float]:
    """A gear and a flank start a little below the start of its active profile."""
    make, index = GEARS[name]
    pair = make()
    gear = pair.gears[index]
    return gear, max(gear.root_form_diameter, pair.active_start_diameters[index] - 0.15)


@cache
def sector(name: str, shape: str = "hexahedron") -> MeshData:
    """A coarse sector."""
    gear, start = gear_and_start(name)
    return sector_mesh(gear, replace(COARSE, flank_start_diameter=start), shape)


def nodes_of(mesh: MeshData, group: str) -> NDArray[np.float64]:
    """Points of a facet group."""
    return mesh.points[np.unique(mesh.facets[group])]


def turned(points: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Points turned about +z."""
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])


@pytest.mark.parametrize("name", GEARS)
def test_quick_size_and_quality(name: str) -> None:
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
def test_outline_is_exact(name: str) -> None:
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
def test_modified_flank(name: str) -> None:
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


def test_size_function_grades_the_flank() -> None:
    """Element lengths along the involute in proportion to a size that doubles from flank start to tip, within 3 %."""
    gear, start = gear_and_start("he")
    low, high = start / 2, gear.tip_diameter / 2

    def size_at(radius: NDArray[np.float64]) -> NDArray[np.float64]:
        return 1 + (radius - low) / (high - low)

    section = section_mesh(gear, SectorResolution(flank_start_diameter=start, size_at=size_at))
    edges = section.points[section.edges["flank"]]
    length = np.linalg.norm(edges[:, 2] - edges[:, 0], axis=1) + np.linalg.norm(edges[:, 1] - edges[:, 2], axis=1)
    ratio = length / size_at(np.hypot(*edges[:, 2].T))
    np.testing.assert_allclose(ratio, ratio.mean(), rtol=0.03)


def test_clear_errors() -> None:
    """A count not divisible by three, a flank start off the involute and an unknown shape are refused."""
    gear, _ = gear_and_start("he")
    with pytest.raises(MeshError, match="multiple of 3"):
        SectorResolution(profile_elements=28)
    with pytest.raises(MeshError, match="on the involute"):
        section_mesh(gear, SectorResolution(flank_start_diameter=100.0))
    with pytest.raises(MeshError, match="prism"):
        sector_mesh(gear, COARSE, "prism")
