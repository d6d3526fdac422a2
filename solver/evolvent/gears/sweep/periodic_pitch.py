"""A pitch swept again until nothing is left of where its sweep began.

Friction remembers, and a sweep that begins anywhere has a wrong past. What is left of that dies away with the way that
the gears roll, by a third from one of Yang's 20 positions to the next at μ = 0.3, whose first is off by 0.6 of the
peak-to-peak transmission error. But all teeth are alike: the end of a pitch is the past of its beginning. So its
positions are solved again from there, in turn, as far as they still change.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from itertools import compress

import numpy as np
from mpi4py import MPI

from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.parallel_sweep import at_once, sweep_on_ranks
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition
from evolvent_meshes.arrays import Floats

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
    """The positions of a `uniform_pitch`, then those solved `again` with the coefficients that have not closed it yet;
    without friction that is the last of the pitch. before: `errors_of` the positions that are there already, `state`
    being that after them.

    Raises NotConverged on all ranks, also where positions still change in the last round.
    """
    errors, whole = list(before), len(pitch.angles)
    rubs = np.array([model.has_friction_terms(μ) for μ in frictions])
    known = ~np.isnan(errors[-1]) if errors else np.ones_like(rubs)  # whose past the state is
    ahead = _open(errors, pitch, rubs)
    while ahead.any() and len(errors) < (1 + ROUNDS) * whole:
        state, solved, begin = state.of(ahead[known]), ahead, len(errors) % whole
        if errors and begin == 0:
            state = state.earlier(pitch.pitches)
        with closing(sweep_on_ranks(model, pitch, list(compress(frictions, solved)), state, comm, begin)) as swept:
            for count, position in enumerate(swept, 1):
                position, known = position.of(ahead[solved]), ahead
                errors.append(errors_of(position, frictions))
                state, ahead = position.state, _open(errors, pitch, rubs)
                yield replace(position, again=len(errors) > whole, closes=not ahead.any())
                if not ahead.any() or ((ahead != solved).any() and count % at_once(comm) == 0):
                    break
    if ahead.any():
        raise never_closed(errors, pitch)


def is_closed(errors: Sequence[Floats], pitch: Pitch) -> bool:
    """Whether the last of positions with these transmission errors (frictions,) closes the pitch for all of them."""
    return bool((_left(np.array(errors), len(pitch.angles)) <= 1.0).all())


def never_closed(errors: Sequence[Floats], pitch: Pitch) -> NotConverged:
    """What to raise after the last round."""
    left = _left(np.array(errors), len(pitch.angles))
    return NotConverged(
        f"friction after {ROUNDS} more pitches: wanted transmission errors that are off by less than {FORGOTTEN} of "
        f"their peak-to-peak value, found {np.nanmax(left):.2g} times that; lower the torque or friction"
    )


def one_pitch(swept: Sequence[SweptPosition]) -> list[SweptPosition]:
    """What `sweep_closed` has found, in order: of each position of the pitch what each coefficient has found last."""
    whole = sum(not position.again for position in swept)
    found = list(swept[:whole])
    for done, position in enumerate(swept[whole:]):
        first = found[done % whole]
        renewed = {result.friction: result for result in position.results}
        results = tuple(renewed.get(result.friction, result) for result in first.results)
        found[done % whole] = replace(position, results=results)
    return found


def errors_of(position: SweptPosition, frictions: Sequence[float]) -> Floats:
    """Its transmission errors (frictions,) [mm], NaN for coefficients that it was not solved with."""
    found = {result.friction: result.transmission_error for result in position.results}
    return np.array([found.get(μ, np.nan) for μ in frictions])


def _open(errors: Sequence[Floats], pitch: Pitch, rubs: np.ndarray) -> np.ndarray:
    """(frictions,) bool: those to go on with after these transmission errors, rubs being those that have a past."""
    if len(errors) < len(pitch.angles):
        return np.ones_like(rubs)
    if len(errors) == len(pitch.angles):
        return rubs
    return _left(np.array(errors), len(pitch.angles)) > 1.0  # what has closed before is NaN there


def _left(errors: Floats, whole: int) -> Floats:
    """By how much the transmission errors (frictions,) of a pitch before the last of (k, frictions) were off, over what
    they may be. Changes from pitch to pitch fall in a geometric series: all that are to come are the last one over
    1 − their ratio."""
    change = np.abs(errors[-1] - errors[-1 - whole])
    allowed = np.maximum(FORGOTTEN * np.ptp(errors[-whole:], axis=0), SAME * np.abs(errors[-1]))
    return np.asarray(change / (1.0 - _ratio(errors, whole)) / allowed)


def _ratio(errors: Floats, whole: int) -> Floats:
    """Of the last changes (frictions,) from pitch to pitch to those a pitch before: where there are none yet, what the
    fall from the last position but one to the last comes to in a pitch."""
    changes = np.abs(errors[whole:] - errors[:-whole])
    if len(changes) > whole:
        before, power = changes[-1 - whole], 1
    elif len(changes) > 1:
        before, power = changes[-2], whole
    else:
        return np.full(errors.shape[1], SLOWEST)
    return np.asarray(np.minimum(changes[-1] / np.maximum(before, 1e-300), SLOWEST ** (1.0 / power)) ** power)
