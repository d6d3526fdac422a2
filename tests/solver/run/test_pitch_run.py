"""The positions of a scene: generated one after the other, certified before they are archived.

Problem: He's spur pair in plane strain, three positions of a pitch.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from mpi4py import MPI

from evolvent.gears.solution import certificates
from evolvent.gears.solution.certificates import BalanceError, PitchImbalance
from evolvent.results.archive.run_folder import RunFolder
from evolvent.run import start
from evolvent.run.context import RunContext, run_context
from evolvent.run.pitch_run import ScenePitch, friction_groups, sweep_scene
from evolvent.run.start import resume_point
from evolvent.scene.scene import Scene
from tests.support.gear_cases import spur_scene
from tests.support.running.patches import calling_first


@pytest.fixture
def run(tmp_path: Path) -> Iterator[RunContext]:
    """A run on this rank alone."""
    with run_context(RunFolder(tmp_path), MPI.COMM_SELF, resume=False, quiet=True, begin=0.0) as context:
        yield context


@pytest.fixture
def prepared(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """One entry for each time that the gears are condensed."""
    calls: list[int] = []
    counted = calling_first(start.prepare_model, lambda *_, **__: calls.append(len(calls)))
    monkeypatch.setattr(start, "prepare_model", counted)
    return calls


def scene_of(*settings: str) -> Scene:
    return spur_scene("mesh.level=quick", "sweep.positions=3", *settings)


def test_pitch_generates_its_positions_in_order(run: RunContext) -> None:
    """Three equal steps of the angular pitch, of which only the last closes it; nothing is archived by `generate`."""
    pitch = ScenePitch(run, scene_of("contact.friction=0.0"))
    swept = list(pitch.generate())
    assert [position.angle for position in swept] == list(pitch.pitch.angles)
    assert [position.closes for position in swept] == [False, False, True]
    assert resume_point(pitch.scene, pitch.archive, True) is None


def test_solved_pitch_is_resumed_at_its_end(run: RunContext, prepared: list[int]) -> None:
    """All positions are archived; resumed there, the gears are not condensed again and no time is spent."""
    scene = scene_of("contact.friction=0.0")
    _, record = sweep_scene(run, scene, None)
    assert record.timings.positions > 0.0 and record.timings.total > record.timings.factor > 0.0
    end = resume_point(scene, run.archive(scene), True)
    assert end is not None and end.is_end and len(end.positions) == 3
    _, again = sweep_scene(run, scene, end)
    assert len(prepared) == 1 and again.timings.total == 0.0


def test_position_out_of_balance_is_not_archived(run: RunContext, monkeypatch: pytest.MonkeyPatch) -> None:
    """A position that fails its certificate is raised as BalanceError before it is archived."""
    monkeypatch.setattr(certificates, "STORED_LIMIT", -1.0)
    scene = scene_of("contact.friction=0.0")
    with pytest.raises(BalanceError, match="wanted a balance error of at most"):
        sweep_scene(run, scene, None)
    assert resume_point(scene, run.archive(scene), True) is None


def test_finished_friction_groups_are_not_solved_again(run: RunContext, prepared: list[int]) -> None:
    """Coefficients with gears of their own, resumed at their end: no gear is condensed again."""
    scene = scene_of("contact.friction=[0.0, 0.2]", "exact.parts=reuse")
    sweep_scene(run, scene, None)
    end = resume_point(scene, run.archive(scene), True)
    assert len(prepared) == 2 and end is not None and end.is_end
    _, again = sweep_scene(run, scene, end)
    assert len(prepared) == 2 and again.timings.total == 0.0


def test_unbalanced_pitch_is_solved_again_on_the_same_gears(
    run: RunContext, prepared: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Energy that no pitch can balance: solved once more on deflected flanks, with the gears condensed once."""
    monkeypatch.setattr(certificates, "BALANCE_LIMIT", -1.0)
    with pytest.raises(PitchImbalance, match="wanted an energy balance within"):
        sweep_scene(run, scene_of("contact.friction=0.0"), None)
    assert len(prepared) == 1
    run.log.open()
    assert "solved again, on deflected flanks" in (run.folder.out / "run.log").read_text(encoding="utf-8")


def test_friction_coefficients_in_groups_give_the_same_pitch(tmp_path: Path, prepared: list[int]) -> None:
    """Two coefficients, each solved with gears of its own: the transmission errors of both together within 1e-8."""
    errors = []
    for name, settings in (("together", ()), ("alone", ("exact.parts=reuse",))):
        scene = scene_of("contact.friction=[0.0, 0.2]", *settings)
        with run_context(RunFolder(tmp_path / name), MPI.COMM_SELF, resume=False, quiet=True, begin=0.0) as run:
            sweep_scene(run, scene, None)
            swept = run.archive(scene).read_positions(scene.gear_pair())
        errors.append([result.transmission_error for position in swept for result in position.results])
    assert len(friction_groups(scene)) == 2 and len(prepared) == 3
    assert len(errors[0]) == 6 and errors[1] == pytest.approx(errors[0], rel=1e-8)
