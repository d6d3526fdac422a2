"""Figures of one mesh passage."""

from __future__ import annotations

from matplotlib.backends.backend_agg import FigureCanvasAgg

from evolvent.results.drawing.style import styled
from evolvent.wear.results.mesh_passage import PointPassage
from evolvent.wear.results.passage_figures import point_in_contact
from tests.support.gear_wear_cases import he_run

A = 77.0  # mm, point A of He et al. 2022


def test_legend_of_the_point_passage_is_beside_its_curves() -> None:
    """Point A's stress over its rotation: no point of a curve lies behind the legend."""
    with styled():
        figure = point_in_contact(PointPassage.of(he_run(), A))
    FigureCanvasAgg(figure).draw()
    axes = figure.axes[0]
    box = axes.get_legend().get_window_extent()
    for line in axes.lines:
        assert not any(box.contains(*point) for point in axes.transData.transform(line.get_xydata()))
