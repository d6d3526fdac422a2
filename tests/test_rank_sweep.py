"""How friction coefficients are divided among ranks; that ranks agree is in test_run.py."""

from __future__ import annotations

from itertools import pairwise

import pytest

from solver.rank_sweep import AHEAD, division


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20])
@pytest.mark.parametrize("ranks", [1, 2, 3, 4, 9])
def test_every_coefficient_is_solved_once(count: int, ranks: int) -> None:
    """The slices follow one another from 0 to the number of coefficients, one for each rank."""
    slices = division(count, ranks)
    assert len(slices) == ranks and slices[0].start == 0 and slices[-1].stop == count
    assert all(a.stop == b.start and a.start <= a.stop for a, b in pairwise(slices))


@pytest.mark.parametrize("ranks", [2, 3, 4])
def test_work_is_even(ranks: int) -> None:
    """20 coefficients: no rank has more than one above the average, working ahead counted with rank 0's."""
    slices = division(20, ranks)
    loads = [s.stop - s.start + (AHEAD if rank == 0 else 0) for rank, s in enumerate(slices)]
    assert max(loads) <= (20 + AHEAD) / ranks + 1
