"""The positions of a scene: solved one after the other, certified before they are stored.

Problem: He's spur pair in plane strain, three positions of a pitch.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evidence.calls import temporary_call
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.solution import certificates
from evolvent.gears.solution.certificates import BalanceError, PitchImbalance
from evolvent.results.archive.store import ArchiveError
from evolvent.run.call import Call, Options
from evolvent.run.kept_pitch import COMPANION, OWN, friction_groups, kept_pitch, resume_point
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member
from tests.support.computing.interruption import Interrupted, interrupted
from tests.support.gear_cases import helical_scene, spur_scene
from tests.support.running.patches import calling_first


@pytest.fixture
def prepared() -> list[int]:
    """One entry for each time that the gears are condensed."""
    return []


@pytest.fixture
def call(tmp_path: Path, prepared: list[int]) -> Iterator[Call]:
    """A call on this rank alone."""
    with temporary_call(tmp_path, counting(prepared)) as made:
        yield made


def counting(prepared: list[int]) -> Options:
    """Options of a call that counts how often the gears are condensed."""
    counted = calling_first(prepare_model, lambda *_, **__: prepared.append(len(prepared)))
    return Options(quiet=True, prepare=counted)


def resumed(call: Call) -> Call:
    """The call, which goes on from what is stored."""
    return replace(call, options=replace(call.options, resume=True))


def scene_of(*settings: str) -> Scene:
    return spur_scene("mesh.level=quick", "sweep.positions=3", *settings)


def test_pitch_has_its_positions_in_order(call: Call) -> None:
    """Three equal steps of the angular pitch, of which only the last closes it; each is stored with the state after
    it, from which the next one starts."""
    scene = scene_of("contact.friction=0.2")
    pitch = kept_pitch(call, scene)
    stored = pitch.archive.read_sweep(scene.gear_pair())
    assert [position.closes for position in stored] == [False] * (len(stored) - 1) + [True]
    step = 2.0 * np.pi / scene.pinion.teeth / 3
    assert [each.angle for each in pitch.solved.positions] == [step * k for k in range(3)]
    last, state = stored[-1].state, pitch.archive.read_state(scene.gear_pair())
    assert state is not None and last.beyond_nominal == state.beyond_nominal
    assert last.histories[0] is not None and state.histories[0] is not None
    assert np.array_equal(last.histories[0].flux, state.histories[0].flux)


def test_pitch_of_a_driving_wheel_is_resumed(call: Call, tmp_path: Path) -> None:
    """Where the wheel drives, positions are solved and stored by descending angle, and reported by ascending one. A
    pitch interrupted after its second position and resumed is that of one call, 1e-8 of each transmission error, and
    its friction power is positive as stored; in the scene where the pinion drives its folder is refused."""
    scene, pair = scene_of("contact.friction=0.3", "load.driving=wheel"), spur_scene().gear_pair()
    with temporary_call(tmp_path / "whole") as other:
        whole = kept_pitch(other, scene)
    with interrupted(2 + 2 * 2), pytest.raises(Interrupted):  # gears, then a position and its state each
        kept_pitch(call, scene)
    found = kept_pitch(resumed(call), scene)
    swept = found.archive.read_sweep(pair)
    assert [each.angle for each in swept[:3]] == sorted((each.angle for each in swept[:3]), reverse=True)
    for pitch in (found, whole):
        assert [each.angle for each in pitch.solved.positions] == sorted(each.angle for each in swept[:3])
    for one, exact in zip(found.archive.read_positions(pair), whole.solved.positions):
        assert one.results[0].transmission_error == pytest.approx(exact.results[0].transmission_error, rel=1e-8)
        assert one.results[0].driving is Member.WHEEL and one.results[0].friction_loss > -1e-9
    with pytest.raises(ArchiveError, match=r'load\.driving = "pinion" \(kept: "wheel"\)'):
        resume_point(resumed(call), scene_of("contact.friction=0.3"), OWN)


def test_solved_pitch_is_resumed_at_its_end(call: Call, prepared: list[int]) -> None:
    """All positions are stored; resumed there, the gears are not condensed again and no time is spent."""
    scene = scene_of("contact.friction=0.0")
    pitch = kept_pitch(call, scene)
    assert pitch.timings.positions > 0.0 and pitch.timings.total > pitch.timings.factor > 0.0
    end = resume_point(resumed(call), scene, OWN)
    assert end.is_end and len(end.positions) == 3
    again = kept_pitch(resumed(call), scene)
    assert len(prepared) == 1 and again.timings.total == 0.0


def test_position_out_of_balance_is_not_stored(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    """A position that fails its certificate is raised as BalanceError before it is stored."""
    monkeypatch.setattr(certificates, "STORED_LIMIT", -1.0)
    scene = scene_of("contact.friction=0.0")
    with pytest.raises(BalanceError, match="wanted a balance error of at most"):
        kept_pitch(call, scene)
    assert not resume_point(resumed(call), scene, OWN).positions


def test_finished_friction_groups_are_not_solved_again(call: Call, prepared: list[int]) -> None:
    """Coefficients with gears of their own, resumed at their end: no gear is condensed again."""
    scene = scene_of("contact.friction=[0.0, 0.2]", "exact.parts=reuse")
    kept_pitch(call, scene)
    assert len(prepared) == 2
    again = kept_pitch(resumed(call), scene)
    assert len(prepared) == 2 and again.timings.total == 0.0


def test_unbalanced_pitch_is_solved_again_on_the_same_gears(
    call: Call, prepared: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Energy that no pitch can balance: solved once more on deflected flanks, with the gears condensed once."""
    monkeypatch.setattr(certificates, "BALANCE_LIMIT", -1.0)
    with pytest.raises(PitchImbalance, match="wanted an energy balance within"):
        kept_pitch(call, scene_of("contact.friction=0.0"))
    assert len(prepared) == 1
    assert "solved again, on deflected flanks" in (call.folder.out / "run.log").read_text(encoding="utf-8")


def test_friction_coefficients_in_groups_give_the_same_pitch(tmp_path: Path, prepared: list[int]) -> None:
    """Two coefficients, each solved with gears of its own: the transmission errors of both together within 1e-8."""
    errors = []
    for name, settings in (("together", ()), ("alone", ("exact.parts=reuse",))):
        scene = scene_of("contact.friction=[0.0, 0.2]", *settings)
        with temporary_call(tmp_path / name, counting(prepared)) as call:
            swept = kept_pitch(call, scene).solved.positions
        errors.append([result.transmission_error for position in swept for result in position.results])
    assert len(friction_groups(scene)) == 2 and len(prepared) == 3
    assert len(errors[0]) == 6 and errors[1] == pytest.approx(errors[0], rel=1e-8)


@pytest.mark.parametrize("stored", [1, 3, None])
def test_companion_of_an_earlier_version_is_resumed(stored: int | None, tmp_path: Path) -> None:
    """A helical pair with 16 positions: the companion has every second one. Where an earlier version, which solved all
    of them, was stopped after three, the other 13 follow, and all are read where it was done; after one, which both
    have, every second one follows. What is solved twice is the same, 1e-6 of the transmission error."""
    scene = helical_scene("sweep.positions=16", "contact.friction=0.0")
    every = replace(COMPANION, thinned=False)
    with temporary_call(tmp_path / "new") as call:
        new = kept_pitch(call, scene, COMPANION)
    with temporary_call(tmp_path / "old") as call:
        if stored is None:
            kept_pitch(call, scene, every)
        else:
            with interrupted(1 + 2 * stored), pytest.raises(Interrupted):  # gears, then a position and its state each
                kept_pitch(call, scene, every)
            assert len(resume_point(resumed(call), scene, COMPANION).positions) == stored
        found = kept_pitch(resumed(call), scene, COMPANION)
    step = 2.0 * np.pi / scene.pinion.teeth / 16
    assert [each.angle for each in new.solved.positions] == pytest.approx([2 * step * k for k in range(8)])
    count = 8 if stored == 1 else 16
    angles = [each.angle for each in found.solved.positions]
    assert angles == pytest.approx([16 / count * step * k for k in range(count)])
    for one, exact in zip(found.solved.positions[:: count // 8], new.solved.positions, strict=True):
        error = exact.results[0].transmission_error
        assert one.results[0].transmission_error == pytest.approx(error, rel=1e-6)
