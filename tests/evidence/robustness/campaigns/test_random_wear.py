"""Random wear studies with K/H and depths beyond all measure. `make stress` runs 100; these are a seeded sample."""

from __future__ import annotations

from dataclasses import replace

import pytest

from evidence.robustness.campaigns import wear_outcomes
from evidence.robustness.campaigns.random_wear import BodyStudy, random_study
from evidence.robustness.campaigns.summaries import wear_summary
from evidence.robustness.campaigns.wear_outcomes import WearOutcome, WearVerdict, wear_outcome_of
from evolvent.scene.scene import Scene
from evolvent.wear import body_study
from evolvent.wear.archard import DepthProjection
from evolvent.wear.block_stepping import WearStopped
from evolvent.wear.gears import gear_wear
from evolvent.wear.gears.flank_grid import FlankGrid
from tests.support.running.samples import sampled

SAID = {WearVerdict.FINISHED, WearVerdict.STOPPED}
GEARS, BODIES = 23, 27


@pytest.mark.parametrize("seed", sampled([6, 18, 32, 38, 55, 75]))
def test_accepted_wear_states_hold(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every state that is accepted holds, and who stops says why."""
    monkeypatch.setattr(wear_outcomes, "BLOCKS", 8)
    outcome = wear_outcome_of(random_study(seed), seed)
    assert outcome.verdict in SAID, outcome
    assert outcome.blocks > 0


def test_a_seed_is_one_study() -> None:
    """The same every time."""
    one, again = random_study(GEARS), random_study(GEARS)
    assert isinstance(one, Scene) and one == again
    one, again = random_study(BODIES), random_study(BODIES)
    assert isinstance(one, BodyStudy) and isinstance(again, BodyStudy)
    assert (one.law, one.settings, one.cycles) == (again.law, again.settings, again.cycles)


@pytest.mark.parametrize("seed", [GEARS, BODIES])
def test_lost_volume_is_seen(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A thousandth less at every node: the study's own certificate stops it, and without that the outcome is wrong."""
    depth, gathered = DepthProjection.depth, FlankGrid.depths_from_volumes
    monkeypatch.setattr(DepthProjection, "depth", lambda *given: 0.999 * depth(*given))
    monkeypatch.setattr(FlankGrid, "depths_from_volumes", lambda *given: 0.999 * gathered(*given))
    stopped = wear_outcome_of(random_study(seed), seed)
    assert stopped.verdict is WearVerdict.STOPPED and "VolumeLost" in stopped.message
    for module in (gear_wear, body_study):
        monkeypatch.setattr(module, "certify_volume", lambda *_: None)
    wrong = wear_outcome_of(random_study(seed), seed)
    assert wrong.verdict is WearVerdict.WRONG and "volume" in wrong.message


def test_stop_without_a_reason_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stop without a word is wrong, any other error is a crash."""
    drawn = random_study(BODIES)

    def raising(error: Exception) -> WearVerdict:
        def broken(*_: object) -> None:
            raise error

        monkeypatch.setattr(wear_outcomes, "WearStudy", broken)
        return wear_outcome_of(drawn, BODIES).verdict

    assert raising(WearStopped("wanted wear, found none; rub")) is WearVerdict.STOPPED
    assert raising(WearStopped("no")) is WearVerdict.WRONG
    assert raising(ZeroDivisionError("no")) is WearVerdict.CRASHED


def test_wear_summary_counts_every_outcome() -> None:
    """Every outcome is counted under its kind, and every stop has its line."""
    good = WearOutcome(0, WearVerdict.FINISHED, "", "gears", 1e-9, 3)
    text = wear_summary([good, replace(good, seed=1, verdict=WearVerdict.STOPPED, message="WearStopped: no more")])
    assert "| finished | 1 |" in text and "| 1 | gears | stopped, with a message | WearStopped: no more |" in text
