"""Tables of a pair's vibration: over the speed, along the branch of steady states, and what it is computed from."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.body_sentences import near_body_vibration
from evolvent.dynamics.mesh_oscillator import MeshOscillator
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.oscillator.response import Response, response
from evolvent.dynamics.oscillator.speed_sweep import Running, SpeedSweep
from evolvent.dynamics.pair_model import Drive, DriveSettings
from evolvent.dynamics.results.response_errors import VibrationErrors
from evolvent.gears.problem.iso_dynamic_factor import MethodB
from evolvent.results.tables.table import Record, Table

UM = 1e3  # µm per mm
Responses = dict[str, list[Response]]  # at all speeds, "up" and "down"


@dataclass(frozen=True)
class ResponseRow:
    """A line of response.csv: a speed, run up to or down to."""

    speed_rpm: float
    """Speed of the pinion."""
    way: str
    """Direction in which the pair has come to the speed, slowly: up or down."""
    repeats: int
    """Mesh periods after which the motion repeats; 0 where it does not within sixteen, has not settled after a thousand
    or more, or grows beyond a hundred static deflections. Forces and times are then those of 500 meshes."""
    jumped: bool
    """Whether the pair left the branch of steady states, or came to another part of it, since the speed before."""
    equivalent_amplitude_um: float
    """√ΣA_r² of the first three mesh harmonics of s = r_b1 θ_1 − r_b2 θ_2, with the unloaded transmission error in it;
    the rms value of these is 1/√2 of it."""
    equivalent_amplitude_um_error: float
    """Estimated error of the equivalent amplitude by the mesh and by the spacing of positions; NaN where there is no
    coarse companion (`output.error_bars`). Large beside resonances and jumps that move with the excitation."""
    elastic_equivalent_amplitude_um: float
    """√ΣA_r² of the first three mesh harmonics of s − e, without the unloaded transmission error e."""
    harmonic_1_um: float
    """Amplitude of the first mesh harmonic of s."""
    harmonic_2_um: float
    """Amplitude of the second mesh harmonic of s."""
    harmonic_3_um: float
    """Amplitude of the third mesh harmonic of s."""
    harmonic_4_um: float
    """Amplitude of the fourth mesh harmonic of s."""
    harmonic_5_um: float
    """Amplitude of the fifth mesh harmonic of s."""
    force_harmonic_1_N: float
    """Amplitude of the first mesh harmonic of the mesh force; lines between the harmonics: spectrum.csv."""
    force_harmonic_2_N: float
    """Amplitude of the second mesh harmonic of the mesh force."""
    force_harmonic_3_N: float
    """Amplitude of the third mesh harmonic of the mesh force."""
    force_harmonic_4_N: float
    """Amplitude of the fourth mesh harmonic of the mesh force."""
    force_harmonic_5_N: float
    """Amplitude of the fifth mesh harmonic of the mesh force."""
    largest_force_N: float
    """Largest mesh force, damping included, on both sides of the instants at which contact begins or ends."""
    smallest_force_N: float
    """Smallest mesh force, damping included: below 0 where back flanks press, or the damper pulls."""
    dynamic_factor: float
    """Largest mesh force of this motion over the static one; with the damping that the scene gives, and of all teeth in
    contact: not K_v of ISO 6336-1. The force of the damper is in it; in that of transient.json it is not."""
    dynamic_factor_error: float
    """Estimated error of the dynamic factor by the mesh and by the spacing of positions; NaN where there is no coarse
    companion (`output.error_bars`)."""
    dynamic_factor_iso: float
    """K_v of ISO 6336-1:2006, Method B, at this speed: by the deviations and the mass that the scene gives, without its
    damping; the same up and down. NaN without both deviations (`dynamics.base_pitch_deviation_um`,
    `dynamics.profile_deviation_um`)."""
    separated_share: float
    """Share of the time in which no flanks touch."""
    back_contact_share: float
    """Share of the time in which the back flanks touch."""
    near_body_vibration: bool
    """Whether one of the first three mesh harmonics excites the bodies' own vibration, which is left out: from 0.9 to
    1.2 times the speed at which it has `body_frequency_Hz` of dynamics.json. Motion and forces are larger than computed
    there. False for rigid bodies, which have none."""


@dataclass(frozen=True)
class BranchRow:
    """A line of branch.csv: a steady state, stable or not, in the order along the branch."""

    speed_rpm: float
    """Speed of the pinion."""
    equivalent_amplitude_um: float
    """Equivalent amplitude of the transmission error, as in response.csv."""
    stable: bool
    """Whether the steady state is stable: small disturbances die out."""
    fold: bool
    """Whether the branch turns back here: a pair that follows the speed jumps."""
    connected: bool
    """Whether the row before is the next one on the branch; false where the branch could not be followed on, and
    another piece of it begins."""


@dataclass(frozen=True)
class DriveSummary:
    """Parameters from which the vibration is computed, and the speeds of its jumps: dynamics.json."""

    equivalent_mass_kg: float
    """Equivalent mass m_e along the line of action."""
    pinion_inertia_kg_m2: float
    """Moment of inertia of the pinion."""
    wheel_inertia_kg_m2: float
    """Moment of inertia of the wheel."""
    pinion_added_inertia_kg_m2: float | None
    """Moment of inertia of the pinion beyond that of its meshed body: it turns rigidly with the bore. Null for rigid
    bodies, all of whose inertia does."""
    wheel_added_inertia_kg_m2: float | None
    """Moment of inertia of the wheel beyond that of its meshed body; null for rigid bodies."""
    mean_stiffness_N_per_um: float
    """Stiffness of the whole face under the torque, mean over the pitch, with what gives way in series: the secant one
    where dynamics.mesh is secant, else the tangent one."""
    mean_stiffness_N_per_um_error: float
    """Estimated error of the mean stiffness by the mesh and by the spacing of positions; null where there is no coarse
    companion (`output.error_bars`)."""
    natural_speed_rpm: float
    """Speed of the pinion at which the mesh frequency is √(moving_stiffness_N_per_um / moving_mass_kg) / 2π [Hz]."""
    natural_speed_rpm_error: float
    """Estimated error of the natural speed by that of the mean stiffness."""
    bodies: str
    """Model of the gear bodies: elastic, with their inertia where it is, or rigid, with all inertia at the bores."""
    rigid_natural_speed_rpm: float
    """Natural speed with all inertia at the bores: too low, the more the smaller these are."""
    moving_mass_kg: float
    """Mass of the one degree of freedom: m_e; with elastic bodies more, by what their elastic modes lag behind."""
    moving_stiffness_N_per_um: float
    """Mean stiffness in motion: mean_stiffness_N_per_um; with elastic bodies more, as their inertia holds them."""
    body_frequency_Hz: float | None
    """Lowest frequency of the bodies' own vibration on the mesh, which the one degree of freedom leaves out: where a
    low mesh harmonic comes near to it motion and forces are larger than computed (near_body_vibration of response.csv).
    The centres of the bores cannot move: on soft bearings the frequencies are others. Null for rigid bodies."""
    static_force_N: float
    """Static mesh force: torque over base radius."""
    damping_N_s_per_mm: float
    """Damping coefficient of the mesh."""
    backlash_um: float
    """Backlash along the line of action, from flank to flank."""
    mesh: str
    """Model of the mesh force, as dynamics.mesh."""
    damping_ratio: float
    """Damping ratio of the mesh, as in the scene."""
    damping_in_separation: bool
    """Whether the damping of the mesh acts in free flight, too."""
    ground_damping_ratio: float
    """Damping ratio of the shafts against the ground, as in the scene."""
    natural_frequency_Hz: float
    """Natural frequency, at which the mesh frequency is at the natural speed."""
    folds_rpm: tuple[float, ...]
    """Speeds at which the branch of steady states turns back, each once, in the order along the branch."""
    jumps_up_rpm: tuple[float, ...]
    """Speeds at which a pair that runs up leaves the branch: at a fold, or where the steady state loses its stability
    otherwise; in the order in which it comes there."""
    jumps_up_rpm_error: tuple[float, ...]
    """Estimated errors of jumps_up_rpm by the mesh and by the spacing of positions; null where there is no coarse
    companion, and of a jump that is not found on its mesh, or from every other position."""
    jumps_down_rpm: tuple[float, ...]
    """Speeds at which a pair that runs down leaves the branch, like jumps_up_rpm."""
    jumps_down_rpm_error: tuple[float, ...]
    """Estimated errors of jumps_down_rpm, like jumps_up_rpm_error."""
    heaviest_torque_share: float | None
    """Largest mesh force of all speeds over that of the heaviest torque of the force surface; above 1 the surface was
    extrapolated linearly. Null with another model of the mesh."""
    iso_single_stiffness_N_per_mm_um: float
    """Single stiffness c' of ISO 6336-1:2006, clause 9, per mm of face width."""
    iso_mesh_stiffness_N_per_mm_um: float
    """Mesh stiffness c_γα of ISO 6336-1:2006, clause 9, per mm of face width; a secant of teeth on solid discs or, by
    C_R, on webs, not the stiffness that was computed."""
    iso_resonance_speed_rpm: float
    """Resonance speed n_E1 of the pinion by ISO 6336-1:2006, clause 6, from iso_mesh_stiffness_N_per_mm_um and
    equivalent_mass_kg."""
    iso_relief_term: float
    """B_k of ISO 6336-1:2006, clause 6: what tip relief leaves of the deflection, 1 without one."""
    iso_main_resonance_rpm: tuple[float, float]
    """Speeds of the pinion between which ISO 6336-1:2006 has its main resonance."""
    iso_base_pitch_deviation_um: float | None
    """Base pitch deviation f_pb, as in the scene; null where it is not known."""
    iso_profile_deviation_um: float | None
    """Profile form deviation f_fα, as in the scene; null where it is not known."""
    warnings: tuple[str, ...]
    """Sentences that a reader of the tables has to know, as `evolvent dynamics` prints them."""

    @property
    def first_body_speed_rpm(self) -> float:
        """Speed of the pinion at which the first mesh harmonic has `body_frequency_Hz`; infinite for rigid bodies."""
        if self.body_frequency_Hz is None:
            return math.inf
        return self.body_frequency_Hz / self.natural_frequency_Hz * self.natural_speed_rpm


RESPONSE, BRANCH = Table("response.csv", ResponseRow), Table("branch.csv", BranchRow)
DYNAMICS = Record("dynamics.json", DriveSummary)


def responses(drive: MeshOscillator, swept: SpeedSweep) -> Responses:
    """Responses at all speeds; of a motion that grows beyond measure that of the last mesh period within."""
    return {
        way: [
            response(drive.model, float(period), run.motion.state, 1 if run.escaped else run.repeats)
            for period, run in zip(swept.periods, runs)
        ]
        for way, runs in (("up", swept.up), ("down", swept.down))
    }


def response_rows(
    drive: MeshOscillator, swept: SpeedSweep, found: Responses, iso: MethodB | None, errors: VibrationErrors
) -> Iterator[ResponseRow]:
    """Rows of response.csv: up, then down, at ascending speeds. iso: None where no gears are known."""
    for way, runs in (("up", swept.up), ("down", swept.down)):
        bars = UM * errors.amplitude[way], errors.dynamic_factor[way]
        for period, run, each, size_error, factor_error in zip(swept.periods, runs, found[way], *bars):
            speed = MeshSpeed.of_period(period, drive.teeth).rpm
            yield ResponseRow(
                speed_rpm=speed, way=way, repeats=run.repeats, jumped=run.jumped,
                equivalent_amplitude_um=UM * each.equivalent_amplitude, equivalent_amplitude_um_error=float(size_error),
                elastic_equivalent_amplitude_um=UM * each.elastic_equivalent_amplitude,
                **{f"harmonic_{r}_um": UM * float(size) for r, size in enumerate(each.total, 1)},
                **{f"force_harmonic_{r}_N": float(size) for r, size in enumerate(each.force, 1)},
                largest_force_N=each.largest_force, smallest_force_N=each.smallest_force,
                dynamic_factor=each.largest_force / drive.model.load, dynamic_factor_error=float(factor_error),
                dynamic_factor_iso=math.nan if iso is None else iso.factor(speed), separated_share=each.separated_share,
                back_contact_share=each.back_contact_share, near_body_vibration=near_body_vibration(drive, speed),
            )


def branch_rows(drive: MeshOscillator, swept: SpeedSweep) -> Iterator[BranchRow]:
    """Rows of branch.csv: from the lowest speed to the highest, through all folds."""
    gaps = swept.branch.gaps
    for i, (state, stable) in enumerate(zip(swept.branch.points, swept.branch.stable)):
        size = response(drive.model, state.period, state.state).equivalent_amplitude
        fold, connected = i in swept.branch.folds, i > 0 and i - 1 not in gaps
        yield BranchRow(
            speed_rpm=MeshSpeed.of_period(state.period, drive.teeth).rpm, equivalent_amplitude_um=UM * size,
            stable=bool(stable), fold=fold, connected=connected,
        )


def jumps(drive: MeshOscillator, runs: Iterable[Running]) -> tuple[float, ...]:
    """Speeds [r/min] at which a pair leaves the branch, in the order of its motions."""
    return tuple(MeshSpeed.of_period(run.left_at, drive.teeth).rpm for run in runs if run.left_at is not None)


def summary(
    drive: Drive, settings: DriveSettings, swept: SpeedSweep, largest: float, heaviest: float, iso: MethodB,
    errors: VibrationErrors, warnings: Sequence[str] = (),
) -> DriveSummary:
    """Summary of a vibration. largest: largest mesh force of all speeds [N]; heaviest: largest mesh force of the force
    surface's torques [N]. warnings: sentences on all of it."""
    pinion, wheel = settings.inertias
    added = settings.added_inertias
    folds = _different([swept.branch.points[i].period for i in swept.branch.folds], drive.teeth)
    begin, end = iso.main_resonance
    natural = MeshSpeed(drive.natural_speed, drive.teeth)
    return DriveSummary(
        equivalent_mass_kg=1e3 * drive.equivalent_mass, pinion_inertia_kg_m2=1e-3 * pinion,
        wheel_inertia_kg_m2=1e-3 * wheel, pinion_added_inertia_kg_m2=1e-3 * added[0] if added else None,
        wheel_added_inertia_kg_m2=1e-3 * added[1] if added else None,
        mean_stiffness_N_per_um=1e-3 * drive.mean_stiffness,
        mean_stiffness_N_per_um_error=1e-3 * errors.mean_stiffness, natural_speed_rpm=drive.natural_speed,
        natural_speed_rpm_error=errors.natural_speed, bodies=settings.bodies_named,
        rigid_natural_speed_rpm=drive.rigid_natural_speed, moving_mass_kg=1e3 * drive.model.mass,
        moving_stiffness_N_per_um=1e-3 * drive.moving_stiffness,
        body_frequency_Hz=drive.body_frequency if settings.bodies is not None else None,
        static_force_N=drive.model.load, damping_N_s_per_mm=drive.model.damping, backlash_um=UM * settings.backlash,
        mesh=settings.mesh, damping_ratio=settings.damping_ratio, damping_in_separation=settings.damping_in_separation,
        ground_damping_ratio=settings.ground_damping_ratio, natural_frequency_Hz=natural.mesh_frequency,
        folds_rpm=folds, jumps_up_rpm=jumps(drive, swept.up), jumps_up_rpm_error=errors.jumps["up"],
        jumps_down_rpm=jumps(drive, swept.down[::-1]), jumps_down_rpm_error=errors.jumps["down"],
        heaviest_torque_share=largest / heaviest if settings.mesh == "force_surface" else None,
        iso_single_stiffness_N_per_mm_um=iso.single_stiffness, iso_mesh_stiffness_N_per_mm_um=iso.mesh_stiffness,
        iso_resonance_speed_rpm=iso.resonance_speed, iso_relief_term=iso.relief_term,
        iso_main_resonance_rpm=(begin * iso.resonance_speed, end * iso.resonance_speed),
        iso_base_pitch_deviation_um=iso.accuracy.base_pitch_deviation,
        iso_profile_deviation_um=iso.accuracy.profile_deviation, warnings=tuple(warnings),
    )


def _different(periods: Iterable[float], teeth: int) -> tuple[float, ...]:
    """Speeds [r/min] at mesh periods [s], without repetitions to six digits: pieces of the branch may be followed over
    the same fold."""
    speeds = (MeshSpeed.of_period(period, teeth).rpm for period in periods)
    return tuple({float(f"{speed:.6g}"): speed for speed in speeds}.values())


def largest_force(found: dict[str, list[Response]]) -> float:
    """Largest mesh force of all speeds, running up and down [N]."""
    return float(np.max([each.largest_force for runs in found.values() for each in runs]))
