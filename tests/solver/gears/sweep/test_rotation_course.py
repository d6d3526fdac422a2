"""Prediction of the free rotation from position to position."""

from __future__ import annotations

import pytest

from evolvent.gears.sweep.rotation_course import RotationCourse


def test_rotation_that_changes_steadily_is_predicted_exactly() -> None:
    """A rotation 0.1 + 0.3 φ of one gear and −0.2 φ of the other, known at 0.5 and 0.7: exact anywhere; known at one
    angle, it is taken to stay."""
    one = RotationCourse(0.5, (0.25, -0.1))
    assert one.at(0.8) == (0.25, -0.1)
    two = one.followed_by(0.7, (0.31, -0.14))
    assert two.at(1.1) == pytest.approx((0.43, -0.22), rel=1e-12)
    assert two.followed_by(0.7, (0.31, -0.14)).at(1.1) == pytest.approx((0.43, -0.22), rel=1e-12)
