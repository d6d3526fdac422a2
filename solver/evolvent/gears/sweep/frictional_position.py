"""Equilibrium of a gear position with friction, for one of several coefficients."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.equilibrium import Equilibrium, InitialGuess, frictional, with_components
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.friction_history import PreviousJump
from evolvent.gears.sweep.position_result import PositionResult, position_result
from evolvent.gears.sweep.position_search import SharedPosition
from evolvent.gears.sweep.slip import slip_direction, slip_increment
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class Solved:
    """A position solved at one friction coefficient.

    friction: μ.
    equilibrium: the converged state.
    """

    friction: float
    equilibrium: Equilibrium


def solve_position(
    model: GearModel, shared: SharedPosition, friction: float, before: PreviousJump | None, span: float,
    solved: Sequence[Solved] = (), near: InitialGuess | None = None,
) -> tuple[PositionResult, Solved]:
    """Equilibrium with friction.

    before: friction history at the contact's nodes, None without friction.
    span: Δφ since then [rad], negative where the wheel drives.
    solved: the same position at other coefficients, to start from where the friction before is not known; the nearest
        ones last.
    near: a guess of the solution, taken instead.

    Raises NotConverged.
    """
    contact, equilibrium = shared.contact, shared.smooth
    if before is not None:
        guess = near
        if guess is None and before.pattern is None:
            guess = extrapolated_guess(friction, [Solved(0.0, shared.smooth), *solved])
        equilibrium = frictional_equilibrium(
            contact.geometry, shared.system, friction, shared.smooth, before, span, guess
        )
    result = position_result(model, contact, equilibrium, friction, shared.stiffness, shared.smooth.iterations)
    return result, Solved(friction, equilibrium)


def frictional_equilibrium(
    geometry: ContactGeometry, system: CondensedSystem, friction: float, smooth: Equilibrium,
    before: PreviousJump, span: float, guess: InitialGuess | None = None,
) -> Equilibrium:
    """Equilibrium with friction after a step Δφ = span [rad]. smooth: the one without friction; before: friction
    history at the contact's nodes; guess: of the solution. Raises NotConverged."""
    slip = slip_increment(geometry, before, span)
    return frictional(system, friction, slip, _expected_direction(geometry, friction, before, span), smooth, guess)


def _expected_direction(geometry: ContactGeometry, friction: float, before: PreviousJump, span: float) -> Floats:
    """Friction (q, d−1) over its bound with which Newton's method starts: as at the position before, where it was in
    the known direction of sliding, or where that is not known; else full sliding in that direction."""
    known = slip_direction(geometry, span)
    if before.pattern is None or friction == 0.0:  # friction terms may be kept without friction
        return known
    earlier = before.pattern.at(geometry) / friction
    agrees = np.einsum("qa,qa->q", earlier, known) > 0.0
    return np.where((agrees | ~known.any(axis=1))[:, None], earlier, known)


def extrapolated_guess(friction: float, solved: Sequence[Solved]) -> InitialGuess | None:
    """Forces and motions on the straight line through the last two coefficients, as sliding friction is nearly linear
    in them; None where there is but one, or both are the same."""
    if len(solved) < 2 or solved[-1].friction == solved[-2].friction:
        return None
    older, last = solved[-2:]
    share = (friction - last.friction) / (last.friction - older.friction)
    earlier = with_components(older.equilibrium.force, last.equilibrium.force.shape[1])
    force = last.equilibrium.force + share * (last.equilibrium.force - earlier)
    motion = last.equilibrium.motion + share * (last.equilibrium.motion - older.equilibrium.motion)
    return InitialGuess(force, motion)
