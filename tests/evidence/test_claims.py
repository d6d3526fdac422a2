"""Claims tell what holds from what does not, also where the bar is known to be missed."""

from __future__ import annotations

import pytest

from evidence.claims import Claim, analytical, overkill


def claim(found: float, missed: str = "") -> Claim:
    return analytical("Hertz").relative("peak pressure [MPa]", found, 200.0, 0.01, missed)


@pytest.mark.parametrize(
    ("found", "missed", "verdict", "as_expected"),
    [
        (202.0, "", "holds", True),
        (202.1, "", "FAILS", False),
        (float("nan"), "", "FAILS", False),
        (202.1, "small strain", "missed", True),
        (202.0, "small strain", "HOLDS NOW", False),
        (float("nan"), "small strain", "FAILS", False),
    ],
)
def test_claim_tells_misses_from_failures(found: float, missed: str, verdict: str, as_expected: bool) -> None:
    """200 ± 1 %: 202 lies within, 202.1 does not; a known miss has to fail with a number, a NaN never is expected."""
    checked = claim(found, missed)
    assert checked.verdict == verdict
    assert checked.as_expected is as_expected
    assert verdict in str(checked)


def test_bound_allows_its_largest_error() -> None:
    """An error of 0.02 against at most 0.02, and against at most 0.019."""
    assert overkill("h = a/64").bound("profile", 0.02, 0.02).holds
    assert not overkill("h = a/64").bound("profile", 0.02, 0.019).holds


def test_least_value_may_be_exceeded() -> None:
    """An order of 1.9 and one of 3 where at least 2 ± 0.15 is wanted, and one of 1.8."""
    orders = [analytical("theory").at_least("order", found, 2.0, 0.15) for found in (1.9, 3.0, 1.8)]
    assert [order.holds for order in orders] == [True, True, False]
    assert orders[1].error == 0.0
    assert not analytical("theory").at_least("order", float("nan"), 2.0, 0.15).holds


def test_printed_claim_has_error_tolerance_and_source() -> None:
    """The printed line has the error, the tolerance, the kind of reference and its source."""
    line = str(claim(201.0))
    for part in ("found 201", "wanted 200", "± 2", "error 1", "analytical", "Hertz", "holds"):
        assert part in line
