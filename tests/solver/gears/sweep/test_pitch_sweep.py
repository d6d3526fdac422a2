"""A pitch swept position by position: a step whose position fails is halved."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from evolvent.contact.newton.equilibrium import InitialGuess
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep import pitch_sweep
from evolvent.gears.sweep.position_search import KnownSolution, SearchedAt, shared_position
from evolvent_meshes.errors import EvolventError
from tests.support.gear_cases import Curves, model_of, spur_scene, swept
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
