"""A pitch swept again until nothing is left of where its sweep began.

Friction remembers, and a sweep that begins anywhere has a wrong past. What is left of that dies away with the way that
the gears roll, by a third from one of Yang's 20 positions to the next at μ = 0.3: three positions of warm-up leave 0.3
of the peak-to-peak transmission error to the first that counts. But all teeth are alike: the end of a pitch is the past
of its beginning. So its positions are solved again from there, in turn, as far as they still change.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from meshes.data import Floats
from solver.gear_model import GearModel
from solver.gear_sweep import Pitch, SweepState, SweptPosition
from solver.newton import NotConverged
from solver.rank_sweep import sweep_on_ranks

FORGOTTEN = 1e-2
"""Of the peak-to-peak transmission error: a position that was off by less closes the pitch."""
SAME = 1e-5  # of the transmission error itself: less than that is what searches and Newton's method leave
ROUNDS = 30
"""At most. Steel teeth under a usual load forget within half a pitch. Wide helical ones that bend by a twentieth of a
module may forget but a third a pitch, and need twelve."""
SLOWEST = 0.95  # share of a change that is back a pitch later: beyond it there is no telling how much is left


def sweep_closed(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], state: SweepState, comm: MPI.Comm,
    before: Sequence[SweptPosition] = (),
) -> Iterator[SweptPosition]:  # fmt: skip
    """The positions of a `uniform_pitch`, then those solved `again`, up to one that `closes` it; without friction that
    is the last of the pitch. before: those that are there already, `state` being that after them.

    Raises NotConverged on all ranks, also where positions still change in the last round.
    """
    whole, rubs = len(pitch.angles), any(model.has_friction_terms(μ) for μ in frictions)
    own, errors = whole - pitch.warm_up, [errors_of(position) for position in before]
    while len(errors) < whole + ROUNDS * own:
        begin = _number(len(errors), pitch)
        if len(errors) >= whole and begin == pitch.warm_up:
            state = state.earlier(own // pitch.period)
        with closing(sweep_on_ranks(model, pitch, frictions, state, comm, begin)) as swept:
            for position in swept:
                errors.append(errors_of(position))
                again, state = len(errors) > whole, position.state
                closes = is_closed(errors, pitch) if again else len(errors) == whole and not rubs
                yield replace(position, again=again, closes=closes)
                if closes:
                    return
    raise never_closed(errors, pitch)


def is_closed(errors: Sequence[Floats], pitch: Pitch) -> bool:
    """Whether the last but a pitch of these transmission errors (frictions,) was right, as far as matters."""
    return _left(errors, pitch.period) <= 1.0


def never_closed(errors: Sequence[Floats], pitch: Pitch) -> NotConverged:
    """What to raise after the last round."""
    return NotConverged(
        f"friction after {ROUNDS} more pitches: wanted transmission errors that are off by less than {FORGOTTEN} of "
        f"their peak-to-peak value, found {_left(errors, pitch.period):.2g} times that; lower the torque or friction"
    )


def one_pitch(swept: Sequence[SweptPosition]) -> list[SweptPosition]:
    """What `sweep_closed` has found, in order: the warm-up, and of each position of the pitch what was found last."""
    last = {position.angle: position for position in swept}
    return [last[angle] for angle in sorted(last)]


def _number(done: int, pitch: Pitch) -> int:
    """Which of the pitch's angles is next after so many."""
    own = len(pitch.angles) - pitch.warm_up
    return done if done < len(pitch.angles) else pitch.warm_up + (done - len(pitch.angles)) % own


def errors_of(position: SweptPosition) -> Floats:
    """Its transmission errors (frictions,) [mm]."""
    return np.array([result.transmission_error for result in position.results])


def _left(errors: Sequence[Floats], period: int) -> float:
    """By how much the transmission errors (frictions,) of a pitch before the last ones were off, over what they may be.
    Changes fall in a geometric series: all that were to come are the last one over 1 − their ratio, where that is
    known."""
    recent, change = np.array(errors[-period:]), np.abs(errors[-1] - errors[-1 - period])
    ratio = np.zeros_like(change)
    if len(errors) > 2 * period:
        before = np.abs(errors[-1 - period] - errors[-1 - 2 * period])
        ratio = np.minimum(change / np.maximum(before, 1e-300), SLOWEST)
    allowed = np.maximum(FORGOTTEN * np.ptp(recent, axis=0), SAME * np.abs(recent[-1]))
    return float(np.max(change / (1.0 - ratio) / allowed))
