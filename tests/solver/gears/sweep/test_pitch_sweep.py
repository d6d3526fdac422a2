"""A pitch swept position by position: a step whose position fails is halved; a wheel that drives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.contact.newton.equilibrium import InitialGuess
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.gears.gear_model import GearModel
from evolvent.gears.solution.certificates import pitch_imbalance
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep import pitch_sweep
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import KnownSolution, SearchedAt, shared_position
from evolvent.gears.sweep.slip import nominal_direction, slip_direction
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import EvolventError
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import Curves, helical_scene, model_of, spur_scene, swept
from tests.support.running.patches import calling_first

STEP = 0.18
DEGREES = STEP * np.arange(-4, 8)
FAILING = 0.36, 1.08
"""Of DEGREES, at the first attempt."""


@pytest.fixture(scope="module")
def spur() -> GearModel:
    return model_of(spur_scene())


@pytest.fixture(scope="module")
def whole(spur: GearModel) -> Curves:
    """Swept without halving a step."""
    return swept(spur, DEGREES, [0.3])[0]


def failing_once(angle: Callable[..., float], error: Exception, left: list[float]) -> Callable[..., None]:
    """Raises the error where it is first called for an angle [°] of `left`, which it takes out."""
    def fail(*arguments: object, **_: object) -> None:
        degrees = round(float(np.degrees(angle(*arguments))), 6)
        if degrees in left:
            left.remove(degrees)
            raise error
    return fail


FAILURES: dict[str, tuple[str, Callable[..., float], type[EvolventError]]] = {
    "friction does not converge": ("solve_position", lambda _, shared, *__: shared.contact.stand.angle, NotConverged),
    "the search does not converge": ("shared_position", lambda _, angle, *__: angle, NotConverged),
    "the search fails": ("shared_position", lambda _, angle, *__: angle, SearchError),
}
"""What fails -> function of the sweep, its angle, the error."""


@pytest.mark.parametrize("failure", FAILURES)
def test_a_position_that_fails_once_is_approached_in_two_halves(
    failure: str, spur: GearModel, whole: Curves, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Problem: two positions that fail at the whole step and succeed at its half. Exact: the positions of a sweep in
    which none fails: to rounding where all slides, within 3 % of the friction coefficient's effect right behind the
    pitch point."""
    name, angle, error = FAILURES[failure]
    left = list(FAILING)
    fail = failing_once(angle, error("as the test wants"), left)
    monkeypatch.setattr(pitch_sweep, name, calling_first(getattr(pitch_sweep, name), fail))
    halved = swept(spur, DEGREES, [0.3])[0]
    assert left == []
    assert halved.degrees.tolist() == whole.degrees.tolist()
    difference = np.abs(halved.of("transmission_error") - whole.of("transmission_error"))
    assert difference[:6].max() == 0.0
    assert difference[8:].max() < 1e-9
    assert difference.max() < 5e-5


@pytest.mark.parametrize("error", [NotConverged, SearchError])
def test_a_position_that_always_fails_ends_the_sweep(
    error: type[Exception], spur: GearModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Four halvings, then NotConverged with the angle; nothing is yielded."""
    tried = []

    def failing(model: GearModel, angle: float, *_: object, **__: object) -> None:
        tried.append(angle)
        raise error("as the test wants")

    monkeypatch.setattr(pitch_sweep, "shared_position", failing)
    with pytest.raises(NotConverged, match=r"pinion at .*°, also after 4 halvings of the step: as the test wants"):
        swept(spur, np.array([1.0, 1.2]), [0.1])
    assert np.diff(np.degrees(tried)) == pytest.approx([-0.1, -0.05, -0.025, -0.0125])


def test_guess_of_another_search_is_left_out(spur: GearModel) -> None:
    """A position whose search has not ended where it was made before has other nodes: a known solution of three of them
    changes nothing."""
    frictions, angle, beyond_nominal = [0.3], float(np.radians(2.2)), (0.0, 0.0)
    shared = shared_position(spur, angle, beyond_nominal, frictions, None)
    elsewhere = SearchedAt(angle, (1.0, 1.0), 1.0)
    guess = InitialGuess(np.zeros((3, 2)), np.zeros(1))
    known = {0: KnownSolution(elsewhere, guess, {0.3: guess})}
    pitch, state = pitch_sweep.Pitch((angle,)), pitch_sweep.initial_state(frictions)
    found, wanted = (
        next(pitch_sweep.sweep_pitch(spur, pitch, frictions, state, common=shared, known=each)).results[0]
        for each in (known, {})
    )
    assert found.transmission_error == pytest.approx(wanted.transmission_error, rel=1e-9)


RELIEVED = tuple(
    f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("tip_relief_um=20", 'tip_relief_form="parabolic"')
)
"""Reliefs under which no edge of a tip bears."""


def driven_by(driving: Member, friction: float, positions: int = 6) -> tuple[PositionResult, ...]:
    """A certified pitch of He's pair, relieved, by ascending angle. driving: the gear that drives and has the torque.
    """
    gears = model_of(spur_scene(*RELIEVED, "mesh.level=quick"))
    gears = replace(gears, load=replace(gears.load, on=driving, driving=driving))
    pitch = pitch_sweep.uniform_pitch(gears.pair.pinion.z, positions, 1, driving)
    (results,) = certified_pitch(gears, pitch, [friction], MPI.COMM_SELF).by_friction
    return results


def errors(results: tuple[PositionResult, ...]) -> Floats:
    """Their transmission errors [mm]."""
    return np.array([result.transmission_error for result in results])


def test_driving_wheel_is_the_mirror_image_of_a_driving_pinion() -> None:
    """Problem: He's pair, both gears alike, at μ = 0.3. Exact: where the wheel drives and has the torque, position −φ
    is that at φ where the pinion drives and has it: the same transmission error, friction power and forces of tooth
    pairs, torques exchanged. The contact is on the pinion's mesh, so that both agree as its cells allow: 0.3 % of the
    error, 0.1 % of the torque, 0.5 % of the load. Position by position the error differs by more than 1 %, and that of
    friction as of a driving pinion would not."""
    pinion, wheel = driven_by(Member.PINION, 0.3), driven_by(Member.WHEEL, 0.3)
    angles = [result.stand.angle for result in wheel]
    assert angles == sorted(angles) == [result.stand.angle for result in pinion]
    image = tuple(wheel[-k % len(wheel)] for k in range(len(wheel)))
    assert errors(image) == pytest.approx(errors(pinion), rel=3e-3)
    assert np.abs(errors(wheel) / errors(pinion) - 1.0).max() > 1e-2
    for one, other in zip(pinion, image):
        assert other.torques == pytest.approx(one.torques[::-1], rel=1e-3)
        assert other.friction_loss == pytest.approx(one.friction_loss, rel=1e-2, abs=1e-4 * one.input_power)
        forces, mirrored = (
            sorted(each.contact.normal_force(int(tooth)) for tooth in np.unique(each.contact.tooth))
            for each in (one, other)
        )
        assert mirrored == pytest.approx(forces, abs=5e-3 * sum(forces))


@pytest.mark.parametrize("driving", Member)
@pytest.mark.parametrize("holds", Member)
def test_input_exceeds_output_by_the_friction(driving: Member, holds: Member) -> None:
    """Exact, He's pair, whichever gear drives and whichever has the torque: over the pitch the power on the driving
    gear is that on the other one and that of friction, 2e-4 of it. Friction takes more than 1.5 % at μ = 0.3: were its
    sign that of the other gear driving, the output would exceed the input."""
    gears = model_of(spur_scene(*RELIEVED, "mesh.level=quick"))
    gears = replace(gears, load=replace(gears.load, on=holds, driving=driving))
    pitch = pitch_sweep.uniform_pitch(gears.pair.pinion.z, 6, 1, driving)
    (results,) = certified_pitch(gears, pitch, [0.3], MPI.COMM_SELF).by_friction
    powers = np.sum([(result.torques[0], result.torques[1] / result.stand.pair.ratio) for result in results], axis=0)
    lost = sum(result.friction_loss for result in results)
    assert powers[driving] - powers[driving.mate] == pytest.approx(lost, abs=2e-4 * powers[driving])
    assert lost > 0.015 * powers[driving]
    assert sum(result.input_power for result in results) == pytest.approx(powers[driving], rel=1e-12)
    assert all(result.torques[holds] == pytest.approx(gears.load.torque, rel=1e-6) for result in results)
    assert pitch_imbalance(results) < 2e-4


def test_frictionless_pitch_is_the_same_whichever_gear_drives() -> None:
    """Exact without friction, with the torque on the pinion: the same positions, 1e-8 of their transmission error."""
    gears, found = model_of(spur_scene(*RELIEVED, "mesh.level=quick")), []
    for driving in Member:
        own = replace(gears, load=replace(gears.load, driving=driving))
        pitch = pitch_sweep.uniform_pitch(gears.pair.pinion.z, 4, 1, driving)
        found.append(errors(certified_pitch(own, pitch, [0.0], MPI.COMM_SELF).by_friction[0]))
    assert found[1] == pytest.approx(found[0], rel=1e-8)


def test_slip_is_in_the_opposite_direction_where_the_wheel_drives(spur: GearModel) -> None:
    """Exact: the nominal direction of slip in a step of −Δφ is the opposite of that in a step of Δφ; a slice near the
    pitch point has none."""
    geometry = shared_position(spur, 0.02, (0.0, 0.0), [0.1], None).contact.geometry
    one, other = (nominal_direction(geometry, span) for span in (0.01, -0.01))
    assert np.linalg.norm(one, axis=1) == pytest.approx(1.0) and np.array_equal(other, -one)
    known = slip_direction(geometry, -0.01)
    assert known.any() and np.array_equal(known, -slip_direction(geometry, 0.01))


@pytest.mark.parametrize("driving", Member)
def test_positions_against_the_sense_of_rotation_are_refused(driving: Member, spur: GearModel) -> None:
    """Ascending angles where the wheel drives, descending ones where the pinion does: friction would drive."""
    against = pitch_sweep.uniform_pitch(spur.pair.pinion.z, 4, 1, driving.mate)
    gears = replace(spur, load=replace(spur.load, driving=driving))
    with pytest.raises(ValueError, match=f"as they follow where the {driving.label} drives"):
        next(pitch_sweep.sweep_pitch(gears, against, [0.1], pitch_sweep.initial_state([0.1])))


def test_history_of_a_driving_wheel_is_moved_forward() -> None:
    """Problem: a helical pair at μ = 0.5, parts of whose contact stick, driven by its wheel: a certified pitch, begun
    without a history, and the second of two pitches of one sweep. Exact: the same, but for the tolerance of the
    periodic pitch, 1 % of the peak-to-peak transmission error."""
    gears = model_of(helical_scene())
    gears, frictions = replace(gears, load=replace(gears.load, driving=Member.WHEEL)), [0.5]
    one, two = (pitch_sweep.uniform_pitch(gears.pair.pinion.z, 6, count, Member.WHEEL) for count in (1, 2))
    (closed,) = certified_pitch(gears, one, frictions, MPI.COMM_SELF).by_friction
    later = list(pitch_sweep.sweep_pitch(gears, two, frictions, pitch_sweep.initial_state(frictions)))[6:]
    wanted = errors(tuple(position.results[0] for position in reversed(later)))
    assert np.abs(errors(closed) - wanted).max() < 1e-2 * np.ptp(wanted)
