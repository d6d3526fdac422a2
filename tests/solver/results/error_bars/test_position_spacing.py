"""What the spacing of positions hides: curves whose extremes and means are known, and a plastic pinion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.text import Text
from mpi4py import MPI

from evidence.benchmarks.accuracy.error_bars import hit_rate
from evidence.benchmarks.accuracy.spacing import PLASTIC, SpacingProblem, measure_spacing
from evidence.solved_run import solved_run
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.solution.certificates import pitch_imbalance
from evolvent.results.archive.error_bar_data import summed_errors
from evolvent.results.drawing.style import styled
from evolvent.results.engagement import engagement
from evolvent.results.error_bars.estimation import Companion, errors_between, estimated_errors
from evolvent.results.error_bars.peak_bounds import roundness, tops
from evolvent.results.error_bars.position_spacing import (
    bends,
    every_other,
    missed_peaks,
    scatter,
    shares,
    spacing_errors,
    thinned_mean,
)
from evolvent.results.figures.flank import pressure_map
from evolvent.results.figures.stress import engagement_stress
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import SPACING_SAID, about_spacing, warnings_of
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.scene import load_scene
from evolvent_meshes.arrays import Floats
from tests.support.run_parts import GOOD
from tests.support.synthetic_run import synthetic_run

COARSE = ('mesh.level="quick"', "contact.friction=[0.2]", "load.torque_Nm=0.89")  # for which meshes are made


def plastic(positions: int) -> RunData:
    scene = load_scene(PLASTIC, [*COARSE, f"sweep.positions={positions}"])
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    return run


def largest_value(x: Floats, y: Floats, jumps: bool) -> float:
    """The largest value that a curve with these samples may have at them and between them."""
    return float(np.nanmax(np.append(tops((x, y), jumps), y)))


@pytest.fixture(scope="module")
def run() -> RunData:
    """A pitch in twenty positions."""
    return plastic(20)


def test_tops_find_a_kink_between_samples() -> None:
    """Two straight lines that meet at x = 2.4, 3.2 high, sampled at whole numbers: found exactly, and nothing where
    the kink is a valley or lies on a sample."""
    x = np.arange(6.0)
    for top in (2.4, 2.0):
        y = 3.2 - np.where(x < top, 1.0, 0.5) * np.abs(x - top)
        assert largest_value(x, y, jumps=False) == pytest.approx(3.2)
        assert largest_value(x, -y, jumps=False) == pytest.approx(-y.min())


def test_tops_find_a_smooth_top_between_samples() -> None:
    """A parabola with its top, 0, halfway between samples a step apart: a bend that is as large all around is no kink,
    and the top is found exactly, a quarter of the way up to where straight lines meet. Half of a step's bend is seen at
    either sample of a kink, and none beside them: the lines meet in it."""
    x = np.arange(8.0)
    assert largest_value(x, -((x - 3.5) ** 2), jumps=False) == pytest.approx(0.0, abs=1e-12)
    assert roundness(np.diff(-((x - 3.5) ** 2)))[2] == 1.0 and roundness(np.diff(-np.abs(x - 3.5)))[2] == 0.0


def test_tops_extrapolate_by_no_more_than_their_step() -> None:
    """Two samples a hundredth of a step apart, as where a position stands beside the end of a tip-edge zone, the second
    0.1 higher, then a fall: no line rises by more than that 0.1, which would be 10 over a whole step, and the jump that
    it may be goes half of it up."""
    x, y = np.array([0.0, 0.99, 1.0, 2.0, 3.0, 4.0]), np.array([0.0, 1.0, 1.1, 0.9, 0.88, 0.86])
    assert largest_value(x, y, jumps=True) == pytest.approx(1.15)


def test_tops_continue_to_the_middle_of_a_jump() -> None:
    """A curve that falls with slope 1 after a jump somewhere between 2 and 3: continued to the middle; a continuous
    curve cannot. NaN before and after do not matter."""
    x, y = np.arange(8.0), np.array([np.nan, 0.0, 0.0, 5.0, 4.0, 3.0, 2.0, np.nan])
    assert largest_value(x, y, jumps=True) == pytest.approx(5.5)
    assert largest_value(x, y, jumps=False) == 5.0


@pytest.mark.parametrize("n", [12, 20, 40])
def test_missed_peaks_and_bends_bound_the_error_of_waves(n: int) -> None:
    """Triangles and sines with their peaks anywhere between samples: the reach holds the peak, and is not further than
    a step's rise above it. A step of height 1 of any length: the mean is off by at most its bends at both ends."""
    for shift in np.linspace(0.0, 1.0, 11):
        x = (np.arange(n) + shift) / n
        triangle, sine = 2.0 - 4.0 * np.abs(x % 1.0 - 0.5), np.sin(2.0 * np.pi * x)
        for wave, whole in ((triangle, 2.0), (sine, 2.0)):
            missed = whole - np.ptp(wave)
            assert missed <= missed_peaks(wave) + 1e-12 <= missed + 4.0 * np.pi / n
        share = 0.3 + 0.4 * shift
        box = (x % 1.0 < share).astype(float)
        closed = np.concatenate([box[-1:], box, box[:2]])
        assert abs(box.mean() - share) <= np.abs(bends(closed)).sum() * 0.5 / n + 1e-12


def test_thinned_pitch_is_periodic() -> None:
    """Exact: of five positions every other one from the second on is 1, 3 and, round the pitch, 0; the first, between
    neighbours one and two steps away, has 1.5 of the five steps. A constant has no error, whatever is left out."""
    assert every_other(5, 1).tolist() == [0, 1, 3] and every_other(6, 1).tolist() == [1, 3, 5]
    assert shares(every_other(5, 1), 5) == pytest.approx([0.3, 0.3, 0.4])
    for n in range(2, 40):
        assert sum(shares(every_other(n, n - 1), n)) == pytest.approx(1.0)
        assert thinned_mean(np.full(n, 7.0)) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("n", [20, 21, 32, 33, 34, 49, 50, 51])
def test_thinned_mean_has_the_error_of_the_trapezoidal_rule(n: int) -> None:
    """Exact: the mean of a sine over its period is 0, that of a triangle 1/2, from 0 to 1; an odd number of positions
    that is thinned is off by what one even spacing of two steps and one of one leave out, no more than the trapezoidal
    rule's own error of a step (h²/12n of the curvature or h/8n of a kink each), not by a sample's share, 1/n."""
    x, step = np.arange(n) / n, 1.0 / n
    assert thinned_mean(np.sin(2.0 * np.pi * x)) <= (2.0 * np.pi * step) ** 2 * step
    triangle = 2.0 * np.abs((x + 0.3) % 1.0 - 0.5)
    assert thinned_mean(triangle) <= 2.0 * 4.0 * (2.0 * step) ** 2 / 8.0


def test_odd_number_of_positions_has_no_wider_error_bars() -> None:
    """Problem: a made-up pair whose transmission error is a sine. Exact: the mean secant stiffness has next to no
    error, and 21 positions no wider a bar for it than 20."""
    bars = [
        spacing_errors(synthetic_run("contact.friction=0.1", f"sweep.positions={n}"), 0).secant_stiffness_N_per_mm_um
        for n in (20, 21)
    ]
    assert bars[1] <= bars[0]


def test_scatter_of_noise_about_a_parabola() -> None:
    """Noise of 1 % about a parabola with a spike in it: found within a third; none without it."""
    x = np.linspace(-1.0, 1.0, 60)
    smooth = 100.0 - 20.0 * x**2
    noisy = smooth + np.random.default_rng(1).normal(0.0, 1.0, 60)
    noisy[30] += 50.0
    assert scatter(noisy) == pytest.approx(1.0, rel=1.0 / 3.0)
    assert scatter(smooth) < 1e-9


def test_spacing_errors_of_a_plastic_pinion_hold_the_true_error() -> None:
    """Problem: an unrelieved plastic pinion, whose pressure rises by 8 % from one of 20 positions to the next where it
    leaves the tip-edge zone, and whose transmission error has a corner half a degree wide, at quick. Exact: the same
    mesh at 80 positions. Nine in ten of the parts hold the true error, in the median they are up to seven times
    it; at 12 and 20 positions that of the largest pressure is a few per cent, a hundred times what round-off would
    be, and shrinks with more."""
    problem = SpacingProblem("plastic", load_scene(PLASTIC, COARSE))
    rows = measure_spacing(problem, (12, 20), 80)
    assert hit_rate(rows) >= 0.9
    assert np.median([row.bar / row.error for row in rows if row.error]) < 7.0
    shares = [row.bar / row.value for row in rows if row.figure == "max_pressure_MPa"]
    assert 0.4 > shares[0] > shares[-1] > 1e-3


def test_error_bars_sum_mesh_and_spacing(run: RunData) -> None:
    """A run with itself as its companion has no error in its transmission error but what lies between the positions;
    the parts are added, and stand in the figures by themselves without any companion too. The loss has the energy that
    the pitch does not balance besides; the largest pressure lies at the limit of a tip-edge zone and has no bar."""
    (bars,) = estimated_errors(run, Companion(run, "", 0.0)).figures
    (mesh,), spacing = errors_between(run, run), spacing_errors(run, 0)
    assert mesh.transmission_error_peak_to_peak_um == 0.0 < bars.transmission_error_peak_to_peak_um
    unbalanced = 100.0 * pitch_imbalance([each[0].result for each in run.positions])
    summed = summed_errors(mesh, spacing)
    assert engagement(run, 0).peak.at_zone_end and np.isnan(bars.max_pressure_MPa) and unbalanced > 0.0
    assert bars.loss_percent == summed.loss_percent + unbalanced
    known = {"max_pressure_MPa": summed.max_pressure_MPa, "loss_percent": summed.loss_percent}
    assert replace(bars, **known) == summed
    (row,) = friction_rows(run)
    assert row.estimated_error is None and row.spacing_error == spacing


def test_few_positions_are_warned_of(run: RunData) -> None:
    """Without a companion, and with one where most of the bar is the spacing's: the figure, its share and the setting
    that helps; nothing of it where there are enough positions, as on a made-up smooth run."""
    (row,) = friction_rows(run)
    assert row.spacing_error.max_pressure_MPa > SPACING_SAID * row.max_pressure_MPa
    errors = estimated_errors(run, Companion(run, "", 0.0))
    for each, words in ((run, "causes errors"), (replace(run, errors=errors), "most of the error bars")):
        (said,) = [sentence for sentence in warnings_of(each, GOOD) if "sweep.positions" in sentence]
        assert words in said and "MPa of the largest pressure (" in said and "Positions are 1.0° apart" in said
        (alone,) = about_spacing(each, friction_rows(each), ["max_pressure_MPa"])
        assert words in alone and "largest pressure" in alone and alone.count("±") == 1
    smooth = synthetic_run("contact.friction=0.1", "sweep.positions=24")
    assert not any("sweep.positions" in sentence for sentence in warnings_of(smooth, GOOD))


def test_single_position_has_no_spacing_error(run: RunData) -> None:
    """NaN, which is null in summary.json: nothing is known of what lies beside it."""
    alone = spacing_errors(replace(run, positions=run.positions[:1]), 0)
    assert np.isnan(alone.max_pressure_MPa) and np.isnan(alone.loss_percent)


def test_missed_peaks_of_a_sawtooth_between_samples() -> None:
    """Exact: of a sawtooth with corners halfway between samples, half a step's rise and fall is missed at each end;
    where samples meet the corners nothing is, and of a sine hardly anything."""
    x = np.arange(20) / 20.0
    for shift, missed in ((0.5, 0.05), (0.0, 0.0)):
        wave = 1.0 - np.abs(2.0 * ((x + shift / 20.0) % 1.0) - 1.0)  # corners 0 and 1
        assert missed_peaks(wave) == pytest.approx(2.0 * missed, abs=1e-12)
    assert missed_peaks(np.sin(2.0 * np.pi * (x + 0.013))) < 0.2
    assert missed_peaks(x[:4]) == 0.0


def test_few_positions_are_noted_below_pressures() -> None:
    """Problem: a made-up pitch whose pressures three positions cannot follow, and 24 can. Exact: one sentence below 02
    and 03 of the first, with the share that summary.json has as spacing error; none of the second."""
    few, many = (synthetic_run("contact.friction=0.1", f"sweep.positions={n}") for n in (3, 24))
    row = friction_rows(few)[0]
    share = 100.0 * row.spacing_error.max_pressure_MPa / row.max_pressure_MPa
    for draw in (pressure_map, engagement_stress):
        with styled():
            words = [" ".join(text.get_text() for text in draw(each).findobj(Text)) for each in (few, many)]
        assert words[0].count("For orientation only, positions are too few") == 1
        assert f"{share:.1f} % larger" in words[0]
        assert "too few" not in words[1]
