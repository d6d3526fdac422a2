"""When flanks have levels of their own, and the sizes that are told before a mesh is made."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from evidence.robustness.campaigns.random_scenes import random_scene
from evolvent.fem.surface import surface_of
from evolvent.gears.meshed_gear import meshed_gear
from evolvent.gears.meshing import element_sizes, levelled_meshes
from evolvent.gears.meshing.levelled_meshes import (
    flank_cells,
    has_long_cells,
    is_large,
    is_two_level,
    levelled_mesh,
    run_mesh,
)
from evolvent.gears.meshing.sector_sizes import levelled_sizes, one_mesh_sizes
from evolvent.gears.problem.gear_problem import GearOptions, GearProblem, MeshSettings
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from tests.support.meshes.modified_gears import fully_modified
from tests.support.meshes.sector_cases import ROUNDING
from tests.support.paper_pairs import yang

RELIEVED = Modifications(tip_relief_um=10.0, tip_relief_start_diameter=46.0, lead_crowning_um=5.0)


def problem(mesh: MeshSettings, options: GearOptions = GearOptions()) -> GearProblem:  # noqa: B008  frozen
    return GearProblem(yang(pinion=RELIEVED), 250.0e3, mesh=mesh, options=options)


def narrow() -> GearProblem:
    """2.8 mm wide, in levels."""
    pair = yang(pinion=RELIEVED)
    pinion, wheel = (replace(gear, face_width=2.8) for gear in pair.gears)
    mesh = MeshSettings("quick", 1.0, two_level=True)
    return GearProblem(GearPair(pinion, wheel, pair.centre_distance), 20e3, mesh=mesh)


def test_levels_are_for_large_meshes() -> None:
    """Yang's pair at quick: one mesh on 8 mm of the face, levels on the whole face of 16.9 mm."""
    whole = problem(MeshSettings("quick"))
    pinion, wheel = (replace(gear, face_width=8.0) for gear in whole.pair.gears)
    half = replace(whole, pair=GearPair(pinion, wheel, whole.pair.centre_distance), torque=0.5 * whole.torque)
    sizes = [sum(size.dofs for size in one_mesh_sizes(each)) for each in (half, whole)]
    assert sizes[0] < levelled_meshes.MOST_DOFS < sizes[1]
    assert [is_two_level(each) for each in (half, whole)] == [False, True]


def test_long_cells_have_no_levels_by_default() -> None:
    """A crowned spur pair of 380,000 degrees of freedom in one mesh, whose layers are ten times as long as its rows are
    high: only where levels are asked for."""
    rack: dict[str, Any] = {"normal_module": 3.0, "normal_pressure_angle_deg": 20.0, "face_width": 25.0}
    pinion = GearParameters.from_rack(
        z=25, bore_diameter=30.0, modifications=Modifications(lead_crowning_um=8.0), **rack
    )
    wheel = GearParameters.from_rack(z=60, bore_diameter=60.0, **rack)
    spur = GearProblem(GearPair(pinion, wheel, 127.5), 150e3)
    assert is_large(spur) and has_long_cells(spur) and not is_two_level(spur)
    assert is_two_level(replace(spur, mesh=MeshSettings(two_level=True)))
    assert not has_long_cells(problem(MeshSettings("standard")))


def test_levels_can_be_asked_for_and_refused() -> None:
    """Whatever the size; but a plane problem never has them."""
    assert is_two_level(problem(MeshSettings("quick", two_level=True)))
    assert not is_two_level(problem(MeshSettings("fine", two_level=False)))
    gear = GearParameters.from_rack(
        z=30, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=40.0
    )
    spur = GearProblem(GearPair(gear, gear, 90.0), 100e3, mesh=MeshSettings("fine", two_level=True))
    assert spur.is_plane and not is_two_level(spur)


@pytest.mark.parametrize(
    ("mesh", "options"),
    [
        (MeshSettings("fine", shape="tetrahedron"), GearOptions()),
        (MeshSettings("fine", order=1), GearOptions()),
        (MeshSettings("fine"), GearOptions(whole_gears=True)),
        (MeshSettings("fine"), GearOptions(fine_body=True)),
    ],
)
def test_by_default_there_are_none_where_they_cannot_be(mesh: MeshSettings, options: GearOptions) -> None:
    """One mesh, and no refusal."""
    own = problem(mesh, options)
    assert not is_two_level(own)


def test_sizes_are_those_of_the_meshes() -> None:
    """Exact: all nodes of the coarse sector, of its flank and cut faces, and of the flank's finest level."""
    own = narrow()
    for member, size in zip(Member, levelled_sizes(own)):
        gear = meshed_gear(own, member)
        flank, low, high = (len(np.unique(gear.mesh.facets[name])) for name in ("flank", "cut_low", "cut_high"))
        exact = np.array([len(gear.mesh.points), flank, low + high]) * 3
        assert [size.sector.dofs, size.sector.flank, size.sector.cuts] == exact.tolist()
        assert size.flank == gear.flank.points.size > 2 * size.sector.flank
        rows, layers = flank_cells(own, member)
        assert len(gear.flank.facets) == rows * layers


def test_the_coarse_sector_has_no_modifications() -> None:
    """Relief and crowning are on the fine flank only: 15 µm along the normal at the tip's ends, more about the axis."""
    sector = levelled_mesh(narrow(), Member.PINION)
    pair = narrow().pair
    bare = replace(narrow(), pair=replace(pair, pinion=replace(pair.pinion, modifications=Modifications())))
    same = levelled_mesh(bare, Member.PINION).mesh.points
    np.testing.assert_allclose(sector.mesh.points, same, rtol=0.0, atol=ROUNDING)
    moved = meshed_gear(narrow(), Member.PINION).flank.points - meshed_gear(bare, Member.PINION).flank.points
    assert 15e-3 < np.linalg.norm(moved, axis=1).max() < 25e-3


def test_flanks_in_levels_have_every_modification() -> None:
    """All nodes of the finest level lie on the modified flank: 1e-6 mm."""
    pair = narrow().pair
    gear = fully_modified(pair.pinion)
    changed = replace(narrow(), pair=replace(pair, pinion=gear))
    assert np.abs(Flank(gear).distance(meshed_gear(changed, Member.PINION).flank.points)).max() < 1e-6


def test_one_mesh_is_its_own_flank() -> None:
    """Without levels the flank's nodes are the mesh's."""
    own = replace(narrow(), mesh=MeshSettings("quick", 1.0, two_level=False))
    gear = meshed_gear(own, Member.WHEEL)
    assert isinstance(run_mesh(own, Member.WHEEL), MeshData) and not gear.has_levels
    assert np.array_equal(gear.flank.nodes, surface_of(gear.mesh, "flank").nodes)


@pytest.mark.parametrize(("seed", "member"), [(73, Member.PINION), (75, Member.WHEEL)])
def test_pointed_teeth_are_meshed(seed: int, member: Member, monkeypatch: pytest.MonkeyPatch) -> None:
    """Tips 0.07 and 0.08 modules thick: with thinner layers cells are of good quality, with those of other teeth they
    are not. Exact: all layers of an ordinary tooth together are `DEEPEST` modules deep."""
    problem = gear_problem(random_scene(seed, plane=False))
    problem = replace(problem, mesh=MeshSettings("quick", two_level=True))
    gear = problem.pair.gears[member]
    assert gear.normal_thickness(gear.tip_diameter) < 0.1 * gear.normal_module
    levelled_mesh(problem, member)
    usual = yang().pinion
    assert element_sizes.deepest_layers(usual).sum() == pytest.approx(element_sizes.DEEPEST * usual.normal_module)
    assert element_sizes.deepest_layers(gear).sum() < 0.8 * element_sizes.DEEPEST * gear.normal_module
    monkeypatch.setattr(element_sizes, "LEAST_DEEP", 1.0)
    with pytest.raises(MeshError, match="mesh quality"):
        levelled_mesh(problem, member)
