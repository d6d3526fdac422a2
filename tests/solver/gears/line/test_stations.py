"""Stations of a position: their hats divide the contact lines, none reaches across the end of the path of contact."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.line.stations import BEYOND, stations_at
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import helical_scene, spur_scene

HELICAL, SPUR = helical_scene().gear_pair(), spur_scene().gear_pair()
ANGLES = [0.0, 0.07, 0.2]


@pytest.mark.parametrize("pair", [HELICAL, SPUR])
@pytest.mark.parametrize("angle", ANGLES)
def test_hats_on_the_path_sum_to_the_contact_lines(pair: GearPair, angle: float) -> None:
    """Exact: Σℓ of the points on the path of contact is the length of the contact lines, `contact_line_length`."""
    stations = stations_at(pair, angle, 0.5)
    start, end = pair.path_of_contact
    on_path = (stations.roll_distance > start) & (stations.roll_distance < end)
    length = float(np.asarray(stations.hats.sum(axis=1)).ravel()[on_path].sum())
    assert length == pytest.approx(pair.contact_line_length(angle), rel=1e-9)


def test_hats_interpolate_linear_loads() -> None:
    """Exact: hats times a load linear in z are that load times the length that each point stands for; in the mean under
    a hat within the line z is the station's."""
    stations = stations_at(HELICAL, 0.1, 0.5)
    share = np.asarray(stations.hats.sum(axis=1)).ravel()
    assert stations.hats @ (2.0 + stations.z) == pytest.approx(share * (2.0 + stations.point_z), rel=1e-12)
    inner = np.abs(stations.z) < 3.0
    even = inner & (np.abs(stations.mean(stations.point_z) - stations.z) < 1e-9)
    assert even.sum() > 0.5 * inner.sum()


@pytest.mark.parametrize("angle", ANGLES)
def test_ends_of_the_path_are_stations(angle: float) -> None:
    """Problem: lines of a helical pair that leave the path of contact within the face. Exact: there is a station where
    they do, and no line goes further than `BEYOND` modules."""
    stations = stations_at(HELICAL, angle, 0.5)
    ξ = HELICAL.roll_distance(angle, stations.tooth, stations.z)
    (start, end), half = HELICAL.path_of_contact, 0.5 * HELICAL.face_width
    for tooth in np.unique(stations.tooth):
        ends = HELICAL.roll_distance(angle, tooth, np.array([-half, half]))
        for limit in (start, end):
            if ends.min() < limit < ends.max():
                assert np.abs(ξ[stations.tooth == tooth] - limit).min() < 1e-9
    reach = BEYOND * HELICAL.pinion.normal_module + 1e-9
    assert start - reach <= ξ.min() and ξ.max() <= end + reach


def test_a_tooth_pair_has_one_station_in_the_plane() -> None:
    """Tooth pairs in contact and within reach of the path of contact have a station of length 1."""
    stations = stations_at(SPUR, 0.0, None)
    assert set(SPUR.teeth_in_contact(0.0)) <= set(stations.tooth.tolist())
    assert len(set(stations.tooth.tolist())) == len(stations.tooth)
    assert stations.lengths.tolist() == [1.0] * len(stations.tooth)
