"""Transmission error, line load and sliding: nothing is cut off without a mark, nothing is said twice."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.results.archive.error_bar_data import EstimatedErrors, FigureErrors
from evolvent.results.drawing.style import styled
from evolvent.results.figures.drive import MOST_SLIDING, line_load, transmission_error
from evolvent.results.run_data import RunData
from tests.support.synthetic_run import synthetic_run

YANG = "demos/yang2022.toml"


def sliding_of(run: RunData) -> tuple[Axes, Axes]:
    """The axes of 12: line load, sliding."""
    with styled():
        figure = line_load(run)
    FigureCanvasAgg(figure).draw()
    return figure.axes[0], figure.axes[1]


def test_line_load_shows_every_slice() -> None:
    """Every slice of 12, also one on a tip edge beyond the path of contact of rigid flanks, lies within the axes by
    half of its mark. Problem: they are moved out by a millimetre, as deflected teeth meet early."""
    run = synthetic_run("contact.friction=[0.0, 0.1]", file=YANG)

    def further(cut: Slices) -> Slices:
        return replace(cut, roll_distance=cut.roll_distance + np.where(cut.edge, np.sign(cut.roll_distance), 0.0))

    wide = tuple(tuple(replace(each, cut=further(each.cut)) for each in position) for position in run.positions)
    upper, _ = sliding_of(replace(run, positions=wide))
    inside = upper.get_window_extent()
    for line in upper.lines[:2]:
        x = upper.transData.transform(line.get_xydata())[:, 0]
        assert inside.x0 + 3.0 < x.min() and x.max() < inside.x1 - 3.0


def test_sliding_is_drawn_completely() -> None:
    """Exact: Yang's pinion slides by −4.4 at A, and the axes of 12 go further."""
    _, lower = sliding_of(synthetic_run("contact.friction=[0.0, 0.1]", file=YANG))
    least = min(float(np.min(line.get_ydata())) for line in lower.lines[:2])
    assert -5.0 < least < -4.2 and lower.get_ylim()[0] < least
    assert not lower.texts


def test_sliding_beyond_the_axes_is_marked() -> None:
    """Problem: a pinion of 16 teeth, whose path of contact begins near its base circle. Exact: specific sliding
    falls to −10.4 there; the axes end a little below the bound, and the value stands there."""
    small = ["pinion.teeth=16", "pinion.bore_diameter_mm=15", "contact.friction=0.0"]
    _, lower = sliding_of(synthetic_run(*small, file="demos/first_pair.toml"))
    least = float(np.min(lower.lines[0].get_ydata()))
    assert least < -MOST_SLIDING and -1.2 * MOST_SLIDING < lower.get_ylim()[0] < -MOST_SLIDING
    (mark,) = lower.texts
    assert mark.get_text() == f"−{-least:.1f} at the end"


@pytest.mark.parametrize("bar", [0.35, np.nan])
def test_peak_to_peak_transmission_error_is_given_once(bar: float) -> None:
    """In 09 the peak to peak of a coefficient stands in the line below the title alone, and what may lie between the
    positions in one sentence, as a part of the error bar where there is one; the legend takes none of the width."""
    run = synthetic_run("contact.friction=[0.0, 0.1, 0.2]", file=YANG)
    if np.isfinite(bar):
        run = replace(run, errors=EstimatedErrors((FigureErrors(*[bar] * 7),) * 3, "made up", ""))
    with styled():
        figure = transmission_error(run)
        FigureCanvasAgg(figure).draw()
    size = figure.texts[1].get_text().split("Peak to peak ")[1].split(" ")[0]
    words = [text.get_text() for text in figure.findobj(Text)]
    assert sum(size in text for text in words) == 1
    (below,) = (text for text in words if "positions" in text)
    assert ("error bar" in below) == bool(np.isfinite(bar)) and ("more" in below) == bool(np.isnan(bar))
    assert figure.axes[0].get_window_extent().width > 0.85 * figure.bbox.width
