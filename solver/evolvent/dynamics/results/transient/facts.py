"""Figures of a pair's transient contact at each speed and friction coefficient, and sentences on them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from evolvent.dynamics.resolved_vibration import ENOUGH_STEPS, SEEN_STEPS, unresolved, unresolved_within, unseen
from evolvent.dynamics.results.transient.beginning import StartErrors
from evolvent.dynamics.results.transient.cases import UM, CasePressures
from evolvent.dynamics.results.transient.compared import FINER
from evolvent.dynamics.results.transient.curves import largest
from evolvent.dynamics.results.transient.errors import CaseErrors
from evolvent.gears.gear_model import GearModel
from evolvent.results.tables.table import Table
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class TransientFacts:
    """An entry of transient.json: a speed and friction coefficient."""

    speed_rpm: float
    """Speed of the pinion."""
    friction: float
    """Friction coefficient μ."""
    mesh_frequency_Hz: float
    """Mesh frequency: speed times number of teeth of the pinion."""
    mesh_periods: int
    """Number of mesh periods that were computed."""
    last_change: float | None
    """Change of the transmission error from the last but one mesh period to the last, over its peak-to-peak value; null
    for one period."""
    steady: bool
    """Whether the motion is steady: last_change is at most transient.steady_change."""
    modes: int
    """Number of natural modes of both gears together."""
    lowest_mode_Hz: float | None
    """Lowest natural frequency of the modes of both gears; null without modes."""
    natural_frequency_Hz: float
    """Natural frequency of the rotation of the gears on their mesh, by its mean tangent stiffness in statics, with the
    modes of both bodies: that of the natural mode of the pair which carries most of the transmission error under a
    change of the mesh force."""
    natural_frequency_Hz_error: float
    """Estimated error of the natural frequency by the mesh and the spacing of positions; null where there is no coarse
    companion (`output.error_bars`)."""
    steps_per_natural_period: float
    """Mean number of time steps in a period of natural_frequency_Hz; with fewer than twenty equal ones the vibration
    that the mesh excites at it is not resolved."""
    time_steps: int
    """Number of time steps in the last mesh period."""
    shortest_step_s: float
    """Shortest time step of the last mesh period; of a start from rest also of its first two mesh periods."""
    rejected_steps: int
    """Number of time steps of the last mesh period that were rejected and taken again in half; none without
    transient.tolerance."""
    step_error: float
    """Largest estimated error of the speeds in a time step of the last mesh period, as transient.tolerance bounds it;
    of a start from rest also of its first two mesh periods."""
    mean_force_N: float
    """Mean mesh force over the last mesh period."""
    load_N: float
    """Load along the line of action, to which mean_force_N is equal in a steady state. Where both gears are free,
    T_1/r_b1 and T_2/r_b2, which friction makes differ, weighed by I_2 r_b1² and I_1 r_b2²."""
    peak_to_peak_um: float
    """Peak-to-peak transmission error in the last mesh period."""
    peak_to_peak_um_error: float
    """Estimated error of the peak-to-peak transmission error by mesh, modes and time steps; null where there is no
    coarse companion (`output.error_bars`)."""
    static_peak_to_peak_um: float
    """Peak-to-peak transmission error without inertia."""
    static_peak_to_peak_um_error: float
    """Estimated error of the peak-to-peak transmission error without inertia, by the mesh and the spacing of positions;
    null where there is no coarse companion (`output.error_bars`)."""
    dynamic_factor: float
    """Largest mesh force over the load, at the ends of all time steps of the last mesh period; not K_v of ISO 6336-1.
    """
    dynamic_factor_error: float
    """Estimated error of the dynamic factor by mesh, modes and time steps; null where there is no coarse companion
    (`output.error_bars`)."""
    start_dynamic_factor: float | None
    """Largest mesh force over the load in the first two mesh periods from rest; null for a motion that begins with
    statics."""
    start_dynamic_factor_error: float | None
    """Estimated error of start_dynamic_factor by mesh, modes and time steps; null where there is no coarse companion
    (`output.error_bars`), and for a motion that begins with statics."""
    separated: float
    """Share of the positions of the last mesh period at which nothing touches."""
    max_pressure_MPa: float
    """Largest pressure of transient.csv, with inertia; null where none is known."""
    max_pressure_MPa_error: float
    """Estimated error of the largest pressure by mesh, modes, time steps and the spacing of positions; null where there
    is no coarse companion (`output.error_bars`)."""
    static_max_pressure_MPa: float
    """Largest pressure of transient.csv without inertia; null where none is known."""
    static_max_pressure_MPa_error: float
    """Estimated error of the largest pressure without inertia, by the mesh and the spacing of positions; null where
    there is no coarse companion (`output.error_bars`)."""
    momentum_error: float
    """Largest residual of the equations of motion at any time step, over the forces in them."""
    reaction_error: float
    """Largest sum of the contact forces on both gears, which are opposite, over the force; likewise their moments about
    the axes less the torques."""
    moment_error: float
    """Largest sum of the moments of the contact forces on both gears about one axis, over the force and the base
    radius; flanks a gap apart have some."""
    motion_energy_error: float
    """Largest error of the energy balance of vibration and modes in a time step, over this energy and the work."""
    step_energy_error: float
    """Largest energy between rotation, contact and motion that is left without account from one position to the next,
    over what the load passes on there."""
    period_energy_error: float
    """Energy between rotation, contact and motion that is left without account over the last mesh period, over what the
    load passes on."""
    friction_loss: float
    """Energy lost to friction in the last mesh period, over what the load passes on."""
    damping_loss: float
    """Energy lost to the damping of mesh and modes in the last mesh period, over what the load passes on."""
    numerical_loss: float
    """Energy taken out by the time scheme in the last mesh period, over what the load passes on; beside damping_loss it
    says how much of the damping is numerical."""


TRANSIENT_FACTS = Table("transient.json", TransientFacts)


def transient_facts(
    model: GearModel, pressures: Sequence[CasePressures], errors: Sequence[CaseErrors], starts: Sequence[StartErrors],
    frequencies: Floats, naturals: Sequence[float],
) -> list[TransientFacts]:
    """Figures of all cases with their error bars. starts: error bars of motions from rest, empty without. frequencies:
    of the modes [rad/s]; naturals: natural frequency of each case (`natural_frequency_Hz`)."""
    width, facts = model.width_factor, []
    lowest = float(frequencies.min() / (2.0 * np.pi)) if len(frequencies) else None
    for each, bars, natural, start in zip_longest(pressures, errors, naturals, starts):
        case, found, (moving, still) = each.case, each.case.found, each.peaks()
        load = case.load
        motion = np.array([result.transmission_error for result in case.results])
        worst, energies, passed = found.residuals, found.energies, found.energies.passed
        steps, every = found.steps, [moment.steps for moment in (*found.moments, *found.beginning)]
        step = (found.moments[-1].time - found.moments[-2].time) / (steps.accepted / len(found.moments))
        facts.append(TransientFacts(
            speed_rpm=case.speed.rpm, friction=case.friction, mesh_frequency_Hz=case.speed.mesh_frequency,
            mesh_periods=found.periods, last_change=float(found.changes[-1]) if len(found.changes) else None,
            steady=found.is_steady, modes=len(frequencies), lowest_mode_Hz=lowest, natural_frequency_Hz=natural,
            natural_frequency_Hz_error=bars.natural_frequency * natural,
            steps_per_natural_period=1.0 / (natural * step), time_steps=steps.accepted,
            shortest_step_s=min(each.shortest for each in every), rejected_steps=steps.rejected,
            step_error=max(each.error for each in every), mean_force_N=width * found.mean_force, load_N=width * load,
            peak_to_peak_um=UM * float(np.ptp(motion)), peak_to_peak_um_error=bars.peak_to_peak_um,
            static_peak_to_peak_um=UM * float(np.ptp([still.transmission_error for still in case.static])),
            static_peak_to_peak_um_error=bars.static_peak_to_peak_um, dynamic_factor=steps.largest_force / load,
            dynamic_factor_error=bars.dynamic_factor,
            start_dynamic_factor=max(
                (moment.steps.largest_force / load for moment in found.beginning), default=None
            ),
            start_dynamic_factor_error=start.largest_force / load if start else None,
            separated=float(np.mean([len(result.contact.tooth) == 0 for result in case.results])),
            max_pressure_MPa=largest(moving), max_pressure_MPa_error=bars.max_pressure,
            static_max_pressure_MPa=largest(still), static_max_pressure_MPa_error=bars.static_max_pressure,
            momentum_error=worst.momentum, reaction_error=worst.reaction, moment_error=worst.moment,
            motion_energy_error=worst.motion, step_energy_error=worst.exchange,
            period_energy_error=abs(energies.left) / passed, friction_loss=energies.friction / passed,
            damping_loss=energies.damping / passed, numerical_loss=energies.numerical / passed,
        ))
    return facts


def sentences(
    facts: Sequence[TransientFacts], positions: int, tolerance: float | None, radius: float
) -> list[str]:
    """Sentences on motions that are not steady, and on speeds at which time steps are too long. positions: of a mesh
    period; tolerance: of the estimated error of a step, None for equal steps. radius: transient.spectral_radius."""
    jitter = "" if tolerance is None else "lower transient.tolerance, as changes of the time step add jitter; else "
    unsteady = [
        f"{fact.speed_rpm:g} r/min, μ = {fact.friction:g}: not steady after {fact.mesh_periods} mesh periods; "
        f"{jitter}raise transient.mesh_periods, or look whether the motion repeats after several meshes (`evolvent "
        "dynamics`); figures are those of the last mesh period"
        for fact in facts
        if not fact.steady
    ]
    if tolerance is not None:
        beyond = [_beyond(fact, tolerance) for fact in facts if fact.step_error > tolerance]
        divided = {fact.speed_rpm: _coarse(fact, positions, tolerance) for fact in facts}
        return [*unsteady, *beyond, *filter(None, divided.values())]
    coarse = {fact.speed_rpm: fact for fact in facts if fact.steps_per_natural_period < ENOUGH_STEPS}
    return unsteady + [
        unresolved(speed, fact.natural_frequency_Hz, fact.steps_per_natural_period, positions, radius) + _doubt(fact)
        for speed, fact in coarse.items()
    ]


def _coarse(fact: TransientFacts, positions: int, tolerance: float) -> str:
    """Sentence where divided time steps, or else the positions of the tables, are too far apart; empty where they are
    not."""
    speed, natural = fact.speed_rpm, fact.natural_frequency_Hz
    seen = positions * fact.mesh_frequency_Hz / natural
    return unresolved_within(speed, natural, fact.steps_per_natural_period, tolerance) or unseen(speed, natural, seen)


def _beyond(fact: TransientFacts, tolerance: float) -> str:
    """Sentence on a shortest time step that is too long for the tolerance."""
    return (
        f"{fact.speed_rpm:g} r/min, μ = {fact.friction:g}: wanted an error of a time step of at most "
        f"transient.tolerance = {tolerance:g}, found {fact.step_error:.2g} with the shortest one of "
        f"{fact.shortest_step_s:.3g} s; raise transient.most_parts or the tolerance, or lower "
        "transient.modes_per_harmonic"
    )


def _doubt(fact: TransientFacts) -> str:
    """Clause on error bars from time steps that do not resolve the vibration either; empty where they do."""
    if math.isnan(fact.dynamic_factor_error) or FINER * fact.steps_per_natural_period >= SEEN_STEPS:
        return ""
    return "; error bars may not hold, as the shorter steps from which they come do not resolve it either"
