"""The levels of a flank: what the contact needs is on the finest one, and the body's mesh does not grow with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears.meshing.element_sizes import flank_needs
from evolvent.gears.meshing.flank_levels import (
    BODY_LAYER,
    LONGEST,
    ROUNDED_UP,
    SHEAR,
    length_over_height,
    levelled_sector,
)
from evolvent.gears.meshing.levelled_meshes import has_long_cells, is_two_level
from evolvent.gears.meshing.sector_sizes import divided_cells
from evolvent.gears.problem.gear_problem import GearProblem, Level, MeshSettings
from evolvent_meshes.gears.gear import GearParameters
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


def wide_pair(level: Level, torque: float, helix_angle: float = 15.0) -> GearProblem:
    """23/47 teeth, m_n = 2 mm, b = 25 mm: a face along which the contact wants twice the fewest coarse layers."""
    pinion, wheel = (
        GearParameters.from_rack(
            normal_module=2.0, normal_pressure_angle_deg=20.0, helix_angle_deg=helix_angle, z=z, face_width=25.0,
            bore_diameter=bore, hand=hand if helix_angle else 1,
        )
        for z, bore, hand in ((23, 20.0, 1), (47, 30.0, -1))
    )
    distance = 70.0 / np.cos(np.radians(helix_angle))
    return GearProblem(GearPair(pinion, wheel, distance), torque, mesh=MeshSettings(level))


@pytest.mark.parametrize("level", ["quick", "standard", "fine"])
def test_helical_flanks_have_no_cells_that_are_too_long_for_levels(level: Level) -> None:
    """Wanted layers would leave cells six to seven times as long as high, and one mesh of each sector three times the
    memory. Up to twice as many layers make them shorter; the levels halve these, so that the body has at most
    ROUNDED_UP times its fewest layers."""
    for torque in (100e3, 130e3, 160e3):
        pair = wide_pair(level, torque)
        assert not has_long_cells(pair)
        for member in Member:
            sector = levelled_sector(pair, member)
            assert length_over_height(pair.pair.gears[member], sector.coarse, *divided_cells(sector)) <= LONGEST
            assert sector.coarse.face_elements <= ROUNDED_UP * 28  # 25 mm over 0.9 mm
    assert is_two_level(wide_pair(level, 100e3))


def test_spur_flanks_get_no_layers_for_levels() -> None:
    """Cells of a spur pair are twenty times as long as high: layers that change that would cost more than one mesh."""
    spur = wide_pair("standard", 100e3, 0.0)
    assert has_long_cells(spur)
    assert levelled_sector(spur, Member.PINION).coarse.face_elements <= ROUNDED_UP * 28


def test_length_over_height_of_flank_cells() -> None:
    """Twice the layers halve it, twice the rows double it; a spur flank's of as many rows and layers is its width over
    the arc of its profile, (ρ_a² − ρ_s²)/(2 r_b)."""
    pair = wide_pair("quick", 100e3, 0.0)
    gear, coarse = pair.pair.pinion, levelled_sector(pair, Member.PINION).coarse
    one = length_over_height(gear, coarse, 10, 10)
    assert length_over_height(gear, coarse, 10, 20) == pytest.approx(one / 2)
    assert length_over_height(gear, coarse, 20, 10) == pytest.approx(one * 2)
    start = coarse.flank_start_diameter
    assert start is not None
    arc = (gear.roll_length(gear.tip_diameter) ** 2 - gear.roll_length(start) ** 2) / (2.0 * gear.base_radius)
    assert one == pytest.approx(25.0 / arc)
