"""Figures of a pitch from those of its positions."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.results.position_figures import pitch_loss_percent


def test_loss_of_a_pitch_is_work_over_work() -> None:
    """Lost 1 and 3 of 100 and 300 N·mm: 4 of 400, 1 %, which is not the mean of both ratios where they differ: lost 1
    and 9 of the same are 2.5 %. Of two torques each has its own."""
    assert float(pitch_loss_percent([1.0, 3.0], [100.0, 300.0])) == pytest.approx(1.0)
    lost, given = np.array([[1.0, 1.0], [3.0, 9.0]]), np.array([[100.0, 100.0], [300.0, 300.0]])
    assert pitch_loss_percent(lost, given) == pytest.approx([1.0, 2.5])
