"""Random vibrating pairs, each over all its speeds. `make stress` sweeps 200; these are a seeded sample."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evidence.robustness.campaigns import drive_outcomes, motion_checks
from evidence.robustness.campaigns.drive_outcomes import DriveOutcome, DriveVerdict, drive_outcome_of
from evidence.robustness.campaigns.drive_summaries import drive_summary
from evidence.robustness.campaigns.random_drives import RandomDrive, random_drive
from evolvent.dynamics.oscillator.mesh_law import Jammed
from evolvent.dynamics.oscillator.steady_state import NoSteadyState, Scales, SteadyState
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent_meshes.arrays import Bools, Floats
from tests.support.running.samples import sampled

SEEDS = (2, 6, 7, 13, 25)
"""Of forces F(x, φ) and k x, sudden steps, folds, free flight, and blows on both sides."""
FEW = 12


def few_speeds(seed: int) -> RandomDrive:
    """The drive of a seed at a few of its speeds."""
    drawn = random_drive(seed)
    return replace(drawn, periods=drawn.periods[np.linspace(0, len(drawn.periods) - 1, FEW).astype(int)])


@pytest.mark.parametrize("seed", sampled(SEEDS))
def test_every_motion_is_verified(seed: int) -> None:
    """All motions, the unstable ones too, come back to themselves by SciPy's integrator, with balanced energy."""
    outcome = drive_outcome_of(few_speeds(seed), seed)
    assert outcome.verdict is DriveVerdict.VERIFIED, outcome
    assert outcome.states >= FEW and not outcome.lost


def test_a_seed_is_one_drive() -> None:
    """The same every time; another seed is another one."""
    one, again, other = random_drive(3), random_drive(3), random_drive(4)
    assert (one.periods == again.periods).all() and one.drive.model.mass == again.drive.model.mass
    assert (one.drive.model.law.front.force == again.drive.model.law.front.force).all()
    assert other.drive.model.mass != one.drive.model.mass


def test_wrong_motions_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Steady states with a velocity that is 1e-5 off come back elsewhere; a mesh force that is up to a thousandth off,
    varying with the mesh, does not balance."""
    drawn = few_speeds(7)
    wrong_by = np.array([0.0, 1e-5 * Scales.of(drawn.drive.model).velocity])
    right = SteadyState.__init__

    def off(self: SteadyState, period: float, state: Floats, derivatives: Floats) -> None:
        right(self, period, state + wrong_by, derivatives)

    with monkeypatch.context() as patch:
        patch.setattr(SteadyState, "__init__", off)
        outcome = drive_outcome_of(drawn, 7)
    assert outcome.verdict is DriveVerdict.WRONG and "motion after its period" in outcome.message
    mesh = motion_checks._mesh

    def stronger(model: TorsionalModel, period: float, phases: Floats, s: Floats) -> tuple[Floats, Floats, Bools]:
        force, rate, touching = mesh(model, period, phases, s)
        return force * (1.0 + 1e-3 * np.cos(2.0 * np.pi * phases)), rate, touching

    monkeypatch.setattr(motion_checks, "_mesh", stronger)
    outcome = drive_outcome_of(drawn, 7)
    assert outcome.verdict is DriveVerdict.WRONG and "energy of a period" in outcome.message


def test_outcomes_tell_refusals_from_crashes(monkeypatch: pytest.MonkeyPatch) -> None:
    """An error that a user is told is a refusal, any other a crash."""
    drawn = few_speeds(7)

    def raising(error: Exception) -> DriveVerdict:
        def broken(*_: object) -> None:
            raise error

        monkeypatch.setattr(drive_outcomes, "sweep_speeds", broken)
        return drive_outcome_of(drawn, 7).verdict

    assert raising(NoSteadyState("no")) is raising(Jammed(1.0)) is DriveVerdict.REFUSED
    assert raising(ZeroDivisionError("no")) is DriveVerdict.CRASHED


def test_drive_summary_counts_every_outcome() -> None:
    """Every outcome is counted, and every bad one has its line."""
    good = DriveOutcome(0, DriveVerdict.VERIFIED, "", "steps, tangent", states=3, returned=1e-9, scaled=1e-9)
    bad = replace(good, seed=1, verdict=DriveVerdict.REFUSED, message="NoSteadyState: no", states=0)
    text = drive_summary([good, bad])
    assert "| verified | 1 |" in text and "| 1 | steps, tangent | refused, with a message | NoSteadyState: no |" in text
