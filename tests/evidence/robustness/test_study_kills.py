"""Kills of a study and of its workers at random moments: a short campaign."""

from __future__ import annotations

from pathlib import Path

import pytest

from evidence.robustness.study_kills import differing, killed_at_random, measured


@pytest.mark.evidence
@pytest.mark.slow
def test_kills_at_random_moments(tmp_path: Path) -> None:
    """Three kills of the study, of workers, or of workers that start: the study that is begun again ends, no
    process outlives the one that was killed by ten seconds, and the table is that of a study without kills."""
    outcome = killed_at_random(tmp_path, kills=3, seed=1)
    assert outcome.kills.total() == 3 and outcome.ends
    assert (outcome.hangs, outcome.orphans, outcome.differ) == (0, 0, 0)
    assert [each.holds for each in measured(outcome)] == ["no", *["yes"] * 5]


def test_a_table_differs_by_more_than_rounding() -> None:
    """A relative difference of 1e-9 is that of two runs; 1e-6, another status and a missing row are not."""
    row = {"status": "done", "stress_MPa": "123.456789"}
    assert not differing([row], [{**row, "stress_MPa": "123.45678912"}])
    for other in ({**row, "stress_MPa": "123.4569"}, {**row, "status": "failed"}, {**row, "stress_MPa": ""}):
        assert len(differing([row], [other])) == 1
    assert len(differing([], [row])) == 1
