"""Evolvent's side of the comparison solves the problem as `solve` of the public API does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evidence.benchmarks.comparison.evolvent_program import problem_of, solved
from evidence.benchmarks.comparison.round_contacts import sphere
from evidence.benchmarks.comparison.task import Push
from evolvent import solve


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_pairs_are_searched_again_where_the_bodies_have_come_to_lie() -> None:
    """A ball is pushed onto a block by more than half a cell: the pairs found with both in overlap do not hold, the
    step is solved twice, and the pressures are those that a user gets."""
    task = replace(sphere(5.0, 1, "hexahedron"), drive=Push(-0.045))
    wanted = solve(problem_of(task))
    assert wanted.searches == 2
    np.testing.assert_array_equal(solved(task).pressure, wanted.contacts[0].pressure)
