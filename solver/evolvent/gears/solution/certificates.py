"""Conditions on positions that count as results: balance of forces, and of energy over the pitch."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats
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


def balance_error(result: PositionResult) -> float:
    """The larger of two ratios at a position: force residual over load, stored power over input power.

    Stored power is no error by itself: deflected flanks are not conjugate, and where a tip edge bears, the strain
    energy of the teeth changes by up to some hundredths of the input. Over a pitch it must cancel (`pitch_imbalance`).
    """
    return max(result.residual, abs(result.stored_power) / abs(result.input_power))


def pitch_imbalance(results: Sequence[PositionResult]) -> float:
    """Energy imbalance |input − output − friction work| / input over equal steps of a whole pitch, at one friction
    coefficient.

    After a pitch the teeth are deflected as before it, so no energy is stored. What remains is the error of normals
    taken before deflection: it falls with the load, not with the mesh (7e-4 where the contact's half-width is 3 % of
    the radius of curvature and tips bear; a fifteenth of that at a tenth of the load, and on deflected flanks).
    """
    return float(energy_imbalance([r.stored_power for r in results], [r.input_power for r in results]))


def energy_imbalance(stored: ArrayLike, given: ArrayLike) -> Floats:
    """Energy imbalance of a pitch, over its input energy, from stored powers (n, ...) and input powers per rad/s of
    the pinion's speed (n, ...) at n positions."""
    return np.asarray(np.abs(np.sum(stored, axis=0)) / np.sum(np.abs(given), axis=0))


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
        require_balance(pitch_imbalance(results), f"at μ = {results[0].friction}")


def require_balance(imbalance: float, where: str) -> None:
    """Raises PitchImbalance where an energy imbalance exceeds `BALANCE_LIMIT`. where: friction coefficient or torque of
    the pitch."""
    if not imbalance <= BALANCE_LIMIT:
        raise PitchImbalance(
            f"the pitch {where}: wanted an energy balance within {BALANCE_LIMIT} of the input, found {imbalance:.2e}; "
            f"{REMEDY}"
        )
