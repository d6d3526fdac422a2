"""How positions and friction coefficients are divided among ranks; that ranks agree is in test_run.py."""

from __future__ import annotations

from itertools import pairwise

import pytest

from solver.gear_sweep import alike
from solver.rank_sweep import division


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20])
@pytest.mark.parametrize("ranks", [1, 2, 3, 4, 9])
def test_every_coefficient_is_solved_once(count: int, ranks: int) -> None:
    """The slices follow one another from 0 to the number of coefficients, one a rank, and differ by one at most."""
    slices = division(count, ranks)
    assert len(slices) == ranks and slices[0].start == 0 and slices[-1].stop == count
    assert all(a.stop == b.start and a.start <= a.stop for a, b in pairwise(slices))
    sizes = [s.stop - s.start for s in slices]
    assert max(sizes) - min(sizes) <= 1


@pytest.mark.parametrize("count", [1, 2, 3, 8, 41])
def test_positions_are_prepared_in_pairs(count: int) -> None:
    """From the first position on every position is prepared once, two at a time but for the first and an odd last one;
    who begins in the middle of a pair, as a resumed run may, ends it there."""
    found, k = [], 0
    while k < count:
        numbers = alike(k, count)
        assert len(numbers) == (1 if k == 0 or k == count - 1 else 2)
        found += list(numbers)
        k = numbers.stop
    assert found == list(range(count))
    assert all(alike(k, count) == range(k, k + 1) for k in range(2, count, 2))
