"""Contact lines on their flanks."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.contact.search_window import EXTENSION
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import Modifications
from tests.support.meshes.flanks_in_mesh import TEETH, crowned, flanks, line, modified, placed
from tests.support.paper_pairs import yang


def test_line_is_where_conjugate_flanks_touch() -> None:
    """Problem: the line on either flank at the pitch point and elsewhere on the path of contact. Exact: the roll
    lengths of pinion and wheel add up to the length of the line of action."""
    pair, z = yang(), np.linspace(-4.0, 4.0, 9)
    arcs = line(0).arc(z), line(0).opposite(z, line(0).arc(z))
    rolls = [np.sqrt(2.0 * gear.base_radius * arc) for gear, arc in zip(pair.gears, arcs)]
    assert sum(rolls) == pytest.approx(np.full(9, sum(pair.pitch_point_roll_lengths)), rel=1e-12)


def test_places_beyond_the_path_of_contact_are_opposite_at_equal_distances() -> None:
    """Problem: a slice whose line has left the path of contact by 0.2 mm. Exact: its line on the flanks is the path's
    end, and places there are as far from the undiminished contact line on the pinion as their opposites on the
    wheel."""
    pair, tooth = yang(), 1
    found = line(tooth)
    ξ = found.stand.roll_distance(tooth, np.array([0.0, 1.0]))
    z = np.array([(pair.path_of_contact[1] + 0.2 - ξ[0]) / (ξ[1] - ξ[0])])
    rolls = [pair.pitch_point_roll_lengths[g] + g.sign * (pair.path_of_contact[1] + 0.2) for g in Member]
    arcs = [roll**2 / (2.0 * gear.base_radius) for roll, gear in zip(rolls, pair.gears)]
    ended = (pair.pitch_point_roll_lengths[0] + pair.path_of_contact[1]) ** 2 / (2.0 * pair.pinion.base_radius)
    assert found.arc(z) == pytest.approx([ended])
    assert found.opposite(z, np.array([ended - 0.1])) == pytest.approx(arcs[1] - (ended - 0.1 - arcs[0]))


@pytest.mark.parametrize("tooth", TEETH)
def test_cells_begin_and_end_with_the_slices_in_reach(tooth: int) -> None:
    """Exact: limits ascend from slices whose line is within EXTENSION modules of the path of contact to the last of
    them, on common layers of the flanks; where the line leaves the path is a limit."""
    pair, found = yang(), line(tooth)
    limits = found.cell_limits(np.ones_like)
    assert (np.diff(limits) > 0.0).all()
    start, end = pair.path_of_contact
    beyond = EXTENSION * pair.pinion.normal_module
    layers = flanks()[1][0].height[::2]
    ξ = found.stand.roll_distance(tooth, layers)
    near = (ξ > start - beyond) & (ξ < end + beyond)
    used = np.flatnonzero(near[1:] | near[:-1])
    assert limits[[0, -1]] == pytest.approx(layers[[used[0], used[-1] + 1]])
    slope = found.stand.roll_distance(tooth, np.array([0.0, 1.0]))
    bends = (np.array([start, end]) - slope[0]) / (slope[1] - slope[0])
    for bend in bends[(bends > limits[0]) & (bends < limits[-1])]:
        assert np.abs(limits - bend).min() < 1e-9


@pytest.mark.parametrize("wanted", [0.5, 1.0, 1.7, 2.0, 3.1])
def test_cells_are_as_long_as_wanted(wanted: float) -> None:
    """Problem: cells of some lengths [mm] on the line across the face, whose layers are 0.47 mm high at its ends and
    0.94 mm in the middle. Exact: no cell is longer than wanted by more than a layer; those at the ends are one layer
    long; there are fewer than layers where they may be longer than the lowest."""
    found = line(0)
    layers = np.diff(found.flanks[0].height[::2])
    sizes = np.diff(found.cell_limits(lambda z: np.full_like(z, wanted)))
    assert sizes.max() <= max(wanted, layers.max()) + layers.max()
    assert sizes[[0, -1]] == pytest.approx(layers[[0, -1]])
    assert (len(sizes) < len(layers)) == (wanted > 0.5)


def test_bend_of_the_gap() -> None:
    """Problem: flanks without modifications, and a pinion with a lead crowning of 20 µm on a face width b. Exact: none;
    8 · 20 µm / b² at all heights, as the crown is a parabola along the face."""
    assert line(0).bend_of_gap(np.linspace(-6.0, 6.0, 5)) == pytest.approx(np.zeros(5), abs=1e-12)
    exact = 8.0 * 0.020 / yang().pinion.face_width**2
    assert crowned(20.0).bend_of_gap(np.linspace(-6.0, 6.0, 5)) == pytest.approx(np.full(5, exact), rel=1e-6)


def test_relief_that_starts_beside_the_line_bends_the_gap() -> None:
    """Problem: a linear tip relief of the pinion, whose start the line crosses. Exact: where it starts within three
    rows of the line it bends the gap; where it starts more than nine rows beside it, nothing does."""
    found = modified(
        Modifications(tip_relief_um=40.0, tip_relief_start_diameter=44.0, tip_relief_parabolic=False)
    )
    layers, base_radius = found.flanks[0].height[::2], yang().pinion.base_radius
    z = 0.5 * (layers[1:] + layers[:-1])
    away = (found.arc(z) - (22.0**2 - base_radius**2) / (2.0 * base_radius)) / found.row_width(z)
    bend = found.bend_of_gap(z)
    assert (np.abs(away) < 3.0).sum() > 5 and (bend[np.abs(away) < 3.0] > 5e-3).all()
    assert (away < -9.0).sum() > 5 and np.abs(bend[away < -9.0]).max() < 1e-12


def test_distance_of_places_that_face_each_other() -> None:
    """Problem: flanks without modifications at their nominal stand. Exact: none on the line but for what second-order
    facets leave of an involute; beside it the parabola of the relative curvature, up to its next term."""
    found = line(0)
    z, c = np.linspace(-3.0, 3.0, 7), 0.5
    assert np.abs(found.distance(found.arc(z), z, placed(0))).max() < 1e-3
    radius = yang().relative_curvature_radius(found.stand.roll_distance(0, z))
    assert found.distance(found.arc(z) + c, z, placed(0)) == pytest.approx(c**2 / (2.0 * radius), rel=0.2)
