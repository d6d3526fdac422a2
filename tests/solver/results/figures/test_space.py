"""Rendered views: colours on a flank are those of the colour bar."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.results.drawing.offscreen import off_screen
from evolvent.results.drawing.style import PRESSURE_MAP
from evolvent.results.fields.flank_field import flank_patch
from evolvent.results.figures.scene3d import flank_picture
from evolvent.results.figures.space import _largest
from evolvent.results.tables.figure_rows import position_row
from evolvent_meshes.gears.member import Member
from tests.support.synthetic_run import synthetic_run

LEVELS = 3.0  # of 255 by which the graphics driver may round a colour


@pytest.mark.parametrize("gear", Member)
def test_colours_are_those_of_the_bar(gear: Member) -> None:
    """Problem: the same value all over the flanks of a gear. Exact: each pixel that shows a flank, and so differs
    between two values, has the colour that the bar has at the value; at the flanks' rims pixels are mixed."""
    run = synthetic_run(file="demos/he2022.toml")
    result, patch = run.positions[0][0].result, flank_patch(run, gear, (60, 20))
    with off_screen():
        shown = {
            share: flank_picture(run, result, patch, np.full((60, 20), 1000.0 * share), 1000.0, (400, 300))
            for share in (0.25, 0.8)
        }
    flank = (shown[0.25] != shown[0.8]).any(axis=-1)
    assert flank.mean() > 0.05
    for share, image in shown.items():
        wanted = 255.0 * np.array(PRESSURE_MAP(share)[:3])
        off = np.abs(image[flank].astype(float) - wanted).max(axis=1)
        assert (off <= LEVELS).mean() > 0.9


def test_pressure_over_a_relief_start_is_named_apart() -> None:
    """A position of which one tooth presses with 900 MPa over a kink: its title says so beside the largest pressure
    elsewhere. Without kinks there is the largest pressure alone, and nothing where none is known."""
    run = synthetic_run(file="demos/he2022.toml")
    row = replace(position_row(run, run.positions[0][0]), max_pressure_MPa=226.0, kink_pressure_MPa=0.0)
    assert _largest(row) == ", at most 226 MPa at this position"
    both = replace(row, kink_pressure_MPa=900.0)
    assert _largest(both) == ", 900 MPa over the start of a linear relief, at most 226 MPa elsewhere"
    assert _largest(replace(row, max_pressure_MPa=np.nan)) == ""
