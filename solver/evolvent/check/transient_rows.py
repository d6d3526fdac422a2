"""Rows of `evolvent check` on [transient]: number of motions and time steps, and whether the steps resolve the natural
frequency of the pair. This frequency is that of ISO 6336-1: that of the computed mesh is not known yet."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.check.planned_cost import most_time_steps, natural_modes, too_many_modes
from evolvent.check.text_table import Row
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.resolved_vibration import unresolved
from evolvent.gears.problem.gear_inertia import equivalent_mass
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, method_b
from evolvent.scene.backlash import unnamed_backlash
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.inertias import moments_of_inertia
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection, TransientSection
from evolvent.scene.vibration_limits import sense_of_transient

STEPS = "Time steps at each speed", ("f_z [Hz]", "step [µs]", "steps/period")
"""Title of the table of `step_lines`, and the heads of its columns."""
AT_COST = "each at the cost of a position or two"
BY_ISO = "by c_γα of ISO 6336-1"


@dataclass(frozen=True)
class PlannedSteps:
    """Time steps of a transient at one speed."""

    speed: MeshSpeed
    """Speed of the pinion."""
    length: float
    """Length of an undivided time step [s]."""
    a_period: float
    """Time steps in a natural period of the pair."""


def transient_lines(scene: Scene, section: TransientSection, companion: bool) -> list[Row]:
    """Lines on the motions and time steps of a scene with [transient]. companion: whether error bars are asked for."""
    cases, positions = len(section.speeds_rpm) * len(scene.contact.friction), scene.sweep.positions
    steps, divided = str(positions), section.tolerance is not None
    modes = " and ".join(f"{float(f'{count:.2g}'):.0f}" for count in natural_modes(scene, section))
    most = most_time_steps(section, cases, positions, companion)
    return [
        Row("how the gears turn", "", "", (section.drive,)),
        Row("speeds × friction coefficients", "", "", (f"{len(section.speeds_rpm)} × {len(scene.contact.friction)}",)),
        Row("motions", "", "", (str(cases),)),
        *([Row("  with those of coarser gears, for error bars", "", "", (str(3 * cases),))] if companion else []),
        Row("mesh periods of each, at most", "", "", (str(section.mesh_periods),)),
        Row("time steps in a mesh period" + (", at least" if divided else ""), "", "", (steps,)),
        *([Row("  each of which is divided by, at most", "", "", (str(section.most_parts),))] if divided else []),
        Row("natural modes of pinion and wheel, about", "", "", (modes,)),
        Row(f"time steps in all, at most, {AT_COST}", "", "", (f"{most:,}",)),
        Row(f"natural frequency {BY_ISO}", "f_n", "Hz", (f"{natural_frequency(scene, section):.4g}",)),
    ]


def step_lines(scene: Scene, section: TransientSection) -> list[Row]:
    """Lines on the time steps, one for each speed."""
    return [
        Row(f"{each.speed.rpm:g} r/min", "", "", (
            f"{each.speed.mesh_frequency:.4g}", f"{1e6 * each.length:.4g}", f"{each.a_period:.3g}"))
        for each in planned_steps(scene, section)
    ]


def transient_warnings(scene: Scene) -> list[str]:
    """Warnings of a wheel that drives, an unknown backlash, too many modes, and speeds at which equal time steps do not
    resolve the natural frequency of the pair; none of the latter where a tolerance divides steps."""
    section = scene.transient
    if section is None:
        return []
    found = _without_backlash(scene, section)
    if problem := sense_of_transient(scene.load):
        found.append(f"`evolvent transient` would refuse this scene: {problem}.")
    if problem := too_many_modes(scene, section):
        found.append(f"`evolvent transient` would refuse this scene: {problem}.")
    if section.tolerance is not None:
        return found
    natural, count = natural_frequency(scene, section), scene.sweep.positions
    radius = section.spectral_radius
    said = [unresolved(each.speed.rpm, natural, each.a_period, count, radius) for each in planned_steps(scene, section)]
    return found + [f"{each} (natural frequency {BY_ISO})." for each in said if each]


def _without_backlash(scene: Scene, section: TransientSection) -> list[str]:
    """Warning that a transient fails where flanks separate and the scene gives no backlash; none where it does."""
    given = None if scene.dynamics is None else scene.dynamics.backlash_um
    if (problem := unnamed_backlash(scene.gear_pair(), given)) is None:
        return []
    refused = "would refuse this scene" if section.start == "rest" else "would end without results where flanks part"
    return [f"`evolvent transient` {refused}: {problem}."]


def planned_steps(scene: Scene, section: TransientSection) -> list[PlannedSteps]:
    """The time steps at each speed."""
    natural, teeth = natural_frequency(scene, section), scene.gear_pair().pinion.z
    speeds = [MeshSpeed(speed, teeth) for speed in section.speeds_rpm]
    lengths = [speed.mesh_period / scene.sweep.positions for speed in speeds]
    return [PlannedSteps(speed, length, 1.0 / (natural * length)) for speed, length in zip(speeds, lengths)]


def natural_frequency(scene: Scene, section: TransientSection) -> float:
    """Natural frequency f_n [Hz] of the gears on c_γα of ISO 6336-1, with the inertia that swings: of both gears, or of
    the one with the torque."""
    planned, mass = scene.planned_vibration(), _swinging_mass(scene, section, gear_problem(scene))
    iso = method_b(planned.pair, mass, planned.force, Accuracy(), planned.moduli)
    return MeshSpeed(iso.resonance_speed, planned.pair.pinion.z).mesh_frequency


def _swinging_mass(scene: Scene, section: TransientSection, problem: GearProblem) -> float:
    """Equivalent mass along the line of action [t] of the inertia that swings."""
    inertias = moments_of_inertia(problem.pair, scene.dynamics or DynamicsSection())
    if section.drive == "free":
        return equivalent_mass(problem.pair, inertias)
    return inertias[problem.torque_on] / problem.base_radius**2
