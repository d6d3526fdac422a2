"""Repeat the pitch until the friction state is periodic.

A sweep begins without a friction history, from flanks that slide everywhere. The error of that decays with the rotation
of the gears, by a third from one of Yang's 20 positions to the next at μ = 0.3, whose first is off by 0.08 of the
peak-to-peak transmission error (by all of it, were the first history that of flanks without friction). But all teeth
are alike: the end of a pitch is the history of its beginning. So its positions are solved again from there, in
turn, as far as they still change; each starts from its last solution.
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
from evolvent.gears.sweep.parallel_sweep import positions_at_once, sweep_on_ranks
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition
from evolvent.gears.sweep.position_search import KnownSolution
from evolvent_meshes.arrays import Bools, Floats

TOLERANCE = 1e-2
"""Error of the transmission error, over its peak-to-peak value, below which a position closes the pitch."""
ROUNDING = 1e-5  # of the transmission error itself: less than that is what searches and Newton's method leave
ROUNDS = 30
"""Largest number of repeated pitches. Steel teeth under a usual load are periodic within half a pitch. Wide helical
ones that bend by a twentieth of a module may reduce the error by but a third a pitch, and need twelve."""
SLOWEST = 0.95  # largest ratio of changes from pitch to pitch: beyond it the error cannot be estimated from them


def sweep_until_periodic(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], state: SweepState, comm: MPI.Comm,
    before: Sequence[Floats] = (),
) -> Iterator[SweptPosition]:
    """The positions of a `uniform_pitch`, then those solved `again` with the coefficients that are not yet periodic;
    without friction it ends with the pitch.

    before: `transmission_errors` of the positions that are there already.
    state: after these.

    Raises NotConverged on all ranks, also where positions still change in the last round.
    """
    errors, whole = list(before), len(pitch.angles)
    solutions: dict[int, KnownSolution] = {}
    rubs = np.array([model.has_friction_terms(μ) for μ in frictions])
    known = ~np.isnan(errors[-1]) if errors else np.ones_like(rubs)  # whose histories the state has
    ahead = _still_changing(errors, pitch, rubs)
    while ahead.any() and len(errors) < (1 + ROUNDS) * whole:
        state, solved, begin = state.of(ahead[known]), ahead, len(errors) % whole
        if errors and begin == 0:
            state = state.earlier(model.load.driving.sign * pitch.pitches)
        chosen = list(compress(frictions, solved))
        with closing(sweep_on_ranks(model, pitch, chosen, state, comm, begin, solutions)) as swept:
            for count, position in enumerate(swept, 1):
                position, known = position.of(ahead[solved]), ahead
                if position.known is not None:
                    solutions[len(errors) % whole] = position.known
                errors.append(transmission_errors(position, frictions))
                state, ahead = position.state, _still_changing(errors, pitch, rubs)
                yield replace(position, again=len(errors) > whole, closes=not ahead.any())
                if not ahead.any() or ((ahead != solved).any() and count % positions_at_once(comm) == 0):
                    break
    if ahead.any():
        raise never_periodic(errors, pitch)


def is_periodic(errors: Sequence[Floats], pitch: Pitch) -> bool:
    """Whether the last of positions with these transmission errors (frictions,) closes the pitch for all of them."""
    return bool((_remaining_error(np.array(errors), len(pitch.angles)) <= 1.0).all())


def never_periodic(errors: Sequence[Floats], pitch: Pitch) -> NotConverged:
    """Error to raise where positions still change in the last round."""
    remaining = _remaining_error(np.array(errors), len(pitch.angles))
    return NotConverged(
        f"friction after {ROUNDS} more pitches: wanted transmission errors that are off by less than {TOLERANCE} of "
        f"their peak-to-peak value, found {np.nanmax(remaining):.2g} times that; lower the torque or friction"
    )


def one_pitch(swept: Sequence[SweptPosition]) -> list[SweptPosition]:
    """The positions of the pitch by ascending angle, each with the last result and state of each coefficient. swept:
    all of a `sweep_until_periodic`."""
    whole = sum(not position.again for position in swept)
    latest = list(swept[:whole])
    for done, position in enumerate(swept[whole:]):
        latest[done % whole] = _renewed(latest[done % whole], position)
    return sorted(latest, key=lambda position: position.angle)


def _renewed(first: SweptPosition, again: SweptPosition) -> SweptPosition:
    """Position with the new results of some of its friction coefficients."""
    renewed = {result.friction: result for result in again.results}
    results = tuple(renewed.get(result.friction, result) for result in first.results)
    if len(first.state.histories) < len(first.results):  # read from an archive, which keeps that of the last position
        return replace(again, results=results)
    histories = dict(zip((result.friction for result in first.results), first.state.histories))
    histories |= dict(zip(renewed, again.state.histories))
    return replace(again, results=results, state=replace(again.state, histories=tuple(histories.values())))


def transmission_errors(position: SweptPosition, frictions: Sequence[float]) -> Floats:
    """Transmission errors (frictions,) of a position [mm], NaN for coefficients that it was not solved with."""
    errors = {result.friction: result.transmission_error for result in position.results}
    return np.array([errors.get(μ, np.nan) for μ in frictions])


def _still_changing(errors: Sequence[Floats], pitch: Pitch, rubs: Bools) -> Bools:
    """Whether to continue with each friction coefficient after these transmission errors, (frictions,). rubs:
    (frictions,) whether it has friction terms."""
    if len(errors) < len(pitch.angles):
        return np.ones_like(rubs)
    if len(errors) == len(pitch.angles):
        return rubs
    return _remaining_error(np.array(errors), len(pitch.angles)) > 1.0  # NaN for those that were periodic before


def _remaining_error(errors: Floats, whole: int) -> Floats:
    """Estimated error of the transmission errors (frictions,) a pitch before the last of (k, frictions), over the
    allowed one. Changes from pitch to pitch fall in a geometric series: all that are to come are the last one over
    1 − their ratio."""
    change = np.abs(errors[-1] - errors[-1 - whole])
    allowed = np.maximum(TOLERANCE * np.ptp(errors[-whole:], axis=0), ROUNDING * np.abs(errors[-1]))
    return np.asarray(change / (1.0 - _ratio(errors, whole)) / allowed)


def _ratio(errors: Floats, whole: int) -> Floats:
    """Ratio of the last changes (frictions,) from pitch to pitch to those a pitch before: where there are none yet, the
    ratio of the last position's to the one's before, to the power of the positions of a pitch."""
    changes = np.abs(errors[whole:] - errors[:-whole])
    if len(changes) > whole:
        before, power = changes[-1 - whole], 1
    elif len(changes) > 1:
        before, power = changes[-2], whole
    else:
        return np.full(errors.shape[1], SLOWEST)
    return np.asarray(np.minimum(changes[-1] / np.maximum(before, 1e-300), SLOWEST ** (1.0 / power)) ** power)
