"""What is counted of a bar between two walls."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.verification.transient.bouncing_bar import Bounces


def test_impacts_flights_and_growth_are_counted() -> None:
    """Flight, two steps at the lower wall, flight, from the upper wall straight to the lower one, flight, upper wall:
    four impacts, three flights that end in one. The energy is least in the second flight, a quarter more in the third,
    and largest, 10 % over that at the start, while the bar touches."""
    touching = np.array([(0, 0), (1, 0), (1, 0), (0, 0), (0, 1), (1, 0), (0, 0), (0, 0), (0, 1)], dtype=bool)
    bounces = Bounces(np.array([1.0, 0.9, 1.1, 0.4, 0.4, 0.4, 0.3, 0.5, 0.5]), touching, 2.0)
    assert bounces.impacts == 4
    number, energy = bounces.in_flight
    assert list(number) == [0.0, 1.0, 3.0] and list(energy) == [1.0, 0.4, 0.5]
    assert bounces.left == 0.5
    assert bounces.growth == pytest.approx(0.1)
    assert bounces.regained == pytest.approx(0.25)
    assert bounces.loss == pytest.approx(0.7)
