"""The middle line of contact cells."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np
import pytest

from evolvent.gears.contact.cell_axis import CellAxis, along, cell_length
from evolvent.gears.contact.contact_line import ContactLine
from tests.support.meshes.flanks_in_mesh import TEETH, crowned, line
from tests.support.paper_pairs import yang


@pytest.mark.parametrize("tooth", TEETH)
def test_line_and_width_at_the_nodes(tooth: int) -> None:
    """Exact at limits and middles: the contact line's, and the width of the flank's rows there."""
    axis = CellAxis.of(line(tooth), 0.8)
    assert axis is not None
    arc, width = axis.at(axis.heights)
    assert arc == pytest.approx(line(tooth).arc(axis.heights), abs=1e-12)
    assert width == pytest.approx(line(tooth).row_width(axis.heights), abs=1e-12)


def test_line_between_the_nodes() -> None:
    """Problem: the line of conjugate flanks across the whole face, a parabola in height. Exact: the same."""
    axis = CellAxis.of(line(0), 0.8)
    assert axis is not None
    z = np.linspace(axis.limits[0], axis.limits[-1], 50)
    assert axis.at(z)[0] == pytest.approx(line(0).arc(z), abs=1e-9)


def test_no_axis_out_of_reach() -> None:
    """A tooth pair three pitches away."""
    assert CellAxis.of(line(4), 0.8) is None


@pytest.mark.parametrize("crowning", [0.0, 4.0, 40.0])
def test_length_of_cells(crowning: float) -> None:
    """Problem: rows of 0.1 mm, and a lead crowning of the pinion [µm], curvature κ along the line. Exact: an eighth of
    0.1 mm / √(κ ρ), ρ the relative radius across the line, up to 0.6 modules."""
    pair, found, z = yang(), crowned(crowning), np.zeros(1)
    with patch.object(ContactLine, "row_width", lambda self, z: np.full_like(z, 0.1)):
        length = float(cell_length(found, z)[0])
    radius = float(pair.relative_curvature_radius(found.stand.roll_distance(0, z))[0])
    bend = 8e-3 * crowning / pair.pinion.face_width**2
    bent = 0.125 * 0.1 / np.sqrt(bend * radius) if bend else np.inf
    assert (bent < 0.6 * pair.pinion.normal_module) == (crowning > 0.0)
    assert length == pytest.approx(min(bent, 0.6 * pair.pinion.normal_module), rel=1e-6)


def test_shape_functions_of_an_interval() -> None:
    """The shape functions of start, middle and end: 1 at their own node, and they interpolate y²."""
    y = np.linspace(0.0, 1.0, 7)
    assert along(np.array([0.0, 0.5, 1.0])) == pytest.approx(np.eye(3), abs=1e-14)
    assert along(y) @ np.array([0.0, 0.25, 1.0]) == pytest.approx(y**2, abs=1e-14)
