"""p0, torque and transmission error of the Nitsche method do not depend on its parameters: γ over its limit, and θ.

The gear pair is He's. Its sweep uses θ = 1 alone; θ is varied on the same gears as bodies of the public API, which
share no part of that path but the contact law, and on the cylinder.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from mpi4py import MPI

from evidence.claims import Claim, Reference
from evidence.stress.gear_steps import spur_scene
from evidence.stress.matrix import Cylinder
from evidence.stress.sheets import Cell
from evidence.stress.theta_pair import ThetaPair
from evolvent.contact.nitsche.flux_recovery import SAFETY
from evolvent.contact.problem.definition import Nitsche
from evolvent.fem.condensation.schur_complement import NotPositiveDefinite
from evolvent.gears.condensed_gear import condensed_gear
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.results.contact_slices import slices
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member

SAFETIES = (1.1, 1.25, 2.0, 5.0, 20.0, 50.0)
THETAS = (1.0, 0.0, -1.0)
ROTATIONS = np.radians((2.0, 2.2, 2.4, 2.6))  # no tip edge bears
LEVELS = ("standard", "fine")
"""Element sizes: p0 is fitted to the pressures of 3 and of 6 elements, and what γ changes is the error of that."""
CHANGE = 5e-3
MOST_ITERATIONS = 8.0
QUANTITIES = ("peak", "p0 [MPa]"), ("torque", "wheel torque [N]"), ("error", "TE [mm]")
SOURCE = "the same problem with the default γ and θ = 1"


@dataclass(frozen=True)
class Figures:
    """Means over the positions: fitted p0 [MPa], wheel torque [N], transmission error [mm]; iterations a position."""

    peak: float
    torque: float
    error: float
    iterations: float


@cache
def gear_figures(safety: float, friction: float = 0.1, level: str = LEVELS[0]) -> Figures:
    """He's pair, with γ at `safety` times the inverse-trace constant; NaN where the stiffness is not positive definite,
    so that the claims fail."""
    scene = spur_scene(f"mesh.level={level}")
    try:
        model = _model(safety, level)
    except NotPositiveDefinite:
        return Figures(np.nan, np.nan, np.nan, np.nan)
    swept = sweep_pitch(model, Pitch(tuple(ROTATIONS)), [friction], initial_state([friction]))
    results = [position.results[0] for position in swept]
    cuts = [slices(result, model.bodies[0].z, scene.materials()) for result in results]
    return Figures(
        float(np.mean([np.nanmax(cut.peak) for cut in cuts])),
        float(np.mean([result.torques[1] for result in results])),
        float(np.mean([result.transmission_error for result in results])),
        float(np.mean([result.iterations for result in results])),
    )


@cache
def _model(safety: float, level: str) -> GearModel:
    """He's pair, frictionless or not, with another γ on the pinion."""
    scene = spur_scene(f"mesh.level={level}")
    model = prepare_model(gear_problem(scene), MPI.COMM_SELF).model
    pinion, wheel = model.bodies
    material, teeth = scene.materials()[Member.PINION], list(model.teeth)
    other = condensed_gear(pinion.gear, pinion.mesh, material, teeth, Member.PINION, True, safety)
    return replace(model, bodies=(other, wheel))


def gear_claims(safeties: tuple[float, ...] = SAFETIES) -> list[Claim]:
    """p0, torque and transmission error at each γ against those at the default."""
    return [claim for level in LEVELS for safety in safeties for claim in _gear_claims(safety, level)]


def _gear_claims(safety: float, level: str) -> list[Claim]:
    found, wanted = (gear_figures(own, level=level) for own in (safety, SAFETY))
    return [
        Claim.relative(
            f"{quantity}, spur pair, {level}, γ = {safety:g} C", getattr(found, name), getattr(wanted, name), CHANGE,
            Reference.REGRESSION, SOURCE,
        )
        for name, quantity in QUANTITIES
    ]  # fmt: skip


def theta_claims(
    level: str = LEVELS[1], safety: float = SAFETY, thetas: tuple[float, ...] = THETAS
) -> list[Claim]:
    """p0, torque and transmission error of the pair at each θ against the sweep's, which has θ = 1."""
    wanted = gear_figures(safety, level=level)
    return [claim for theta in thetas for claim in _theta_claims(theta, safety, level, wanted)]


def _theta_claims(theta: float, safety: float, level: str, wanted: Figures) -> list[Claim]:
    found = ThetaPair(level, Nitsche(safety, theta)).figures(ROTATIONS)
    means = {name: float(np.mean([getattr(one, name) for one in found])) for name, _ in QUANTITIES}
    return [
        Claim.relative(
            f"{quantity}, spur pair as two bodies, {level}, γ = {safety:g} C, θ = {theta:g}", means[name],
            getattr(wanted, name), CHANGE, Reference.REGRESSION, "the sweep of the gear pair, θ = 1",
        )
        for name, quantity in QUANTITIES
    ]  # fmt: skip


def cylinder_claims(safeties: tuple[float, ...] = SAFETIES, thetas: tuple[float, ...] = THETAS) -> list[Claim]:
    """p0 of the cylinder against Hertz at each γ and θ."""
    return [
        Claim.bound(
            f"relative error of p0, cylinder, γ = {safety:g} C, θ = {theta:g}",
            _solved(safety, theta).error, CHANGE, Reference.ANALYTICAL, "Hertz",
        )
        for safety in safeties for theta in thetas
    ]  # fmt: skip


@cache
def _solved(safety: float, theta: float) -> Cell:
    return replace(Cylinder(), safety=safety, theta=theta).cell()


def iteration_claims() -> list[Claim]:
    """Mean Newton iterations a position with friction, on the spur pair at the default γ."""
    return [
        Claim.bound(
            f"Newton iterations a position, spur pair, μ = {friction}", gear_figures(SAFETY, friction).iterations,
            MOST_ITERATIONS, Reference.REGRESSION, "the bar of docs/evidence.md",
        )
        for friction in (0.1, 0.3)
    ]  # fmt: skip
