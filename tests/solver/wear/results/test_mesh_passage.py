"""What a point of a flank sees in one mesh: Hertz ridges on He's pair against the exact figures for rigid sharing."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from mpi4py import MPI

from evolvent.contact.hertz import line_pressure
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.results.drawing.style import styled
from evolvent.results.run_data import RunData
from evolvent.run.coarse_run import solved_run
from evolvent.run.pitch_run import pitch_of
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent.wear.results.mesh_passage import (
    ContactProfile,
    DepthProfile,
    PointPassage,
    pitch_point_depth,
    radius_at,
    roll_distance_at,
    sliding_distance,
)
from evolvent.wear.results.passage_figures import point_in_contact
from evolvent.wear.results.report import WornPair
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import helical_scene, model_of, spur_scene
from tests.support.synthetic_run import synthetic_run

K = 1.3832e-10  # mm²/N, He et al. 2022
A = 77.0  # mm, their point A


@cache
def he() -> RunData:
    """He's pair with Hertz' pressure, both tooth pairs bearing half the load where there are two."""
    return synthetic_run("sweep.positions=40", "mesh.level=fine", file="demos/he2022.toml")


def unworn(run: RunData) -> WornPair:
    """The run with charts on the flanks' own nodes."""
    charts = []
    for shape in run.shapes:
        diameters = np.unique(np.round(2.0 * np.hypot(*shape.points[shape.flank_nodes].T[:2]), 9))
        charts.append(FlankChart(diameters, np.zeros(1), np.zeros((len(diameters), 1))))
    return WornPair(0.0, run, (charts[0], charts[1]), (0.0, 0.0))


def test_point_a_at_half_load() -> None:
    """p0 = 425.0 MPa over 0.334° of the pinion, and a sliding distance of 0.0625 mm."""
    point = PointPassage.of(he(), A)
    assert point.hertz.max() == pytest.approx(425.0, abs=0.1)
    assert point.pressure.max() == pytest.approx(425.0, rel=2e-3)
    assert np.degrees(point.lasts) == pytest.approx(0.334, rel=0.02)
    assert point.sliding[-1] == pytest.approx(0.0625, rel=0.02)
    inner = point.hertz > 0.7 * 425.0  # averages reach half a cell over the rims, which are steep
    np.testing.assert_allclose(point.pressure[inner], point.hertz[inner], atol=0.02 * 425.0)


def test_legend_beside_the_curves() -> None:
    """Point A's stress over its rotation: no point of a curve lies behind the legend."""
    with styled():
        figure = point_in_contact(PointPassage.of(he(), A))
    FigureCanvasAgg(figure).draw()
    axes = figure.axes[0]
    box = axes.get_legend().get_window_extent()
    for line in axes.lines:
        assert not any(box.contains(*point) for point in axes.transData.transform(line.get_xydata()))


def test_a_point_sees_no_spikes() -> None:
    """Problem: He's pair solved at standard, a point between the pitch point and the tip. Exact: the pressure rises to
    Hertz' and falls again, so that all its ups and downs come to twice the largest, and the force is Hertz' for the own
    load; single quadrature points beside the contact's rim make that up to four times, and the largest 19 % higher."""
    scene = spur_scene("mesh.level=standard", "sweep.positions=20", "contact.friction=0")
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    point = PointPassage.of(run, A)
    assert point.pressure.max() == pytest.approx(point.hertz.max(), rel=0.05)
    assert np.abs(np.diff(point.pressure)).sum() < 2.05 * point.pressure.max()
    assert point.pressure.sum() == pytest.approx(point.hertz.sum(), rel=0.01)


def test_contacts_over_the_profile() -> None:
    """Fitted stress and width are Hertz'; away from the pitch point the sliding is 2b|1 − v_2/v_1|, at point A 0.0625
    mm, and at the pitch point it is not zero."""
    for gear in Member:
        found = ContactProfile.of(he(), gear)
        np.testing.assert_allclose(found.peak, found.hertz, rtol=1e-3)
        np.testing.assert_allclose(found.half_width, found.hertz_half_width, rtol=1e-3)
        away = np.abs(found.roll_distance) > 1.0
        np.testing.assert_allclose(found.sliding[away], found.single_point[away], rtol=3e-3)
        at = int(np.argmin(np.abs(found.roll_distance)))
        assert found.single_point[at] < 1e-3 < 3e-3 < found.sliding[at]
    pinion = ContactProfile.of(he(), Member.PINION)
    assert np.interp(A, pinion.radius, pinion.single_point) == pytest.approx(0.0625, abs=1e-4)


def test_depths_of_a_million_meshes() -> None:
    """At point A 2.885 µm by the line contact and 3.674 by Eq. 24; what is gathered is the former within 1 %, and at
    the pitch point what a Hertz ridge leaves there within 5 %."""
    pair = unworn(he())
    for gear in Member:
        depths = DepthProfile.of(pair, gear, K)
        own, line, product = (
            1e9 * float(np.interp(A, depths.radius, values))
            for values in (depths.computed, depths.line, depths.peak_times_sliding)
        )
        assert (line, product) == pytest.approx((2.885, 3.674), abs=2e-3)
        assert own == pytest.approx(line, rel=1e-2)
        lowest = float(np.interp(75.0, depths.radius, depths.computed))
        assert lowest == pytest.approx(pitch_point_depth(pair.run, gear, K), rel=5e-2)


def test_pitch_point_depth_is_the_integral() -> None:
    """(K/H)∫p|v_s|dφ of a Hertz ridge over the pitch point, by quadrature, for both gears of a pair of unequal ones."""
    run = synthetic_run("pinion.face_width_mm=25.0", file="demos/zhang2023.toml")
    pair, φ = run.pair, np.linspace(-0.02, 0.02, 400_001)
    for gear in Member:
        ridge = ContactProfile.of(run, gear)
        at = int(np.argmin(np.abs(ridge.roll_distance)))
        assert abs(ridge.roll_distance[at]) < 1e-9
        ξ = pair.pinion.base_radius * φ
        s = line_arc(pair, gear, np.zeros(1)) - line_arc(pair, gear, ξ)
        speed = (1.0 + 1.0 / pair.ratio) * np.abs(ξ)
        whole = line_pressure(s, float(ridge.hertz_half_width[at]), float(ridge.hertz[at])) @ speed * (φ[1] - φ[0])
        assert pitch_point_depth(run, gear, K) == pytest.approx(K * whole, rel=2e-3)


def test_sliding_is_the_integral() -> None:
    """∫|v_s|dφ while a contact of half-width b is over the point, by quadrature, also over the pitch point."""
    pair, b, φ = he().pair, 0.13, np.linspace(-0.15, 0.15, 600_001)
    speed = (1.0 + 1.0 / pair.ratio) * pair.pinion.base_radius * np.abs(φ)
    for gear in Member:
        for ξ in (-6.0, -0.1, 0.0, 5.0):
            s = line_arc(pair, gear, np.array([ξ])) - line_arc(pair, gear, pair.pinion.base_radius * φ)
            whole = float(speed @ (np.abs(s) < b)) * (φ[1] - φ[0])
            assert sliding_distance(pair, gear, np.array([ξ]), np.array([b]))[0] == pytest.approx(whole, rel=1e-3)


def places(pair: GearPair, gear: Member, ξ: Floats) -> Floats:
    """ξ there and back."""
    return roll_distance_at(pair, gear, radius_at(pair, gear, ξ))


@pytest.mark.parametrize("gear", Member)
def test_radii_and_roll_distances(gear: Member) -> None:
    """Each the other's inverse; on the pinion the tip is touched at the end of the path, on the wheel at its start."""
    pair, ξ = he().pair, np.linspace(*he().pair.path_of_contact, 7)
    np.testing.assert_allclose(places(pair, gear, ξ), ξ, atol=1e-12)
    assert radius_at(pair, gear, ξ).max() == pytest.approx(78.0)
    assert np.argmax(radius_at(pair, gear, ξ)) == (6, 0)[gear]


@pytest.mark.parametrize("make", [spur_scene, helical_scene])
def test_regular_grid_has_the_flanks_areas(make) -> None:
    """Of the nodes of a mesh's flank: areas within 1 % each, in all within 1e-4."""
    for body in model_of(make("mesh.level=quick")).bodies:
        own = FlankGrid.of(body)
        regular = FlankGrid.regular(own.arcs, own.heights, body.gear.base_helix_angle)
        assert regular.areas.sum() == pytest.approx(own.areas.sum(), rel=1e-4)
        np.testing.assert_allclose(regular.areas[regular.node], own.areas[own.node], rtol=1e-2)
