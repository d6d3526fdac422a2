"""Kills of a study and of its workers at random moments: a short campaign."""

from __future__ import annotations

from pathlib import Path

import pytest

from evidence.robustness.study_kills import killed_at_random, measured


@pytest.mark.evidence
@pytest.mark.slow
def test_kills_at_random_moments(tmp_path: Path) -> None:
    """Three kills of the study, of workers, or of workers that start: the study that is begun again ends, no
    process outlives the one that was killed by ten seconds, and the table is that of a study without kills."""
    outcome = killed_at_random(tmp_path, kills=3, seed=1)
    assert outcome.kills.total() == 3 and outcome.ends
    assert (outcome.hangs, outcome.orphans, outcome.differ) == (0, 0, 0)
    assert [each.holds for each in measured(outcome)] == ["no", "yes", "yes", "yes", "yes"]
