"""Warnings point to the line of the user, whatever function of the packages raises them."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Literal

import pytest

from evolvent import CoarseContactWarning, NearlyIncompressibleWarning, Step, Sweep, solve, sweep
from tests.support.contact_cases import rubber

COARSE = rubber(4.0, 5.0)


@pytest.mark.parametrize(
    "call",
    [lambda: solve(COARSE), lambda: Sweep(COARSE).solve(Step()), lambda: [*sweep(COARSE, [Step()])]],
    ids=["solve", "Sweep", "sweep"],
)
def test_warning_points_to_the_line_of_the_user(call: Callable[[], object]) -> None:
    """Raised at three depths, one of them inside a generator: the line is of this file each time."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    ours = [w for w in caught if issubclass(w.category, CoarseContactWarning | NearlyIncompressibleWarning)]
    assert {w.category for w in ours} == {CoarseContactWarning, NearlyIncompressibleWarning}
    assert {w.filename for w in ours} == {__file__}


def test_every_warning_of_a_loop_is_shown() -> None:
    """The same warning of the same line, twice: with Python's own filters, which show a warning of a line once, both
    are seen; an application that ignores them sees none."""
    cases: tuple[tuple[Literal["default", "ignore"], int], ...] = ("default", 2), ("ignore", 0)
    for action, count in cases:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter(action)
            for _ in range(2):
                solve(COARSE)
        assert sum(issubclass(w.category, CoarseContactWarning) for w in caught) == count
