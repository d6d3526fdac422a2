"""The energy of moving bodies in contact, and what has become of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.transient.moving_response import MovingResponse
from evolvent.contact.transient.time_scheme import LinearSystem, MotionState
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class Energy:
    """Of all bodies at one time [N·mm; N in 2D]."""

    kinetic: float
    """Of rigid motions and modes."""
    elastic: float
    """Of modes and of the static rest."""
    contact: float
    """What Nitsche's method stores in the contacts, ∫ λ²/2γ less the flux in the bodies' stiffness; it goes to zero
    with the size of the cells."""

    @property
    def total(self) -> float:
        """Sum of all."""
        return self.kinetic + self.elastic + self.contact


def motion_energy(system: LinearSystem, state: MotionState) -> tuple[float, float]:
    """Kinetic energy, and elastic energy of the modes, of one body."""
    v, z = state.velocity, state.position
    return 0.5 * float(v @ system.mass @ v), 0.5 * float(z @ (system.stiffness * z))


def rest_energy(response: MovingResponse, forces: Floats) -> float:
    """Elastic energy of the static rest of one body under forces on its functionals (k,)."""
    body = response.body
    loaded = body.load_response(response.factor, response.resultant)
    own = body.load_compliance(response.factor, response.resultant)
    return float(0.5 * forces @ (body.rest @ forces) + forces @ loaded + 0.5 * own)


def contact_energy(contacts: Sequence[ContactResult]) -> float:
    """∫ λ²/2γ of all contacts."""
    return sum(
        0.5 * float(np.sum(c.weights * c.pressure**2 / c.paired.operator.stabiliser[:, 0])) for c in contacts
    )


def load_work(before: MovingResponse, after: MovingResponse, states: tuple[MotionState, MotionState],
              forces: tuple[Floats, Floats]) -> float:  # fmt: skip
    """Work of one body's loads over a step, by the trapezoidal rule: exact for loads that stay."""
    body, count = after.body, after.body.count
    work = 0.0
    moved = states[1].position - states[0].position
    for response in (before, after):
        load, resultant = response.factor, response.resultant
        work += 0.5 * float(body.modal_load(load, resultant) @ moved[:count] + resultant @ moved[count + body.free])
        work += 0.5 * float(body.load_response(load, resultant) @ (forces[1] - forces[0]))
    return work + 0.5 * (_own(after) - _own(before))


def _own(response: MovingResponse) -> float:
    return response.body.load_compliance(response.factor, response.resultant)
