"""Into how many parts the way between two positions is divided."""

from __future__ import annotations

import pytest

from evolvent.dynamics.transient.divided_steps import UNDIVIDED, DividedSteps, StepsTaken, part

RULES = DividedSteps(tolerance=0.01, most_halvings=3)


def test_undivided_steps_always_count() -> None:
    """Whatever their error, and none is halved."""
    assert UNDIVIDED.accepts(0, 1e9)
    assert UNDIVIDED.accepts(0, float("nan"))
    assert not UNDIVIDED.can_halve(0)
    assert UNDIVIDED.after(0, 0.0, 5.0) == 0


def test_errors_above_the_tolerance_count_for_the_shortest_step_alone() -> None:
    """Of eighths at most; an error that is no number does not count either."""
    assert RULES.accepts(0, 0.01)
    assert not RULES.accepts(2, 0.0101)
    assert not RULES.accepts(2, float("nan"))
    assert RULES.accepts(3, 0.0101)
    assert [RULES.can_halve(k) for k in range(4)] == [True, True, True, False]


@pytest.mark.parametrize(("halvings", "error", "reached", "wanted"), [
    (2, 0.0012, 7.5, 1),  # two quarters have been gone
    (2, 0.0012, 7.25, 2),  # the next quarter is the second of a half
    (1, 0.0012, 8.0, 0),
    (1, 0.0012, 7.5, 1),
    (0, 0.0, 8.0, 0),
    (2, 0.0013, 7.5, 2),  # four times as much is more than half the tolerance
    (3, 0.02, 7.5, 3),
])
def test_steps_grow_where_errors_are_small(halvings: int, error: float, reached: float, wanted: int) -> None:
    """By one halving, below an eighth of the tolerance, at multiples of the longer step."""
    assert RULES.after(halvings, error, reached) == wanted


def test_any_errors_end_at_the_positions() -> None:
    """Lengths that go down at some steps and up wherever they may: every whole position is reached exactly."""
    reached, halvings, ends = 0.0, 0, []
    for n in range(2000):
        halvings = min(halvings + (n * n) % 3 % 2, 3)
        assert reached % part(halvings) == 0.0
        reached += part(halvings)
        ends.append(reached)
        halvings = RULES.after(halvings, 0.0, reached)
    assert set(range(1, int(reached) + 1)) <= set(ends)
    assert len(ends) > 1.5 * reached


def test_steps_are_joined() -> None:
    """Numbers and impulses add up, the shortest, the largest error and force, the lowest transmission error stay."""
    found = StepsTaken.joined([
        StepsTaken(1, 2, 0.25, 0.1, 3.0, 12.0, -0.5), StepsTaken(3, 0, 0.125, 0.01, 4.0, 8.0, 0.5)
    ])
    assert found == StepsTaken(4, 2, 0.125, 0.1, 7.0, 12.0, -0.5)
