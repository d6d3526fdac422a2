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
    before: Sequence[Floats] = (),
) -> Iterator[SweptPosition]:  # fmt: skip
    """The positions of a `uniform_pitch`, then those solved `again`, until every coefficient has closed it; without
    friction that is the last of the pitch. before: transmission errors (frictions,) [mm] of the positions that are
    there already, `state` being that after them.

    Raises NotConverged on all ranks, also where positions still change in the last round.
    """
    errors, whole = list(before), len(pitch.angles)
    rubs = any(model.has_friction_terms(μ) for μ in frictions)
    while len(errors) < whole + ROUNDS * pitch.counted:
        begin = _number(len(errors), pitch.warm_up, pitch.counted)
        if len(errors) >= whole and begin == pitch.warm_up:
            state = state.earlier(pitch.pitches)
        with closing(sweep_on_ranks(model, pitch, frictions, state, comm, begin)) as swept:
            for position in swept:
                errors.append(errors_of(position))
                state = position.state
                closes = len(errors) == whole if not rubs else is_closed(errors, pitch)
                yield replace(position, again=len(errors) > whole, closes=closes)
                if closes:
                    return
    raise never_closed(errors, pitch)


def is_closed(errors: Sequence[Floats], pitch: Pitch) -> bool:
    """Whether positions with these transmission errors (frictions,) have closed the pitch for every coefficient."""
    return bool(np.isfinite(_closed_by(np.array(errors), pitch.warm_up, pitch.counted)).all())


def never_closed(errors: Sequence[Floats], pitch: Pitch) -> NotConverged:
    """What to raise after the last round."""
    left = _left(np.array(errors), pitch.counted)
    return NotConverged(
        f"friction after {ROUNDS} more pitches: wanted transmission errors that are off by less than {FORGOTTEN} of "
        f"their peak-to-peak value, found {left.max():.2g} times that; lower the torque or friction"
    )


def one_pitch(swept: Sequence[SweptPosition]) -> list[SweptPosition]:
    """What `sweep_closed` has found, in order: the warm-up, and of each position of the pitch what was found last, by
    each coefficient until it had closed the pitch: what others need beyond that must not show in its results."""
    warm_up = sum(position.warm_up for position in swept)
    counted = sum(not position.again for position in swept) - warm_up
    last = _closed_by(np.array([errors_of(position) for position in swept]), warm_up, counted)
    found = list(swept[: warm_up + counted])
    for done, position in enumerate(swept[warm_up + counted :], warm_up + counted):
        k = _number(done, warm_up, counted)
        pairs = zip(found[k].results, position.results, last, strict=True)
        found[k] = replace(position, results=tuple(new if done <= end else old for old, new, end in pairs))
    return found


def errors_of(position: SweptPosition) -> Floats:
    """Its transmission errors (frictions,) [mm]."""
    return np.array([result.transmission_error for result in position.results])


def _number(done: int, warm_up: int, counted: int) -> int:
    """Which of the pitch's angles is next after so many."""
    return done if done < warm_up + counted else warm_up + (done - warm_up) % counted


def _closed_by(errors: Floats, warm_up: int, counted: int) -> Floats:
    """Which of the positions with transmission errors (k, frictions) closes the pitch for each coefficient; infinite:
    none yet."""
    last = np.full(errors.shape[1], np.inf)
    for done in range(warm_up + counted, len(errors)):
        last[(_left(errors[: done + 1], counted) <= 1.0) & np.isinf(last)] = done
    return last


def _left(errors: Floats, counted: int) -> Floats:
    """By how much the transmission errors (frictions,) of a pitch before the last of (k, frictions) were off, over what
    they may be. Changes from pitch to pitch fall in a geometric series: all that are to come are the last one over
    1 − their ratio."""
    change = np.abs(errors[-1] - errors[-1 - counted])
    allowed = np.maximum(FORGOTTEN * np.ptp(errors[-counted:], axis=0), SAME * np.abs(errors[-1]))
    return np.asarray(change / (1.0 - _ratio(errors, counted)) / allowed)


def _ratio(errors: Floats, counted: int) -> Floats:
    """Of the last changes (frictions,) from pitch to pitch to those a pitch before: where there are none yet, what the
    fall from the last position but one to the last comes to in a pitch."""
    changes = np.abs(errors[counted:] - errors[:-counted])
    if len(changes) > counted:
        before, power = changes[-1 - counted], 1
    elif len(changes) > 1:
        before, power = changes[-2], counted
    else:
        return np.full(errors.shape[1], SLOWEST)
    return np.asarray(np.minimum(changes[-1] / np.maximum(before, 1e-300), SLOWEST ** (1.0 / power)) ** power)
