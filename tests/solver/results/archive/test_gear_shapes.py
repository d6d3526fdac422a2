"""Surfaces of sectors as they are archived, with flanks of their mesh and with flanks that have levels of their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears.meshed_gear import MeshedGear, meshed_gear
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent.results.archive.gear_shapes import MeshRecord, gear_shape
from evolvent.results.fields.polygons import Polygons, flank_surface, sector_surface
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.paper_pairs import yang


def gears(two_level: bool) -> list[MeshedGear]:
    """Yang's pair, 2.8 mm wide."""
    pinion, wheel = (replace(gear, face_width=2.8) for gear in yang().gears)
    mesh = MeshSettings("quick", 1.0, two_level=two_level)
    problem = GearProblem(GearPair(pinion, wheel, yang().centre_distance), 20e3, mesh=mesh)
    return [meshed_gear(problem, member) for member in Member]


def area_vectors(surface: Polygons) -> Floats:
    """(faces, 3) of quadrilaterals."""
    (faces,) = surface.faces
    a, b, c, d = (surface.points[faces[:, k]] for k in range(4))
    return np.asarray(0.5 * np.cross(c - a, d - b))


@pytest.mark.parametrize("two_level", [False, True])
def test_the_flank_is_drawn_as_contact_has_it(two_level: bool) -> None:
    """Polygons on all nodes of the flank: their area within 1e-4, all on the same side; each gear's nodes in order."""
    for gear in gears(two_level):
        shape = gear_shape(gear)
        found = area_vectors(flank_surface(shape, 2.8))
        assert np.linalg.norm(found, axis=1).sum() == pytest.approx(float(gear.flank.areas().sum()), rel=1e-4)
        assert (found @ found.mean(axis=0) > 0.0).all() or (found @ found.mean(axis=0) < 0.0).all()
        assert np.array_equal(shape.points[shape.flank_nodes], gear.flank.points)


def test_a_sector_has_one_flank() -> None:
    """The surface of a sector with its flank is as large in levels as on one mesh, within 0.2 %, and closed alike."""
    areas = []
    for two_level in (False, True):
        shape = gear_shape(gears(two_level)[0])
        areas.append(np.linalg.norm(area_vectors(sector_surface(shape, 2.8, True)), axis=1).sum())
    assert areas[1] == pytest.approx(areas[0], rel=2e-3)


def test_counts_are_of_coarse_sectors_and_fine_flanks() -> None:
    """Degrees of freedom apart from each other; of one mesh there are none of the flanks."""
    levels, one = MeshRecord.of(gears(True)), MeshRecord.of(gears(False))
    assert one.flank_dofs == 0 < levels.flank_dofs
    assert levels.flank_dofs == 3 * sum(len(shape.flank_nodes) for shape in levels.shapes)
    assert levels.dofs + levels.flank_dofs == 3 * sum(len(shape.points) for shape in levels.shapes)
    assert one.dofs == 3 * sum(len(shape.points) for shape in one.shapes)
    assert min(levels.min_scaled_jacobian, one.min_scaled_jacobian) > 0.05
