"""Result of a converged position at one friction coefficient."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.contact_points import ContactPoints, contact_points
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class PositionResult:
    """A converged position at one friction coefficient.

    stand: where the gears stand, with the free rotation.
    friction: μ.
    torques: (pinion, wheel), moments of the contact forces about the axes [N·mm; per mm of width in 2D].
    contact: the quadrature points under pressure.
    tooth: (n,), tooth pair of each node of the pinion's flanks within the window.
    node: (n,), number of that node on its flank.
    weights: (n,), area m of each node [mm²; mm in 2D].
    traction: (n, d), λ, τ averaged at the nodes, for pictures [MPa]; Σ m t is the whole force.
    iterations: Newton's, of all stages.
    residual: of the forces, relative.
    stiffness: tangent of the frictionless mesh along the line of action [N/mm; per mm of width in 2D], see
        tangent_stiffness.py.
    pinion_rows: (m, 2), rows (tooth, node) of the pinion's compliance that carry load.
    wheel_rows: (m, 2), of the wheel's.
    pinion_forces: (m, d), forces on them in the pinion's own frame [N; per mm of width in 2D].
    wheel_forces: (m, d), in the wheel's.
    seconds: wall time.
    driving: the gear that drives.
    """

    stand: PairRotation
    friction: float
    torques: tuple[float, float]
    contact: ContactPoints
    tooth: Ints
    node: Ints
    weights: Floats
    traction: Floats
    iterations: int
    residual: float
    stiffness: float
    pinion_rows: Ints
    wheel_rows: Ints
    pinion_forces: Floats
    wheel_forces: Floats
    seconds: float = 0.0
    driving: Member = Member.PINION

    @property
    def pressure(self) -> Floats:
        """Averaged contact pressure λ (n,) [MPa]."""
        return self.traction[:, 0]

    @property
    def transmission_error(self) -> float:
        """Transmission error r_b1 φ_1 − r_b2 φ_2 [mm]."""
        return self.stand.transmission_error

    def load_share(self, pair: int) -> float:
        """Part of the normal force that a tooth pair bears; NaN where none does."""
        forces = self.contact.pressure * self.contact.weights
        total = float(forces.sum())
        return float(forces[self.contact.tooth == pair].sum()) / total if total else math.nan

    @property
    def friction_loss(self) -> float:
        """Power lost to friction per rad/s of pinion speed [N·mm; per mm of width in 2D]."""
        c = self.contact
        k = c.traction.shape[1]
        return self.driving.sign * float(np.sum(c.weights[:, None] * c.traction[:, 1:] * c.rate[:, 1:k]))

    @property
    def input_power(self) -> float:
        """Power on the gear that drives, per rad/s of pinion speed [N·mm; per mm of width in 2D]."""
        pinion, wheel = self.torques
        return pinion if self.driving is Member.PINION else wheel / self.stand.pair.ratio

    @property
    def stored_power(self) -> float:
        """Input − output − friction power per rad/s of pinion speed [N·mm; per mm of width in 2D]: what the deflected
        teeth store, or give back where it is negative. Over a whole pitch it is zero."""
        passed = self.torques[0] - self.torques[1] / self.stand.pair.ratio
        return self.driving.sign * passed - self.friction_loss


def position_result(
    model: GearModel, contact: GearContact, equilibrium: Equilibrium, friction: float, stiffness: float,
    frictionless_iterations: int,
) -> PositionResult:
    """Result of a converged state. stiffness: tangent of the frictionless mesh along the line of action [N/mm; per mm
    of width in 2D]."""
    geometry, k = contact.geometry, equilibrium.force.shape[1]
    torques = [float(np.sum(spin[:, :k] * equilibrium.force)) for spin in geometry.spins]
    weights, traction = contact.operator.averaged(equilibrium.traction)
    stand = geometry.stand.turned(model.load.on, float(equilibrium.motion[0]))
    loaded = (_loaded_rows(geometry, gear, equilibrium) for gear in Member)
    (pinion_rows, pinion_forces), (wheel_rows, wheel_forces) = loaded
    iterations = equilibrium.iterations + (frictionless_iterations if model.has_friction_terms(friction) else 0)
    return PositionResult(
        stand=stand,
        friction=friction,
        torques=(torques[0], torques[1]),
        contact=contact_points(geometry, equilibrium.traction, friction, stand.beyond_nominal),
        tooth=geometry.node_tooth,
        node=geometry.node,
        weights=weights,
        traction=traction,
        iterations=iterations,
        residual=equilibrium.residual / (float(np.sum(equilibrium.force[:, 0])) or 1.0),  # nothing touches in flight
        stiffness=stiffness,
        pinion_rows=pinion_rows,
        wheel_rows=wheel_rows,
        pinion_forces=pinion_forces,
        wheel_forces=wheel_forces,
        driving=model.load.driving,
    )


def _loaded_rows(geometry: ContactGeometry, gear: Member, equilibrium: Equilibrium) -> tuple[Ints, Floats]:
    """Rows (m, 2) of a gear's compliance that carry load, and the forces (m, d) on them."""
    rows, forces = geometry.rows(gear)[0], geometry.flank_forces(gear, equilibrium.force)
    loaded = forces.any(axis=1)
    return rows[loaded], forces[loaded]


@dataclass(frozen=True, eq=False)
class NodalForces:
    """Forces on the flank nodes of a gear at n positions."""

    rows: Ints
    """Tooth and flank node (k, 2) of the nodes that bear load at some position, ascending."""
    forces: Floats
    """Forces (n, k, d) in the gear's own frame [N; per mm of width in 2D]."""


def nodal_forces(results: Sequence[PositionResult], member: Member) -> NodalForces:
    """Forces on the pinion's or the wheel's flank nodes at all positions."""
    pinion = member is Member.PINION
    rows = [each.pinion_rows if pinion else each.wheel_rows for each in results]
    forces = [each.pinion_forces if pinion else each.wheel_forces for each in results]
    every, place = np.unique(np.concatenate(rows), axis=0, return_inverse=True)
    whole = np.zeros((len(results), len(every), forces[0].shape[1]))
    whole[np.repeat(np.arange(len(rows)), [len(own) for own in rows]), place.ravel()] = np.concatenate(forces)
    return NodalForces(every, whole)
