"""Contact stress over the engagement and over friction: what is drawn is what is said."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.error_bar_data import EstimatedErrors, FigureErrors
from evolvent.results.drawing.style import AT_ZONE_END, OVER_KINK, styled
from evolvent.results.engagement import engagement, sign_changes
from evolvent.results.figures.hertz import hertz_comparison
from evolvent.results.figures.stress import engagement_stress
from evolvent.results.figures.trend import friction_trend
from evolvent.results.mesh_facts import few_cells_across
from evolvent.results.relief_kinks import AWAY
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent_meshes.arrays import Floats
from tests.support.synthetic_run import steep_run, synthetic_run

FRICTION = "contact.friction=[0.0, 0.1]"
BAR = 40.0  # [MPa]


@pytest.fixture(scope="module")
def steep() -> RunData:
    """A spur pair whose largest pressure lies between two positions, with an error bar."""
    errors = FigureErrors(BAR, *[1.0] * 6)
    return replace(steep_run(FRICTION), errors=EstimatedErrors((errors, errors), "made up", ""))


def drawn(axes_of: Figure, place: int) -> Floats:
    """All heights of lines and markers in one of a figure's axes."""
    return np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes_of.axes[place].lines])


def legend_of(figure: Figure, place: int = 0) -> list[str]:
    """The words of a legend."""
    legend = figure.axes[place].get_legend()
    assert legend is not None
    return [text.get_text() for text in legend.get_texts()]


def with_cuts(run: RunData, changed: Callable[[Slices, PositionResult], Slices]) -> RunData:
    """The run with other slices."""
    return replace(
        run,
        positions=tuple(
            tuple(replace(each, cut=changed(each.cut, each.result)) for each in position) for position in run.positions
        ),
    )


def with_a_crossing(run: RunData) -> RunData:
    """The run with pressures that friction changes by a share that falls evenly with the tooth's own rotation."""

    def tilted(cut: Slices, result: PositionResult) -> Slices:
        share = 1.0 - result.friction * (result.stand.angle + run.pitch * cut.tooth)
        return replace(cut, peak=share * cut.peak, hertz=share * cut.hertz)

    return with_cuts(run, tilted)


def test_effect_before_the_pitch_point_is_that_of_the_sense_of_rotation() -> None:
    """Problem: friction raises the pressure at φ < 0 and lowers it at φ > 0, by up to a per cent. Exact: it is raised
    before the pitch point where the pinion drives, and as much after it where the wheel does."""
    run = with_a_crossing(synthetic_run(FRICTION, "sweep.positions=40", file="demos/he2022.toml"))
    means = []
    for scene in (run.scene, run.scene.changed("load", driving="wheel")):
        figure = engagement_stress(replace(run, scene=scene))
        (said,) = (text.get_text() for text in figure.texts if "on average" in text.get_text())
        found = re.search(r"by (\S+) % on average before the pitch point, (\S+) % after it", said)
        assert found is not None
        means.append(found.groups())
    assert means[0][0].startswith("+") and means[1] == means[0][::-1]


def test_largest_pressure_is_in_every_picture(steep: RunData) -> None:
    """Problem: the largest pressure lies where a tip-edge zone begins, between two positions. Exact: 03, 05 and 10
    draw it, and say that it lies there."""
    wanted = [row.max_pressure_MPa for row in friction_rows(steep)]
    with styled():
        over_turn, trend, hertz = engagement_stress(steep), friction_trend(steep), hertz_comparison(steep)
    for pressure in wanted:
        assert np.isclose(drawn(over_turn, 0), pressure).any()
        assert np.isclose(drawn(trend, 1), pressure).any()
    assert np.nanmax(drawn(trend, 1)) == pytest.approx(max(wanted))
    assert np.isclose(drawn(hertz, 0), wanted[0]).any()
    assert AT_ZONE_END in legend_of(over_turn) and AT_ZONE_END in legend_of(trend, 4)
    assert f"computed, largest: {AT_ZONE_END}" in legend_of(hertz)


def test_largest_pressure_beside_hertz_has_its_error_bar(steep: RunData) -> None:
    """In 10 the largest pressure has its error bar, among the slices and beside the estimates, and in words."""
    largest = friction_rows(steep)[0].max_pressure_MPa
    with styled():
        along, beside = hertz_comparison(steep).axes[:2]
    for axes, direction in ((along, 1), (beside, 0)):
        ends = np.concatenate([np.ravel(part) for bars in axes.collections for part in bars.get_segments()])
        assert len(ends) == 4 and sorted(ends.reshape(2, 2)[:, direction]) == pytest.approx(
            [largest - BAR, largest + BAR]
        )
    assert any(f"{largest:.0f} ± {BAR:.0f}" == text.get_text() for text in beside.texts)


def test_pressures_over_relief_starts_are_marked_apart() -> None:
    """Problem: a spur pair with linear tip reliefs. Exact: 03 has the largest pressure in its line, with gaps, crosses
    where the contact covers the start of a relief, their name in the legend and the pressure of a sharp kink in words;
    10 has the same slices apart, and the closed form among them and beside the estimates. Both say that the largest
    one is that away from relief starts, and what crosses are worth. The legend of 10 covers no curve."""
    relief = ("pinion.tip_relief_um=20", "wheel.tip_relief_um=20")
    run = synthetic_run("sweep.positions=24", *relief, file="demos/he2022.toml")
    (row,), curve = friction_rows(run), engagement(run, 0)
    with styled():
        over_turn, hertz = engagement_stress(run), hertz_comparison(run)
    known = curve.kink_pressure[np.isfinite(curve.kink_pressure)]
    (crosses,) = [line for line in over_turn.axes[0].lines if line.get_marker() == "x"]
    np.testing.assert_array_equal(np.asarray(crosses.get_ydata())[np.isfinite(curve.kink_pressure)], known)
    assert OVER_KINK in legend_of(over_turn) and f"computed, {OVER_KINK}" in legend_of(hertz)
    assert any(f"{row.kink_pressure_MPa:.0f} MPa (closed form)" in text.get_text() for text in over_turn.texts)
    assert row.max_pressure_MPa == curve.peak.pressure < row.kink_pressure_MPa
    assert over_turn.texts[1].get_text().startswith(f"Largest {AWAY} {row.max_pressure_MPa:.0f} MPa")
    assert {f"computed, largest {AWAY}", f"closed form, {OVER_KINK}"} < set(legend_of(hertz))
    assert np.isclose(drawn(hertz, 0), row.kink_pressure_MPa).any()
    assert f"{row.kink_pressure_MPa:.0f}" in [text.get_text() for text in hertz.axes[1].texts]
    assert all(any("scatter with the mesh" in text.get_text() for text in each.texts) for each in (over_turn, hertz))
    hertz.draw_without_rendering()
    legend = hertz.axes[0].get_legend()
    assert legend is not None and legend.get_window_extent().y1 < hertz.axes[0].get_window_extent().y0


def test_crossing_is_not_given_on_few_cells() -> None:
    """Problem: friction raises the stress before some rotation and lowers it after it; fewer than two elements across
    the contact. Exact: dots and lines have names in the legend of 03, and it is not said where they cross, for the
    scatter of the dots moves that; the same run with contacts twice as wide says where the lines that are drawn
    cross."""
    coarse = with_a_crossing(synthetic_run("sweep.positions=12", "contact.friction=[0.0, 0.2]"))
    fine = with_cuts(coarse, lambda cut, _: replace(cut, half_width=2.0 * cut.half_width))
    assert few_cells_across(coarse) and not few_cells_across(fine)
    with styled():
        figure = engagement_stress(coarse)
        assert "cross" not in figure.texts[1].get_text() + figure.axes[1].get_title()
        assert {"computed", "Hertz × running median"} < set(legend_of(figure))
        figure = engagement_stress(fine)
    assert "computed" not in legend_of(figure)
    low, high = (np.array(line.get_xydata()) for line in figure.axes[1].lines[:2])
    found = sign_changes(low[:, 0], high[:, 1] - low[:, 1])
    nearest = float(found[np.argmin(np.abs(found))])
    said = figure.texts[1].get_text().split("the curves cross at ")[1].split("°")[0]
    assert float(said.replace("−", "-")) == pytest.approx(nearest, abs=0.051)
