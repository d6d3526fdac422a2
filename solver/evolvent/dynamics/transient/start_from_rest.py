"""Initial state of a transient that begins with an impact: one gear at its speed at once, the other one at rest.

The flanks just touch, without load. The nominal rotation has both gears turn; a gear at rest lags behind it, by the
speed of the line of action: r_b1 φ_1 − r_b2 φ_2 grows at r_b1 ω_1. The bodies do not vibrate, and all torques and the
damping of the mesh act from then on, so that M a = p − D v at once. Where both gears are free it is their speed of
approach; the nominal rotation is then that of both together, after the impact.
"""

from __future__ import annotations

import numpy as np

from evolvent.contact.transient.time_schemes.time_scheme import KinematicState
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_state import PairState
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.friction_history import FrictionHistory
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error


def start_from_rest(pair: MovingPair, problem: GearProblem, speed: float, friction: float) -> PairState:
    """State at pinion rotation 0 with one gear at its speed and the other one at rest.

    problem: of the pair. speed: of the pinion [rad/s]. friction: μ.
    """
    flanks = RigidFlanks(problem.pair, problem.flanks)
    (touching,) = unloaded_error(flanks, np.zeros(1), problem.torque_on)
    rest = np.zeros(pair.count)
    position = np.append(rest, touching / pair.lever)
    velocity = np.append(rest, speed * pair.base_radii[0] / pair.lever)
    load = np.append(rest, pair.drive.torque)
    acceleration = np.linalg.solve(pair.system.mass, load - pair.system.damping * velocity)
    stand = PairRotation(pair.model.pair, 0.0, pair.drive.rotations(float(position[-1])))
    history = _untouched(stand, pair.model.bodies[0].d) if friction else None
    return PairState(KinematicState(position, velocity, acceleration), history, rest)


def _untouched(stand: PairRotation, d: int) -> FrictionHistory:
    """Friction history of flanks that have not been in contact. d: dimension of space."""
    rows, nothing = np.zeros((0, 2), dtype=int), np.zeros((0, d))
    return FrictionHistory(stand, (rows, rows), (nothing, nothing), nothing)
