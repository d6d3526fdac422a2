"""Contact lines on their flanks."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.contact.search_window import EXTENSION
from evolvent_meshes.gears.member import Member
from tests.support.meshes.flanks_in_mesh import TEETH, flanks, line, placed
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
    limits = found.cell_limits(10.0)
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


def test_distance_of_places_that_face_each_other() -> None:
    """Problem: flanks without modifications at their nominal stand. Exact: none on the line but for what second-order
    facets leave of an involute; beside it the parabola of the relative curvature, up to its next term."""
    found = line(0)
    z, c = np.linspace(-3.0, 3.0, 7), 0.5
    assert np.abs(found.distance(found.arc(z), z, placed(0))).max() < 1e-3
    radius = yang().relative_curvature_radius(found.stand.roll_distance(0, z))
    assert found.distance(found.arc(z) + c, z, placed(0)) == pytest.approx(c**2 / (2.0 * radius), rel=0.2)
