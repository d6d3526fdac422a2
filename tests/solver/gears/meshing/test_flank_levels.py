"""The levels of a flank: what the contact needs is on the finest one, and the body's mesh does not grow with it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from evolvent.gears.meshing.element_sizes import flank_needs
from evolvent.gears.meshing.flank_levels import BODY_LAYER, SHEAR, levelled_sector
from evolvent.gears.problem.gear_problem import GearProblem, Level, MeshSettings
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.paper_pairs import yang


def problem(level: Level, torque: float = 250e3) -> GearProblem:
    return GearProblem(yang(), torque, mesh=MeshSettings(level, two_level=True))


@pytest.mark.parametrize("member", list(Member))
@pytest.mark.parametrize("level", ["quick", "standard", "fine"])
def test_finest_level_resolves_the_contact(level: Level, member: Member) -> None:
    """Rows at least as many as needed within a fifth, layers so that the ridge is sheared as wanted within a fifth, and
    a first cell below the flank that is as deep as wanted within a factor of 1.5."""
    sector, needs = levelled_sector(problem(level), member), flank_needs(problem(level), member, levels=True)
    rows, layers = sector.coarse.profile_elements, sector.coarse.face_elements
    depth = sector.coarse.layer_depths[0]
    for each in sector.levels:
        rows, layers, depth = rows * each.rows, layers * each.layers, depth / each.below[0]
    assert 0.8 < needs.rows / rows <= 1.2
    assert 0.8 < needs.shear / layers / SHEAR[level] <= 1.2
    assert 1 / 1.5 < depth / needs.depths[0] < 1.5


def test_body_does_not_grow_with_the_contact() -> None:
    """A load of a thousandth makes the contact 30 times narrower: five levels more, as each doubles the rows, and a
    body of at most 1.5 times the cells."""
    heavy, light = (levelled_sector(problem("quick", torque), Member.PINION) for torque in (250e3, 250.0))
    assert len(light.levels) == len(heavy.levels) + 5
    cells = [each.coarse.profile_elements * each.coarse.face_elements for each in (heavy, light)]
    assert cells[1] <= 1.5 * cells[0]


def test_layers_of_the_body_are_no_higher_than_wanted() -> None:
    """A wide face has coarse layers of at most BODY_LAYER modules."""
    pinion, wheel = (replace(gear, face_width=40.0) for gear in yang().gears)
    wide = GearProblem(GearPair(pinion, wheel, yang().centre_distance), 250e3, mesh=MeshSettings("quick"))
    layers = levelled_sector(wide, Member.PINION).coarse.face_elements
    assert 40.0 / layers <= BODY_LAYER * pinion.normal_module
