"""What the results of a run must fulfil before they count: balance of each position and of the pitch."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from evolvent.gears.solution.certificates import balance_error, pitch_imbalance
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.errors import ResultError

BALANCE_LIMIT = 1e-2
"""Largest energy imbalance of a pitch, over its input energy."""
STORED_LIMIT = 0.1
"""Largest power that the teeth of a position store or release, over the input power; beyond it strains are not small.
"""
REMEDY = (
    "where a tip's edge bears relieve it (tip_relief_um) or lower the torque, else refine the sweep (sweep.positions) "
    "or the mesh (mesh.level)"
)


class BalanceError(ResultError):
    """A converged position or pitch that is out of balance."""


class PitchImbalance(BalanceError):
    """Every position is in balance, but the pitch does not conserve energy."""


def certify(results: Iterable[PositionResult]) -> None:
    """Raises BalanceError where one of the positions exceeds `STORED_LIMIT`."""
    for result in results:
        error = balance_error(result)
        if not error <= STORED_LIMIT:
            raise BalanceError(
                f"pinion at {result.stand.angle:.4f} rad, μ = {result.friction}: wanted a balance error of at most "
                f"{STORED_LIMIT}, found {error:.2e}; {REMEDY}"
            )


def certify_pitch(positions: Iterable[Sequence[PositionResult]]) -> None:
    """Raises PitchImbalance where the pitch exceeds `BALANCE_LIMIT` at one of the friction coefficients.

    positions: all of the pitch, each with one result per friction coefficient.
    """
    for results in zip(*positions, strict=True):
        error = pitch_imbalance(results)
        if not error <= BALANCE_LIMIT:
            raise PitchImbalance(
                f"the pitch at μ = {results[0].friction}: wanted an energy balance within {BALANCE_LIMIT} of the "
                f"input, found {error:.2e}; {REMEDY}"
            )
