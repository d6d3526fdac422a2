"""p0, torque and transmission error of the Nitsche method do not depend on its parameters: γ over its limit, and θ.

The gear pair is He's. Its sweep uses θ = 1 alone; θ is varied on the same gears as bodies of the public API, which
share no part of that path but the contact law, and on the cylinder.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from mpi4py import MPI

from evidence.claims import Claim, Source, analytical, regression
from evidence.robustness.settings.matrix import Cylinder
from evidence.robustness.settings.sheets import Cell
from evidence.robustness.settings.theta_pair import ThetaPair
from evidence.scenes import spur_pair
from evolvent.contact.nitsche.flux_recovery import SAFETY
from evolvent.contact.problem.definition import Nitsche
from evolvent.fem.condensation.schur_complement import NotPositiveDefinite
from evolvent.gears.condensed_gear import condensed_gear
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.pressure.contact_slices import slices
from evolvent.gears.pressure.pitch_pressure import facets_of
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
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
SOURCE = regression("the same problem with the default γ and θ = 1")
FIGURES = "peak", "torque", "error", "iterations"


@dataclass(frozen=True)
class Figures:
    """Means over the positions."""

    peak: float
    """Fitted p0 [MPa]."""
    torque: float
    """That holds the wheel [N]: per mm of face width."""
    error: float
    """Transmission error [mm]."""
    iterations: float
    """Of Newton's method."""


@cache
def gear_figures(safety: float, friction: float = 0.1, level: str = LEVELS[0]) -> Figures:
    """He's pair, with γ at `safety` times the inverse-trace constant; NaN where the stiffness is not positive definite,
    so that the claims fail."""
    scene = spur_pair(f"mesh.level={level}")
    try:
        model = _model(safety, level)
    except NotPositiveDefinite:
        return Figures(np.nan, np.nan, np.nan, np.nan)
    swept = sweep_pitch(model, Pitch(tuple(ROTATIONS)), [friction], initial_state([friction]))
    results = [position.results[0] for position in swept]
    cuts = [slices(result, facets_of(model), scene.materials()) for result in results]
    return Figures(
        float(np.mean([np.nanmax(cut.peak) for cut in cuts])),
        float(np.mean([result.torques[1] for result in results])),
        float(np.mean([result.transmission_error for result in results])),
        float(np.mean([result.iterations for result in results])),
    )


@cache
def _model(safety: float, level: str) -> GearModel:
    """He's pair, frictionless or not, with another γ on the pinion."""
    scene = spur_pair(f"mesh.level={level}")
    model = prepare_model(gear_problem(scene), MPI.COMM_SELF).model
    pinion, wheel = model.bodies
    material, teeth = scene.materials()[Member.PINION], list(model.teeth)
    other = condensed_gear(pinion.gear, pinion.mesh, material, teeth, Member.PINION, True, safety)
    return replace(model, bodies=(other, wheel))


def gear_claims(safeties: tuple[float, ...] = SAFETIES) -> list[Claim]:
    """p0, torque and transmission error at each γ against those at the default."""
    return [claim for level in LEVELS for safety in safeties for claim in _gear_claims(safety, level)]


def _gear_claims(safety: float, level: str) -> list[Claim]:
    found, wanted = (gear_figures(γ, level=level) for γ in (safety, SAFETY))
    return _figure_claims(SOURCE, f"spur pair, {level}, γ = {safety:g} C", found, wanted)


def _figure_claims(source: Source, where: str, found: Figures, wanted: Figures) -> list[Claim]:
    return [
        source.relative(f"{quantity}, {where}", getattr(found, name), getattr(wanted, name), CHANGE)
        for name, quantity in QUANTITIES
    ]


def theta_claims(level: str = LEVELS[1], safety: float = SAFETY, thetas: tuple[float, ...] = THETAS) -> list[Claim]:
    """p0, torque and transmission error of the pair at each θ against the sweep's, which has θ = 1."""
    wanted, source = gear_figures(safety, level=level), regression("the sweep of the gear pair, θ = 1")
    claims = []
    for theta in thetas:
        figures = ThetaPair(level, Nitsche(safety, theta)).figures(ROTATIONS)
        means = Figures(*(float(np.mean([getattr(one, name) for one in figures])) for name in FIGURES))
        where = f"spur pair as two bodies, {level}, γ = {safety:g} C, θ = {theta:g}"
        claims += _figure_claims(source, where, means, wanted)
    return claims


def cylinder_claims(safeties: tuple[float, ...] = SAFETIES, thetas: tuple[float, ...] = THETAS) -> list[Claim]:
    """p0 of the cylinder against Hertz at each γ and θ."""
    what = "relative error of p0, cylinder, γ = {:g} C, θ = {:g}"
    pairs = [(safety, theta) for safety in safeties for theta in thetas]
    return [analytical("Hertz").bound(what.format(*pair), _solved(*pair).error, CHANGE) for pair in pairs]


@cache
def _solved(safety: float, theta: float) -> Cell:
    return replace(Cylinder(), safety=safety, theta=theta).cell()


def iteration_claims() -> list[Claim]:
    """Mean Newton iterations a position with friction, on the spur pair at the default γ."""
    what, bar = "Newton iterations a position, spur pair, μ = {}", regression("the bar of docs/evidence.md")
    return [bar.bound(what.format(μ), gear_figures(SAFETY, μ).iterations, MOST_ITERATIONS) for μ in (0.1, 0.3)]
