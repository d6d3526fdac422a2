"""How positions and friction coefficients are divided among ranks; that ranks agree is in test_run.py."""

from __future__ import annotations

from itertools import pairwise

import pytest

from evolvent.gears.sweep.parallel_sweep import division


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20])
@pytest.mark.parametrize("ranks", [1, 2, 3, 4, 9])
def test_every_coefficient_is_solved_once(count: int, ranks: int) -> None:
    """The slices follow one another from 0 to the number of coefficients, one a rank, and differ by one at most."""
    slices = division(count, ranks)
    assert len(slices) == ranks and slices[0].start == 0 and slices[-1].stop == count
    assert all(a.stop == b.start and a.start <= a.stop for a, b in pairwise(slices))
    sizes = [s.stop - s.start for s in slices]
    assert max(sizes) - min(sizes) <= 1
