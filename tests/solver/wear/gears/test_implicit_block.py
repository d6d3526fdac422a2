"""An implicit block of a gear pair: its linear equations, with responses as matrices and as products."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.wear.archard import Archard
from evolvent.wear.gears import implicit_block
from evolvent.wear.gears.gear_wear import GearWear
from evolvent.wear.gears.implicit_block import PositionResponse
from evolvent.wear.gears.pitch_state import PitchState
from tests.support.gear_cases import model_of, spur_scene

LENGTH = 4e5  # cycles, in which many points would pull


@cache
def fresh() -> tuple[GearWear, PitchState]:
    """He's pair, new."""
    model = model_of(spur_scene("mesh.level=quick"))
    gears = GearWear(model, uniform_pitch(model.pair.pinion.z, 6), 0.0, Archard(1.4e-10, 0.7e-10), MPI.COMM_SELF)
    return gears, gears.evaluate(gears.begin)


def test_pressure_response_as_matrix_and_as_product() -> None:
    """R times an opening is the same by the matrix and by the product, to rounding; points that have left the contact
    keep no pressure for any opening."""
    now = fresh()[1]
    whole = PositionResponse.of(now.shared[0], now.points[0])
    pulled = np.arange(len(whole.separating)) % 3 == 0
    for response in (whole, whole.without(pulled)):
        opening = 1e-3 * np.cos(np.arange(len(response.separating)))
        product = response(opening)
        np.testing.assert_allclose(response.matrix @ opening, product, atol=1e-10 * np.abs(product).max())
        assert np.abs(response.matrix[response.separating]).max(initial=0.0) < 1e-12 * np.abs(response.matrix).max()
    left = whole.without(pulled)
    np.testing.assert_allclose(left.separation[pulled], -left.points.pressure[pulled], rtol=1e-12)


def test_implicit_block_by_matrices_and_by_products(monkeypatch: pytest.MonkeyPatch) -> None:
    """An implicit block is the same within the tolerance of GMRES whether responses are stored as matrices or not."""
    gears, now = fresh()
    few, _ = gears.implicit_block(gears.begin, now, LENGTH)
    monkeypatch.setattr(implicit_block, "SMALL", 0)
    many, _ = gears.implicit_block(gears.begin, now, LENGTH)
    np.testing.assert_allclose(few, many, atol=1e-5 * few.max())


def test_long_implicit_block_has_no_negative_depth() -> None:
    """Problem: 4e5 cycles at once, after which linearised pressures of many points would be negative. Exact: no depth
    is negative, and the depths are those of the pressures at the block's end, by solving the pitch there, within a
    fifth of the volume."""
    gears, now = fresh()
    depth, end = gears.implicit_block(gears.begin, now, LENGTH)
    assert depth.min() >= 0.0
    wrong = gears.areas @ np.abs(depth - LENGTH * end.rate)
    assert wrong < 0.2 * gears.areas @ depth
