"""Clipping by convex windows and triangulation: areas of polygons by hand."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.contact.search.clipping import clip, fan


def test_clipped_triangles_fill_the_polygon() -> None:
    """The unit square cut by a triangle: the fan's areas sum to the known overlap; a point outside leaves nothing.

    Triangle (0.5, 0.5), (2, 0.5), (0.5, 2) and the square share the square of side 0.5: area 0.25.
    """
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    windows = np.array([[[0.5, 0.5], [2, 0.5], [0.5, 2]], [[3, 3], [4, 3], [3, 4]]], float)
    polygons, count = clip(np.stack([square, square]), np.array([4, 4]), windows)
    owner, triangles = fan(polygons, count)
    area = 0.5 * np.linalg.det(triangles[:, 1:] - triangles[:, :1])
    assert np.bincount(owner, area, minlength=2) == pytest.approx([0.25, 0.0])


def test_fan_does_not_depend_on_the_first_corner() -> None:
    """A rectangle, listed from each of its corners and moved by round-off: the same two triangles."""
    corners = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]])
    found = []
    for first in range(4):
        turned = np.roll(corners, first, axis=0) + 1e-15 * np.arange(8).reshape(4, 2)
        _, triangles = fan(turned[None], np.array([4]))
        found.append(sorted(tuple(sorted(map(tuple, np.round(t, 9).tolist()))) for t in triangles))
    assert all(cut == found[0] for cut in found[1:])


def test_fan_of_a_dented_polygon_overlaps_nowhere() -> None:
    """A square with one dented side: the apex is chosen so that no triangle has negative area; they sum to 0.95."""
    dented = np.array([[[0, 0], [0.5, 0.1], [1, 0], [1, 1], [0, 1]]], float)
    for turn in range(5):
        _, triangles = fan(np.roll(dented, turn, axis=1), np.array([5]))
        area = 0.5 * np.linalg.det(triangles[:, 1:] - triangles[:, :1])
        assert area.min() > 0
        assert area.sum() == pytest.approx(0.95)
