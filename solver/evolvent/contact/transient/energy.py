"""Energy of moving bodies in contact, the work done on them, and the balance of both."""

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
"""Apparent growth of the energy, over the largest so far, that is accepted. Within a blow the sum of energies at the
ends of time steps swings by 0.4 % with 20 steps a blow of a ball, 0.05 % with 40."""

KEPT = 1e-8
"""Accepted error of the energy, over the largest so far, with a scheme that conserves it."""


@dataclass(frozen=True)
class Energy:
    """Energy of all bodies at one time [N·mm; N in 2D]."""

    kinetic: float
    """Kinetic energy of rigid motions and modes."""
    elastic: float
    """Elastic energy of the modes and of the static response of the others."""
    contact: float
    """Energy that Nitsche's method stores in the contacts, ∫ λ²/2γ less the flux in the bodies' stiffness; it goes to
    zero with the size of the cells."""

    @property
    def total(self) -> float:
        """Sum of kinetic, elastic and contact energy."""
        return self.kinetic + self.elastic + self.contact

    @staticmethod
    def of(motions: Sequence[BodyMotion], contact: float) -> Energy:
        """Energy of bodies in motion. contact: energy stored in their contacts."""
        parts = [_motion_energy(motion) for motion in motions]
        kinetic, elastic = (sum(each) for each in zip(*parts))
        elastic += sum(_rest_energy(motion.response, motion.forces) for motion in motions)
        return Energy(kinetic, elastic, contact)


def _motion_energy(motion: BodyMotion) -> tuple[float, float]:
    """Kinetic energy of one body, and elastic energy of its modes."""
    system, v, z = motion.response.body.system, motion.state.velocity, motion.state.position
    return 0.5 * float(v @ system.mass @ v), 0.5 * float(z @ (system.stiffness * z))


def _rest_energy(response: MovingResponse, forces: Floats) -> float:
    """Elastic energy of the static response of one body, without its modes, under forces on its functionals (k,)."""
    body = response.body
    loaded = body.load_response(response.factor, response.resultant)
    return float(0.5 * forces @ (body.rest @ forces) + forces @ loaded + 0.5 * _own(response))


def contact_energy(contacts: Sequence[ContactResult]) -> float:
    """Energy ∫ λ²/2γ of all contacts."""
    return sum(stored_energy(c.weights, c.pressure, c.paired.operator.stabiliser[:, 0]) for c in contacts)


def stored_energy(weights: Floats, pressure: Floats, stabiliser: Floats) -> float:
    """Energy ∫ λ²/2γ over points (q,) with these weights, pressures λ and stabilisers γ."""
    return 0.5 * float(np.sum(weights * pressure**2 / stabiliser))


def load_work(before: BodyMotion, after: BodyMotion) -> float:
    """Work of one body's loads over a step, by the trapezoidal rule: exact for constant loads."""
    body, count = after.response.body, after.response.body.count
    work = 0.0
    moved = after.state.position - before.state.position
    for response in (before.response, after.response):
        load, resultant = response.factor, response.resultant
        work += 0.5 * float(body.modal_load(load, resultant) @ moved[:count] + resultant @ moved[count + body.free])
        work += 0.5 * float(body.load_response(load, resultant) @ (after.forces - before.forces))
    return work + 0.5 * (_own(after.response) - _own(before.response))


def driving_work(before: BodyMotion, after: BodyMotion) -> float:
    """Work over a step of the forces that drive one body's prescribed motions, by the trapezoidal rule."""
    held = after.response.held
    moved = after.state.position[held] - before.state.position[held]
    return 0.5 * float((before.driving + after.driving) @ moved)


def lag_work(before: BodyMotion, after: BodyMotion) -> float:
    """Energy that the time scheme adds to one body over a step beyond the work, −½ Δzᵀ M Δlag.

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
    """The energy after a step of a conserving time scheme differs from the balance."""


@dataclass(frozen=True)
class EnergyBalance:
    """Energy balance from the start to one time [N·mm; N in 2D]."""

    first: float
    """Energy at the start."""
    largest: float
    """Largest energy so far."""
    work: float = 0.0
    """Work of all loads and of the forces that drive the prescribed motions."""
    added: float = 0.0
    """Energy added by the time scheme, see `lag_work`. With a conserving scheme it is the energy dissipated by damping,
    negative."""

    def after(self, energy: float, work: float, added: float) -> EnergyBalance:
        """Balance after a step. energy: at its end. work, added: work done in it, and energy added by the scheme."""
        return EnergyBalance(self.first, max(self.largest, energy), self.work + work, self.added + added)

    def seen(self, energy: float) -> EnergyBalance:
        """Balance with the largest energy of a step that is not accepted: at a start from rest there is no other energy
        to compare errors with."""
        return replace(self, largest=max(self.largest, energy))

    def left(self, energy: float) -> float:
        """Excess of an energy over that of the start, the work and the energy added by the scheme."""
        return energy - self.first - self.work - self.added

    def certify(self, energy: float, time: float) -> None:
        """Checks an energy at a time [s] of a conserving scheme. Raises EnergyNotKept where it is off the balance."""
        left = self.left(energy)
        if not abs(left) <= KEPT * self.largest:
            raise EnergyNotKept(
                f"transient at {time:.4g} s: wanted the energy of the start and the work that was done, to {KEPT:g} of "
                f"the largest, found {left / self.largest if self.largest else left:+.1e} of it more; take a shorter "
                "time step, or leave out conserving"
            )

    def refuse_growth(self, energy: float, time: float) -> None:
        """Raises EnergyGrowth for an energy at a time [s] beyond the balance. Energy that the scheme has dissipated is
        not counted."""
        gained = energy - self.first - self.work - max(self.added, 0.0)
        if gained > GROWTH * self.largest:
            raise EnergyGrowth(
                f"transient at {time:.4g} s: wanted at most the energy of the start and the work that was done, found "
                f"{gained / self.largest:.1%} more; take shorter time steps, or a smaller spectral_radius"
            )
