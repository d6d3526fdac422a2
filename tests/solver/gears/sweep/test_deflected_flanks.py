"""Positions on deflected flanks: what a second search gives, that energy is kept, and when a run needs them."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from evidence.benchmarks.gears.skips import differences
from evidence.robustness.campaigns.random_scenes import random_scene
from evolvent.contact.newton.snes import NotConverged
from evolvent.fem.surface import Surface
from evolvent.gears.contact.pair_contact import GearContact, gear_contact
from evolvent.gears.contact.search_window import placed_flanks
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.solution.certificates import pitch_imbalance
from evolvent.gears.sweep import deflected_flanks
from evolvent.gears.sweep.deflected_flanks import deflected_equilibrium
from evolvent.gears.sweep.friction_history import FrictionHistory, previous_jumps
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_search import shared_position
from evolvent.results.archive.store import read_arrays
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import model_of, spur_scene
from tests.support.running.processes import BROKEN_RUN, RunScript

BENT = 344
"""A seed of a helical steel pair under a tenth of a module of deflection, small enough for a second a pitch."""
LOST = 2e-3
"""Of the input: the loss over a pitch is larger with normals before deflection, smaller with those after it."""


@pytest.fixture(scope="module")
def bent() -> GearModel:
    """Condensed."""
    return model_of(random_scene(BENT))


def lost(model: GearModel, friction: float) -> float:
    """Energy lost over a pitch of six positions, over the input."""
    pitch = uniform_pitch(model.pair.pinion.z, 6)
    swept = sweep_until_periodic(model, pitch, [friction], initial_state([friction]), MPI.COMM_SELF)
    return pitch_imbalance([position.results[0] for position in one_pitch(list(swept))])


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_energy_is_kept_on_deflected_flanks(friction: float, bent: GearModel) -> None:
    """Problem: a pitch of teeth that bend by a tenth of a module. Exact: input is output and friction work;
    along normals before deflection 3e-3 of it is missing, along those after it a quarter of that at most."""
    before, after = (lost(replace(bent, deflected=deflected), friction) for deflected in (False, True))
    assert before > 2.5e-3
    assert after < 0.25 * before + 1e-4


def test_energy_is_lost_along_normals_before_deflection(bent: GearModel, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same without friction where deflected flanks keep the normals from before: energy is lost."""
    monkeypatch.setattr(Surface, "displaced", lambda flank, u: replace(flank, points=flank.points + u))
    assert lost(replace(bent, deflected=True), 0.0) > LOST


def test_flanks_displaced_as_by_a_rotation_are_those_of_the_rotated_gear() -> None:
    """Problem: a spur pair whose wheel flanks are displaced as if the wheel had turned by 1e-4. Exact: frames, weights,
    levers are those of the wheel turned; the gap along the normals is the one between the points as they were."""
    model = model_of(spur_scene("mesh.level=quick"))
    stand, teeth = PairRotation(model.pair, 0.02), list(model.teeth)
    turned = stand.turned(Member.WHEEL, 1e-4)
    displaced = {}
    for tooth in teeth:
        (_, was), (first, now) = (placed_flanks(model.bodies, where, tooth) for where in (stand, turned))
        displaced[tooth] = np.zeros_like(first.points), now.points - was.points
    wanted = gear_contact(model.bodies, turned, teeth, model.half_width)
    moved = gear_contact(model.bodies, stand, teeth, model.half_width, displaced)
    assert moved.geometry.tooth.tolist() == wanted.geometry.tooth.tolist()
    assert np.allclose(moved.operator.frames, wanted.operator.frames, rtol=0.0, atol=1e-10)
    assert np.allclose(moved.operator.weights, wanted.operator.weights, rtol=0.0, atol=1e-10)
    assert np.allclose(moved.operator.points, wanted.operator.points, rtol=0.0, atol=1e-10)
    assert np.allclose(moved.geometry.spins, wanted.geometry.spins, rtol=0.0, atol=1e-9)
    for own in moved.geometry.teeth:
        first, second = placed_flanks(model.bodies, stand, own.tooth)
        x1 = first.positions(own.pairing.facet1, own.pairing.xi1[:, None])[:, 0]
        x2 = second.positions(own.pairing.facet2, own.pairing.xi2[:, None])[:, 0]
        normals = own.operator.shape @ own.operator.frames[:, 0]
        apart = np.einsum("qa,qa->q", normals, x2 - x1)
        assert np.allclose(own.operator.gap, apart, rtol=0.0, atol=1e-6 * model.pair.pinion.normal_module)


def test_a_converged_search_of_deflected_flanks_stays(bent: GearModel) -> None:
    """Problem: deflected flanks whose search has converged, searched once more. Exact: the same torque of the pinion
    within the tolerance, a hundredth of what the first searches changed; the rotation moves by half at most."""
    shared = shared_position(bent, 0.1, (0.0, 0.0), [0.0], None)
    first = deflected_equilibrium(bent, shared.contact, shared.smooth, 0.0, None, 0.01)
    again = deflected_equilibrium(bent, first.contact, first.equilibrium, 0.0, None, 0.01)
    before, once, twice = (
        float(np.sum(contact.geometry.spins[0][:, 0] * state.force[:, 0]))
        for contact, state in (
            (shared.contact, shared.smooth), (first.contact, first.equilibrium), (again.contact, again.equilibrium),
        )
    )
    assert abs(twice - once) < 0.01 * abs(once - before)
    assert abs(float(again.equilibrium.motion[0])) < 0.5 * abs(float(first.equilibrium.motion[0]))


def test_whole_deflected_flanks_are_those_of_all_tooth_pairs(
    bent: GearModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Problem: the window is widened to whole flanks, as flanks overlap outside it. Exact: all tooth pairs are searched
    as they have deflected, also those without a point in the window before."""
    shared = shared_position(bent, 0.1, (0.0, 0.0), [0.0], None)
    searched: list[tuple[list[int], set[int]]] = []

    def seen(bodies: Any, stand: Any, teeth: list[int], half_width: float, displaced: Any) -> GearContact:
        searched.append((teeth, set(displaced)))
        return gear_contact(bodies, stand, teeth, half_width, displaced)

    monkeypatch.setattr(deflected_flanks, "gear_contact", seen)
    whole = replace(shared.contact, geometry=replace(shared.contact.geometry, half_width=np.inf))
    for contact in (shared.contact, whole):
        deflected_flanks.deflected_contact(bent, contact, shared.smooth)
    touching = {int(tooth) for tooth in shared.contact.geometry.tooth}
    assert touching < set(bent.teeth)
    assert searched == [(sorted(touching), touching), (list(bent.teeth), set(bent.teeth))]


def test_a_search_of_deflected_flanks_that_does_not_converge_is_an_error(
    bent: GearModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the searches do not converge the position has no result, and the message says by how much they moved."""
    monkeypatch.setattr(deflected_flanks, "ROUNDS", 1)
    shared = shared_position(bent, 0.1, (0.0, 0.0), [0.0], None)
    with pytest.raises(NotConverged, match=r"move by less than 14.20 µm within their window, found them moved by \d"):
        deflected_equilibrium(bent, shared.contact, shared.smooth, 0.0, None, 0.01)


def test_displacements_of_deflected_flanks_turn_with_their_gears(bent: GearModel) -> None:
    """Problem: flanks that carry the same forces before and after both gears have turned. Exact: displacements are the
    same on each gear, so that nothing slips beside the velocity of deflected points; between flanks as made that
    velocity has no part of the displacement, and the history turns with the wheel alone."""
    shared = shared_position(bent, 0.1, (0.0, 0.0), [0.1], None)
    first = deflected_equilibrium(bent, shared.contact, shared.smooth, 0.0, None, 0.01)
    for own, state, stays in ((first.contact, first.equilibrium, True), (shared.contact, shared.smooth, False)):
        history = FrictionHistory.of(bent, own, state)
        turned = replace(history, stand=replace(history.stand, angle=history.stand.angle - 0.02))
        both = replace(history, stand=own.stand), turned
        now, then = (previous_jumps(own.geometry, [each])[0].jump for each in both)
        assert (np.abs(now - then).max() < 1e-9 * np.abs(now).max()) == stays


def test_coefficients_on_deflected_flanks_are_independent(bent: GearModel) -> None:
    """Problem: two friction coefficients, whose flanks deflect differently and are searched apart. Exact: each alone;
    histories on windows of different width are interpolated apart too."""
    deflected = replace(bent, deflected=True)
    both, *alone = (_swept(deflected, frictions) for frictions in ([0.1, 0.3], [0.1], [0.3]))
    for i, own in enumerate(alone):
        for one, other in zip(both, own, strict=True):
            assert one.results[i].torques == pytest.approx(other.results[0].torques, rel=1e-7)
    shared = shared_position(bent, 0.1, (0.0, 0.0), [0.1], None)
    further = shared_position(replace(bent, half_width=1.5 * bent.half_width), 0.1, (0.0, 0.0), [0.1], None)
    histories = [FrictionHistory.of(bent, own.contact, own.smooth) for own in (shared, further)]
    geometry = shared.contact.geometry
    together, apart = (previous_jumps(geometry, each)[i].jump for each, i in ((histories, 1), (histories[1:], 0)))
    assert len(histories[0].rows[0]) != len(histories[1].rows[0])
    assert np.array_equal(together, apart)


def _swept(model: GearModel, frictions: list[float]) -> list[SweptPosition]:
    pitch = Pitch((0.1, 0.15))
    return list(sweep_pitch(model, pitch, frictions, initial_state(frictions)))


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The bent pair as a scene of four positions and two friction coefficients."""
    path = tmp_path_factory.mktemp("scene") / "bent.toml"
    path.write_text(random_scene(BENT).resolved_toml(), encoding="utf-8")
    return path


def solved(
    run_script: RunScript, scene: Path, out: Path, *how: str, ranks: int = 1, resume: bool = False
) -> dict[str, Any]:
    """The summary of a run; the first of `how` is what to break."""
    settings = "sweep.positions=4", "contact.friction=[0.0, 0.1]"
    more = [*(f"--set={setting}" for setting in settings), *how[1:], *(["--resume"] if resume else [])]
    where = str(scene), "--out", str(out), "--quiet"
    done = run_script(BROKEN_RUN, how[0], *where, *more, ranks=ranks)
    assert done.returncode == 0, done.stderr
    summary: dict[str, Any] = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    return summary


@pytest.fixture(scope="module")
def asked(scene: Path, run_script: RunScript, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Solved on deflected flanks because it is asked for."""
    return solved(run_script, scene, tmp_path_factory.mktemp("asked"), "ok", "--exact=deflected-flanks")


@pytest.mark.mpi
def test_a_pitch_out_of_balance_is_solved_again_on_deflected_flanks(
    scene: Path, asked: dict[str, Any], run_script: RunScript, tmp_path: Path
) -> None:
    """A run that loses more than is allowed becomes, on two ranks, the one on one rank that asks for deflected flanks;
    the summary and the log say so."""
    found = solved(run_script, scene, tmp_path, "strict", ranks=2)
    assert differences(asked, found).largest < 1e-8
    assert found["scene"]["exact"]["parts"] == ["deflected-flanks"]
    assert "deflected-flanks" not in {skip["name"] for skip in found["skipped"]}
    log = (tmp_path / "run.log").read_text(encoding="utf-8")
    assert "wanted an energy balance within 0.002 of the input, found" in log
    assert log.count("condensed in") == 1
    assert "skipped, deflected-flanks" not in log and "solved again, on deflected flanks" in log


def test_a_run_killed_on_deflected_flanks_is_resumed(
    scene: Path, asked: dict[str, Any], run_script: RunScript, tmp_path: Path
) -> None:
    """kill -9 while the last position of the pitch before deflection, the one that closes it, or the second after
    deflection, is written, and resumed each time: it is the same in the end."""
    settings = "--set=sweep.positions=4", "--set=contact.friction=[0.0, 0.1]"
    command = str(scene), "--out", str(tmp_path), "--quiet", *settings
    for number, complete in ((9, 3), (9, 7), (6, 1)):
        assert run_script(BROKEN_RUN, f"strict-{number}", *command, *["--resume"] * (complete != 3)).returncode == -9
        assert int(read_arrays(tmp_path / "results/state.npz")["complete"]) == complete
    found = solved(run_script, scene, tmp_path, "strict", resume=True)
    assert differences(asked, found).largest < 1e-8
    assert "resumed after 1 positions" in (tmp_path / "run.log").read_text(encoding="utf-8")
