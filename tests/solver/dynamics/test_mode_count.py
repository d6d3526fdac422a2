"""The number of natural modes that is expected of a gear, against those that its finite elements have."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.mode_count import expected_modes
from evolvent.dynamics.modes.gear_modes import ModeChoice, gear_modes
from tests.solver.dynamics.modes.test_ring_modes import bodies


@pytest.mark.parametrize("highest", [40e3, 60e3])
def test_number_of_modes_of_a_spur_gear(highest: float) -> None:
    """He's pinion in plane strain, all modes up to a frequency [Hz]: as expected, to a third or two modes."""
    body = bodies("spur")[0]
    elastic = body.material.youngs_modulus, body.material.poissons_ratio
    count = gear_modes(body, ModeChoice(2.0 * np.pi * highest)).count
    assert expected_modes(body.gear, elastic, 7.85e-9, highest, True) == pytest.approx(count, rel=1 / 3, abs=2)


def test_many_modes_go_with_area_and_volume() -> None:
    """At ten times a high frequency there are a hundred times as many modes in plane strain, a thousand in space, to
    10 %: Weyl's law."""
    body = bodies("spur")[0]
    for plane, times in ((True, 100.0), (False, 1000.0)):
        few, many = (expected_modes(body.gear, (2.1e5, 0.3), 7.85e-9, f, plane) for f in (5e6, 5e7))
        assert many / few == pytest.approx(times, rel=0.1)
