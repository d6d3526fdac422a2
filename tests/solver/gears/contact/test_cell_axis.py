"""The middle line of contact cells."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.contact.cell_axis import CellAxis, along
from tests.support.meshes.flanks_in_mesh import TEETH, line


@pytest.mark.parametrize("tooth", TEETH)
def test_line_and_width_at_the_nodes(tooth: int) -> None:
    """Exact at limits and middles: the contact line's, and the width of the flank's rows there."""
    axis = CellAxis.of(line(tooth))
    assert axis is not None
    arc, width = axis.at(axis.heights)
    assert arc == pytest.approx(line(tooth).arc(axis.heights), abs=1e-12)
    assert width == pytest.approx(line(tooth).row_width(axis.heights), abs=1e-12)


def test_line_between_the_nodes() -> None:
    """Problem: the line of conjugate flanks across the whole face, a parabola in height. Exact: the same."""
    axis = CellAxis.of(line(0))
    assert axis is not None
    z = np.linspace(axis.limits[0], axis.limits[-1], 50)
    assert axis.at(z)[0] == pytest.approx(line(0).arc(z), abs=1e-9)


def test_no_axis_out_of_reach() -> None:
    """A tooth pair three pitches away."""
    assert CellAxis.of(line(4)) is None


def test_shape_functions_of_an_interval() -> None:
    """The shape functions of start, middle and end: 1 at their own node, and they interpolate y²."""
    y = np.linspace(0.0, 1.0, 7)
    assert along(np.array([0.0, 0.5, 1.0])) == pytest.approx(np.eye(3), abs=1e-14)
    assert along(y) @ np.array([0.0, 0.25, 1.0]) == pytest.approx(y**2, abs=1e-14)
