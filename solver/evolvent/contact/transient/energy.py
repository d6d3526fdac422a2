"""The energy of moving bodies in contact, the work that is done on them, and both against each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.transient.body_motion import BodyMotion
from evolvent.contact.transient.moving_response import MovingResponse
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError

GROWTH = 0.02
"""Of the largest energy so far: by how much it may seem to grow. Within a blow the sum of energies at the ends of time
steps swings by 0.4 % with 20 steps a blow of a ball, 0.05 % with 40."""

KEPT = 1e-8
"""Of the largest energy so far: by how much it may be off with a scheme that conserves it."""


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

    @staticmethod
    def of(motions: Sequence[BodyMotion], contact: float) -> Energy:
        """Of these bodies, with what is stored in their contacts."""
        parts = [_motion_energy(motion) for motion in motions]
        kinetic, elastic = (sum(each) for each in zip(*parts))
        elastic += sum(_rest_energy(motion.response, motion.forces) for motion in motions)
        return Energy(kinetic, elastic, contact)


def _motion_energy(motion: BodyMotion) -> tuple[float, float]:
    """Kinetic energy, and elastic energy of the modes, of one body."""
    system, v, z = motion.response.body.system, motion.state.velocity, motion.state.position
    return 0.5 * float(v @ system.mass @ v), 0.5 * float(z @ (system.stiffness * z))


def _rest_energy(response: MovingResponse, forces: Floats) -> float:
    """Elastic energy of the static rest of one body under forces on its functionals (k,)."""
    body = response.body
    loaded = body.load_response(response.factor, response.resultant)
    return float(0.5 * forces @ (body.rest @ forces) + forces @ loaded + 0.5 * _own(response))


def contact_energy(contacts: Sequence[ContactResult]) -> float:
    """∫ λ²/2γ of all contacts."""
    return sum(stored_energy(c.weights, c.pressure, c.paired.operator.stabiliser[:, 0]) for c in contacts)


def stored_energy(weights: Floats, pressure: Floats, stabiliser: Floats) -> float:
    """∫ λ²/2γ over points (q,) with these weights, pressures λ and γ."""
    return 0.5 * float(np.sum(weights * pressure**2 / stabiliser))


def load_work(before: BodyMotion, after: BodyMotion) -> float:
    """Work of one body's loads over a step, by the trapezoidal rule: exact for loads that stay."""
    body, count = after.response.body, after.response.body.count
    work = 0.0
    moved = after.state.position - before.state.position
    for response in (before.response, after.response):
        load, resultant = response.factor, response.resultant
        work += 0.5 * float(body.modal_load(load, resultant) @ moved[:count] + resultant @ moved[count + body.free])
        work += 0.5 * float(body.load_response(load, resultant) @ (after.forces - before.forces))
    return work + 0.5 * (_own(after.response) - _own(before.response))


def driving_work(before: BodyMotion, after: BodyMotion) -> float:
    """Work over a step of what moves one body's prescribed motions, by the trapezoidal rule."""
    held = after.response.held
    moved = after.state.position[held] - before.state.position[held]
    return 0.5 * float((before.driving + after.driving) @ moved)


def lag_work(before: BodyMotion, after: BodyMotion) -> float:
    """What the time scheme adds to one body's energy over a step beyond the work, −½ Δzᵀ M Δlag.

    Follows from the equation of motion at both ends and Δv = h ((1 − γ) a_n + γ a_{n+1}), γ = ½ − α. It is of third
    order where the motion is smooth; a motion that begins with a jolt has 8 % of its energy from it at ρ_∞ = 0.8.
    """
    step = after.response.step
    lag = step.state.acceleration - (before.state.acceleration - before.lag)
    moved = after.state.position - before.state.position
    return -0.5 * float(moved @ step.system.mass @ (after.lag - lag))


def _own(response: MovingResponse) -> float:
    return response.body.load_compliance(response.factor, response.resultant)


class EnergyGrowth(ResultError):
    """The bodies have more energy than they had at the start and were given by loads and prescribed motions."""


class EnergyNotKept(ResultError):
    """The energy after a time step that is to conserve it is another one."""


@dataclass(frozen=True)
class EnergyBalance:
    """From the start to one time [N·mm; N in 2D]."""

    first: float
    """Energy at the start."""
    largest: float
    """Largest energy so far."""
    work: float = 0.0
    """Of all loads and of what moves the prescribed motions."""
    added: float = 0.0
    """By the time scheme, see `lag_work`; of one that conserves energy, what damping has taken, negative."""

    def after(self, energy: float, work: float, added: float) -> EnergyBalance:
        """After a step with this energy at its end, in which this work was done, and so much added by the scheme."""
        return EnergyBalance(self.first, max(self.largest, energy), self.work + work, self.added + added)

    def seen(self, energy: float) -> EnergyBalance:
        """After a step that is not accepted, but shows what energy there will be: at a start from rest there is none to
        compare errors with."""
        return replace(self, largest=max(self.largest, energy))

    def left(self, energy: float) -> float:
        """Of an energy: what is beyond that of the start, the work, and what the scheme has added."""
        return energy - self.first - self.work - self.added

    def certify(self, energy: float, time: float) -> None:
        """Raises EnergyNotKept for an energy at a time [s] that is not all of it, of a scheme that conserves it."""
        left = self.left(energy)
        if not abs(left) <= KEPT * self.largest:
            raise EnergyNotKept(
                f"transient at {time:.4g} s: wanted the energy of the start and the work that was done, to {KEPT:g} of "
                f"the largest, found {left / self.largest if self.largest else left:+.1e} of it more; take a shorter "
                "time step, or leave out conserving"
            )

    def refuse_growth(self, energy: float, time: float) -> None:
        """Raises EnergyGrowth for an energy at a time [s] beyond all that. What the scheme has taken is not claimed."""
        gained = energy - self.first - self.work - max(self.added, 0.0)
        if gained > GROWTH * self.largest:
            raise EnergyGrowth(
                f"transient at {time:.4g} s: wanted at most the energy of the start and the work that was done, found "
                f"{gained / self.largest:.1%} more; take shorter time steps, or a smaller spectral_radius"
            )
