"""Where a spur pair enters the tip-edge zones: between two positions, wherever these lie."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from evidence.benchmarks.accuracy.spacing import PLASTIC
from evidence.solved_run import solved_run
from evolvent.contact.hertz import line_peak_pressure
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.pressure.line_peaks import zone_end_peaks
from evolvent.results.engagement import engagement, largest_peak
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import warnings_of
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.scene import load_scene
from tests.support.gear_cases import QUIET
from tests.support.run_parts import GOOD
from tests.support.synthetic_run import resolved_slices, synthetic_run


@pytest.fixture(scope="module")
def runs() -> list[RunData]:
    """An unrelieved plastic pinion without friction: one pitch of 40 positions, of which each fourth is taken, four
    times."""
    scene = load_scene(PLASTIC, [*QUIET, "contact.friction=0.0", "sweep.positions=40"])
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    return [replace(run, positions=run.positions[k::4]) for k in range(4)]


def test_peak_at_a_zone_limit_does_not_depend_on_the_positions(runs: list[RunData]) -> None:
    """The largest pressure stands where the tip-edge zone begins, which steps of 2° meet or miss by up to 2°: the
    sampled one differs by a tenth, that at the zone's end by less than half of that. Its place is the same within an
    eighth of a step."""
    found = [largest_peak(run, 0) for run in runs]
    assert all(peak.at_zone_end for peak in found)
    assert all(row.max_pressure_at_zone_end for run in runs for row in friction_rows(run))
    sampled = [np.nanmax(engagement(run, 0).max_pressure) for run in runs]
    spread = [np.ptp(values) / np.mean(values) for values in (sampled, [peak.pressure for peak in found])]
    assert spread[0] > 0.08 and spread[1] < 0.5 * spread[0], spread
    step = runs[0].pair.pinion.base_radius * runs[0].pitch / 10
    assert np.ptp([peak.roll_distance for peak in found]) < step / 8.0


def test_peak_at_a_zone_limit_is_warned_of(runs: list[RunData]) -> None:
    """The sentence names the roll distance where the zone begins, which no position stands at."""
    low = runs[1].inner_path[0]
    (said,) = [sentence for sentence in warnings_of(runs[1], GOOD) if "where a tip-edge zone begins" in sentence]
    assert f"ξ = −{-low:.2f} mm" in said
    assert not any(abs(solved.cut.roll_distance - low).min() < 1e-4 for each in runs[1].positions for solved in each)


def test_pressure_curve_holds_the_peaks_at_zone_limits(runs: list[RunData]) -> None:
    """The curve that pictures draw and bars are read from ascends, and its largest value is the figure."""
    for run in runs:
        curve = engagement(run, 0)
        angle, pressure = curve.pressure_curve
        assert np.all(np.diff(angle) > 0.0) and len(angle) == len(curve.angle) + len(curve.zone_ends)
        assert np.nanmax(pressure) == curve.peak.pressure == friction_rows(run)[0].max_pressure_MPa


def test_pressure_at_a_zone_limit_follows_the_load() -> None:
    """Problem: a spur tooth whose load rises by 50 N/mm a millimetre towards the tip edge, with peaks 3 % over
    Hertz's, at positions 0.4 mm apart, the outer three of them on the edge. The contact lies where
    the radius of curvature is 10 % larger than on the nominal line, which slices on the edge do not tell. Exact: 3 %
    over Hertz for the load and the curvature at −4.9 mm, between two positions; at the other end no edge bears, so
    there is none."""
    pair = synthetic_run(file="demos/he2022.toml").pair
    ξ = np.arange(-6.0, 6.1, 0.4)
    edge, ones, load = ξ < -5.1, np.ones(len(ξ)), 600.0 - 50.0 * (ξ + 3.0)
    radius = np.where(edge, 1.0, 1.1) * pair.relative_curvature_radius(ξ)
    hertz = np.asarray(line_peak_pressure(load, radius, 115e3))
    peak = np.where(edge, np.nan, 1.03 * hertz)
    cut = resolved_slices(np.zeros(len(ξ), dtype=int), 0.0 * ξ, ξ, ones, load, peak, peak, ones, hertz, radius, edge)
    (found,) = zone_end_peaks(pair, cut, (-4.9, 5.0))
    exact = 1.03 * line_peak_pressure(695.0, 1.1 * pair.relative_curvature_radius(-4.9), 115e3)
    assert (found.roll_distance, found.at_zone_end) == (-4.9, True)
    assert found.pressure == pytest.approx(float(exact), rel=2e-3)
