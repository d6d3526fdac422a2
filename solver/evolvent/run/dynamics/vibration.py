"""The vibration of a scene's gears over the speed, on their excitation; warnings on it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from evolvent.dynamics.body_sentences import bodies_said
from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.oscillator.response import MESHES
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.oscillator.torsional_model import BEYOND_MEASURE
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive
from evolvent.dynamics.results.histories import Motion, motions
from evolvent.dynamics.results.response import largest_force
from evolvent.dynamics.results.response_errors import Vibration, VibrationErrors
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, MethodB, method_b
from evolvent.gears.problem.iso_stiffness import outside_range
from evolvent.run.dynamics.excitation import SolvedExcitation
from evolvent.run.dynamics.scene_torques import SceneTorques
from evolvent.run.dynamics.speeds import WAYS, map_list, sweep_at, sweep_list
from evolvent.run.dynamics.torque_map import TorqueMap, torque_map
from evolvent.run.dynamics.vibration_errors import SWEEPS, errors_over_speed, vibration_of
from evolvent.run.progress import Progress
from evolvent.scene.schema.dynamics import DynamicsSection

SAME_TORQUE = 1e-9
"""Relative difference below which two torques count as one."""
SPEEDS, SPEEDS_AGAIN, MAP = "speeds", "speeds, error bars", "torque map"


@dataclass(frozen=True)
class SweptVibration:
    """Vibration of a pair over the speed."""

    own: Vibration
    """The pair under the scene's torque, and figures of its motions."""
    settings: DriveSettings
    """Inertias, damping and backlash."""
    swept: SpeedSweep
    """Motions of the pair that runs up and down."""
    iso: MethodB
    """Dynamic factor of ISO 6336-1."""
    errors: VibrationErrors
    """Error bars."""
    motions: list[Motion]
    """Motions over time at the speeds of the section."""
    over_torque: TorqueMap
    """Map over torque and speed."""
    share: tuple[float, float]
    """Largest mesh force, and that of the heaviest torque [N]."""
    warnings: tuple[str, ...]
    """Warnings on the vibration, a sentence each."""


def accuracy(section: DynamicsSection) -> Accuracy:
    """Gear accuracy for K_v of ISO 6336-1, as the section [dynamics] gives it."""
    return Accuracy(
        section.base_pitch_deviation_um, section.profile_deviation_um, section.tolerance_class, section.flank_surface,
        section.contact_endurance_MPa,
    )


def swept_vibration(
    solved: SolvedExcitation, loads: SceneTorques, section: DynamicsSection, settings: DriveSettings,
    progress: Progress,
) -> SweptVibration:
    """Sweeps the speeds on an excitation. On rank 0 alone. Raises NoSteadyState."""
    excitation, companion = solved.excitation, solved.companion
    percents, first = sorted(section.torque_percents), loads.problem
    vibrating = drive(first.pair, excitation, float(excitation.loaded.forces[percents.index(100.0)]), settings)
    moduli = first.materials[0].youngs_modulus, first.materials[1].youngs_modulus
    iso = method_b(first.pair, vibrating.equivalent_mass, vibrating.model.load, accuracy(section), moduli)
    speeds = sweep_list(vibrating.natural_speed, section)
    progress.stage(SPEEDS, WAYS * len(speeds))
    swept = sweep_at(vibrating, speeds, progress.advance)
    own = vibration_of(vibrating, swept)
    if companion.excitation is not None:
        progress.stage(SPEEDS_AGAIN, SWEEPS * WAYS * len(speeds))
    errors = errors_over_speed(own, excitation, companion, first, settings, speeds, progress.advance)
    moving = motions(vibrating, swept, section.histories_rpm)
    over_torque = _over_torque(excitation, first, vibrating, settings, section, progress)
    share = largest_force(own.found), float(excitation.loaded.forces[-1])
    said = *_warnings(vibrating, settings, share, swept), *_not_followed(vibrating, swept)
    said = *said, *_branch_warnings(swept), *_not_repeating(vibrating, swept), *errors.said
    said = *said, *_iso_warnings(first, iso), *over_torque.warnings
    return SweptVibration(own, settings, swept, iso, errors, moving, over_torque, share, said)


def _over_torque(
    excitation: MeshExcitation, problem: GearProblem, vibrating: Drive, settings: DriveSettings,
    section: DynamicsSection, progress: Progress,
) -> TorqueMap:
    """The map over torque and speed; without rows where the section asks for none. vibrating: under the scene's torque.
    """
    heaviest = float(excitation.loaded.torques[-1]) * (1.0 + SAME_TORQUE)  # others may be left out in line contact
    asked = [problem.torque * percent / 100.0 for percent in section.map_percents]
    torques = [torque for torque in asked if torque <= heaviest]
    if torques:
        progress.stage(MAP, len(torques))
    speeds = map_list(vibrating.natural_speed, section)
    found = torque_map(excitation, problem, settings, torques, speeds, progress.advance)
    if len(torques) == len(asked):
        return found
    left_out = f"torque_map.csv: nothing above {1e-3 * torques[-1] if torques else 0.0:.4g} N·m, see the excitation."
    return replace(found, warnings=(*found.warnings, left_out))


def _warnings(
    vibrating: Drive, settings: DriveSettings, share: tuple[float, float], swept: SpeedSweep
) -> list[str]:
    """Warnings on the elastic bodies, a backlash below the static deflection, and mesh forces above that of the
    heaviest torque. share: largest mesh force, and that of the heaviest torque
    [N]."""
    found, deflection = [], vibrating.model.load / vibrating.mean_stiffness
    found += bodies_said(vibrating, *_ends(vibrating, swept.periods))
    if settings.backlash < deflection:
        found.append(
            f"dynamics.backlash_um: found {1e3 * settings.backlash:.3g} µm, less than the static deflection of "
            f"{1e3 * deflection:.3g} µm: the back flanks catch the teeth at once, so that there is hardly free flight "
            "and no jump; give the backlash of the pair"
        )
    if settings.mesh == "force_surface" and share[0] > share[1]:
        found.append(
            f"dynamics.torque_percents: the largest mesh force is {share[0] / share[1]:.3g} times that of the heaviest "
            "torque; beyond that the force goes on straight. Add heavier ones until this is below 1"
        )
    return found


def _not_followed(vibrating: Drive, swept: SpeedSweep) -> list[str]:
    """Warnings of interrupted branches of steady states, and of motions that grow without limit."""
    found, branch = [], swept.branch
    if branch.gaps or branch.lost:
        ends = [branch.points[i].period for gap in branch.gaps for i in (gap, gap + 1)]
        speeds = ", ".join(f"{MeshSpeed.of_period(period, vibrating.teeth).rpm:.0f}" for period in ends)
        found.append(
            f"steady states: found {len(branch.gaps) + 1} pieces that are not connected (branch.csv), with ends at "
            f"{speeds or 'one end of the'} r/min. {' '.join(f'{each}.' for each in branch.lost)}".rstrip()
        )
    gone = {float(period) for runs in (swept.up, swept.down) for period, run in zip(swept.periods, runs) if run.escaped}
    if gone:
        slowest, fastest = _ends(vibrating, gone)
        found.append(
            f"response.csv: at {len(gone)} of {len(swept.periods)} speeds, from {slowest:.0f} to {fastest:.0f} r/min, "
            f"the motion grows beyond {BEYOND_MEASURE:g} times the static deflection, as the varying stiffness feeds "
            "in more than the dampers take out; its figures there are of the last mesh before. Give more damping"
        )
    return found


def _ends(vibrating: Drive, periods: Iterable[float]) -> tuple[float, float]:
    """Lowest and highest speed [r/min] of mesh periods [s]."""
    speeds = [MeshSpeed.of_period(period, vibrating.teeth).rpm for period in periods]
    return min(speeds), max(speeds)


def _branch_warnings(swept: SpeedSweep) -> list[str]:
    """Warning of steady states that lie on no branch which was followed."""
    apart = sum(run.place is None and run.repeats == 1 for run in (*swept.up, *swept.down))
    if not apart:
        return []
    return [
        f"dynamics.json, branch.csv: {apart} of {2 * len(swept.periods)} motions repeat with every mesh, but lie on no "
        "branch that was found from the lowest speed: jumps from and between them are seen in response.csv alone; "
        "begin at another speed (dynamics.speed_rpm)"
    ]


def _not_repeating(vibrating: Drive, swept: SpeedSweep) -> list[str]:
    """Warning of motions that do not repeat, so that their largest force over a longer time may be larger."""
    wild = [float(period) for runs in (swept.up, swept.down) for period, run in zip(swept.periods, runs)
            if run.repeats == 0 and not run.escaped]
    if not wild:
        return []
    slowest, fastest = _ends(vibrating, wild)
    return [
        f"response.csv: {len(wild)} of {2 * len(swept.periods)} motions, from {slowest:.0f} to {fastest:.0f} r/min, "
        f"do not repeat or have not settled: their forces are those of {MESHES} meshes, and single ones may be larger"
    ]


def _iso_warnings(problem: GearProblem, iso: MethodB) -> list[str]:
    """Warnings on K_v of ISO 6336-1: accuracy that is not given, gears outside its range, and flank charts, which it
    leaves out."""
    if not iso.has_factor:
        given = {
            "dynamics.base_pitch_deviation_um": iso.accuracy.base_pitch_deviation,
            "dynamics.profile_deviation_um": iso.accuracy.profile_deviation,
        }
        missing = " and ".join(key for key, value in given.items() if value is None)
        return [f"dynamic_factor_iso: no K_v of ISO 6336-1 without the deviations of the gears; give {missing}"]
    found = []
    if (what := outside_range(problem.pair)) is not None:
        found.append(f"dynamic_factor_iso: the tooth stiffness of ISO 6336-1 is not made for these gears: {what}")
    if any(chart is not None for chart in problem.flanks):
        found.append("dynamic_factor_iso: it has the tip relief of the design, not that of flank_csv")
    return found
