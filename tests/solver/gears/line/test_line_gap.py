"""The least gap across contact lines against closed forms and against a fine search of the same flanks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears.line.line_gap import GapProfile, LineGap, gap_across
from evolvent.gears.line.stations import Stations, stations_at
from evolvent.gears.problem.flank_deviations import FlankCharts
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent_meshes.arrays import Bools
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import helical_scene, spur_scene

RELIEF = tuple(
    f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("tip_relief_um=30", 'tip_relief_form="parabolic"')
)
DESIGNED: FlankCharts = (None, None)


def found(pair: GearPair, angle: float = 0.05, free: Member = Member.PINION) -> tuple[Stations, LineGap]:
    stations = stations_at(pair, angle, 0.5 if pair.pinion.helix_angle else None)
    return stations, GapProfile.of(RigidFlanks(pair, DESIGNED), stations, free).least()


def on_path(pair: GearPair, stations: Stations) -> Bools:
    start, end = pair.path_of_contact
    return (stations.roll_distance > start + 0.1) & (stations.roll_distance < end - 0.1)


@pytest.mark.parametrize("free", Member)
@pytest.mark.parametrize("pair", [helical_scene().gear_pair(), spur_scene().gear_pair()])
def test_conjugate_flanks_touch_along_their_lines(pair: GearPair, free: Member) -> None:
    """Exact: no gap, no shift, and Hertz' relative radius of curvature; to 2 % of the radius, for over the width of the
    parabola it changes."""
    stations, gap = found(pair, free=free)
    inside = on_path(pair, stations)
    assert gap.gap[inside] == pytest.approx(0.0, abs=1e-5)
    assert gap.shift[inside] == pytest.approx(0.0, abs=5e-3)
    assert gap.radius[inside] == pytest.approx(pair.relative_curvature_radius(stations.roll_distance[inside]), rel=0.02)
    assert not gap.edge[inside].any()


def test_relieved_flanks_have_the_gap_of_a_fine_search() -> None:
    """Problem: parabolic relief of 30 µm, a helical pair. Exact: the least gap in the slice of each point, by the same
    exact flanks on 4001 points across; 0.02 µm, and its place within 0.02 mm."""
    pair = helical_scene(*RELIEF).gear_pair()
    stations, gap = found(pair)
    flanks, free = RigidFlanks(pair, DESIGNED), Member.PINION
    inside = np.flatnonzero(on_path(pair, stations))[::7]
    across = np.linspace(-1.2, 1.2, 4001)
    values = gap_across(flanks, stations, free)
    fine = values(np.broadcast_to(across, (len(stations.point_z), len(across))))[inside]
    best = np.nanargmin(fine, axis=1)
    assert gap.gap[inside] == pytest.approx(fine[np.arange(len(inside)), best], abs=2e-5)
    assert gap.shift[inside] == pytest.approx(across[best], abs=0.02)
    assert gap.gap[inside].max() > 5e-3


@pytest.mark.parametrize("relief", [30, 150])
def test_deep_relief_leaves_a_gap(relief: int) -> None:
    """Problem: a relief so deep that its end moves the vertex of the gap to the edge of the tip. Exact: flanks with
    material taken off do not overlap; where nothing is taken off on either side of a line there is no gap."""
    pair = helical_scene(*(text.replace("=30", f"={relief}") for text in RELIEF)).gear_pair()
    for angle in (0.0, 0.05, 0.1, 0.2):
        stations, gap = found(pair, angle)
        assert gap.gap.min() > -1e-6
        assert gap.gap[np.abs(stations.roll_distance) < 1.0].max(initial=0.0) < 1e-5
        assert gap.gap.max() < 0.5


def test_least_gap_is_the_unloaded_transmission_error() -> None:
    """Problem: lead crowning and a misalignment, so that the flanks touch at a point. Exact: the least gap of all
    points, over cos β_b, is the unloaded transmission error; 0.1 µm on stations every 0.5 mm."""
    pair = helical_scene("pinion.lead_crowning_um=20", "wheel.profile_crowning_um=10").gear_pair()
    pair = replace(pair, misalignment_um=15.0)
    _, gap = found(pair)
    error = float(unloaded_error(RigidFlanks(pair, DESIGNED), np.array([0.05]))[0])
    assert gap.gap.min() / np.cos(pair.pinion.base_helix_angle) == pytest.approx(error, abs=1e-4)


def test_beyond_the_path_the_edge_of_a_tip_is_nearest() -> None:
    """Exact: where a line has left the path of contact, only the edge of a tip can touch, across a gap that grows."""
    pair = helical_scene().gear_pair()
    stations, gap = found(pair)
    start, end = pair.path_of_contact
    beyond = np.maximum(start - stations.roll_distance, stations.roll_distance - end)
    outside = beyond > 1e-3
    assert gap.edge[outside].all() and outside.any()
    farthest = beyond == beyond.max()
    assert gap.gap[farthest].min() > 1e-3
    assert gap.gap[outside].min() > -1e-6
