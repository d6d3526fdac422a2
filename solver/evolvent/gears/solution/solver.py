"""Gear pairs from Python: condensed gears, a single position, the pitch, and the curves that it gives.

On several ranks all of them call these functions, and all get all results.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from mpi4py import MPI

from evolvent.contact.problem.user_warnings import warn_user
from evolvent.contact.step.contact_width import CoarseContactWarning
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.pressure.contact_cells import FEWEST_CELLS, SCATTER, cells_across
from evolvent.gears.pressure.line_peaks import LinePeak
from evolvent.gears.pressure.pitch_pressure import PitchPressure, pitch_pressures
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.problem.load_limits import check_load
from evolvent.gears.solution.certificates import certify
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.input_checks import instance, is_index, number, numbers, refuse


class ExtendedChartWarning(UserWarning):
    """A flank chart does not end where the face of its gear does: it is extended by the depths at its ends, or cut."""


@dataclass(frozen=True, eq=False)
class PitchSolution:
    """A certified pitch at one friction coefficient: k positions in equal steps, whose friction history is periodic."""

    friction: float
    """Coulomb's coefficient of friction μ."""
    results: tuple[PositionResult, ...]
    """Results (k,) of the positions; forces and torques of a plane problem are per mm of face width."""
    pressure: PitchPressure
    """Fitted peak pressures between the tip-edge zones."""
    width_factor: float
    """Factor from forces and torques in `results` to those of the gears: the face width [mm] where the problem is
    plane, else 1."""
    cells_across: float
    """Elements across the fitted contact width 2b, median of all positions, as in summary.json."""
    deflected: bool
    """Whether contact was searched again on deflected flanks, because energy did not balance without."""

    @property
    def angles(self) -> Floats:
        """Pinion rotations (k,) [rad]; 0: tooth pair 0 touches at the pitch point, in the mid-face section."""
        return np.array([result.stand.angle for result in self.results])

    @property
    def transmission_error(self) -> Floats:
        """Transmission error r_b1 φ_1 − r_b2 φ_2 (k,) [mm], along the line of action; positive where the wheel lags
        behind the pinion."""
        return np.array([result.transmission_error for result in self.results])

    @property
    def transmission_error_peak_to_peak(self) -> float:
        """Largest less smallest transmission error [mm]."""
        return float(np.ptp(self.transmission_error))

    @property
    def torques(self) -> Floats:
        """Moments of the contact forces about both axes (k, 2) [N·mm]: input on the pinion, output of the wheel, both
        positive."""
        return self.width_factor * np.array([result.torques for result in self.results])

    @property
    def mesh_stiffness(self) -> Floats:
        """Tangent stiffness of the whole face along the line of action (k,) [N/mm], without friction."""
        return self.width_factor * np.array([result.stiffness for result in self.results])

    @property
    def max_pressure(self) -> Floats:
        """Largest fitted peak pressure between the tip-edge zones and away from starts of linear reliefs (k,) [MPa],
        `max_pressure_MPa` of positions.csv; NaN where there is none."""
        return self.pressure.at_positions

    @property
    def peak(self) -> LinePeak:
        """The largest pressure of the whole engagement, `max_pressure_MPa` of summary.json, and where it occurs."""
        return self.pressure.peak

    @property
    def tip_edge(self) -> Bools:
        """Whether a tooth bears on a tip edge (k,) bool, where the pressure is singular; as in positions.csv."""
        return np.array([bool(result.contact.edge.any()) for result in self.results])

    @property
    def loss_ratio(self) -> float:
        """Friction work over input work of the pitch."""
        lost = sum(result.friction_loss for result in self.results)
        return float(lost / sum(abs(result.torques[0]) for result in self.results))


def condense(problem: GearProblem, comm: MPI.Comm = MPI.COMM_WORLD) -> GearModel:
    """Meshes and condenses both gears, once for all positions and friction coefficients. Warns by
    ExtendedChartWarning of a flank chart that does not end where the face of its gear does.

    Raises InputError for a torque that the gears cannot bear, MeshError, TooMuchRelief, NotPositiveDefinite,
    OutOfMemory.

    Examples:
        >>> from evolvent.gears import GearPair, GearParameters, GearProblem, MeshSettings, condense, solve_pitch
        >>> rack = dict(normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0)
        >>> pinion = GearParameters.from_rack(z=30, bore_diameter=40.0, **rack)
        >>> wheel = GearParameters.from_rack(z=50, bore_diameter=60.0, **rack)
        >>> pair = GearPair(pinion, wheel, centre_distance=120.0)
        >>> gears = condense(GearProblem(pair, torque=150e3, mesh=MeshSettings("quick")))
        >>> pitch = solve_pitch(gears, friction=0.1, positions=4)
        >>> pitch.transmission_error.shape
        (4,)
    """
    instance("problem", problem, GearProblem, "write condense(GearProblem(pair, torque=...))")
    check_load(problem)
    if comm.rank == 0:
        _warn_of_charts(problem)
    dolfinx_compat.silence_logs()
    return prepare_model(problem, comm).model


def solve_single_position(gears: GearModel, angle: float, friction: float = 0.0) -> PositionResult:
    """A position without friction history: the flanks have slid as they do in a twentieth of a pitch, from the state
    without friction. Every rank solves it.

    angle: pinion rotation [rad], from 0 to 2π/z_1 and a little beyond: positions repeat with
    2π/z_1, tooth pair i + 1 where pair i was; other angles are refused, for some of their teeth are not searched.

    Raises InputError, NotConverged, SearchError, BalanceError.
    """
    check_condensed(gears)
    first, last = searched_angles(gears)
    wanted = f"a rotation [rad] within one engagement, {first:.4g} to {last:.4g}"
    remedy = f"is it in degrees? Positions repeat with 2π/z_1, {2.0 * np.pi / gears.pair.pinion.z:.4g} rad"
    number("angle", angle, wanted, remedy, lambda φ: first <= φ <= last)
    check_frictions([friction])
    swept = next(sweep_pitch(gears, Pitch((float(angle),)), [friction], initial_state([friction])))
    certify(swept.results)
    return swept.results[0]


def searched_angles(gears: GearModel) -> tuple[float, float]:
    """Smallest and largest pinion rotation [rad] at which all tooth pairs that can touch on rigid flanks are searched,
    and their neighbours, which deflection may bring into contact."""
    pair = gears.pair
    start, end = pair.path_of_contact
    reach, pitch = pair.face_width / 2.0 * np.tan(pair.pinion.base_helix_angle), pair.pinion.transverse_base_pitch
    distances = end + reach - gears.teeth[-1] * pitch, start - reach - gears.teeth[0] * pitch
    return distances[0] / pair.pinion.base_radius, distances[1] / pair.pinion.base_radius


def solve_pitch(
    gears: GearModel, friction: float = 0.0, positions: int = 20, comm: MPI.Comm = MPI.COMM_WORLD
) -> PitchSolution:
    """The pitch at one friction coefficient, see `solve_pitches`."""
    return solve_pitches(gears, [friction], positions, comm)[0]


def solve_pitches(
    gears: GearModel, frictions: Sequence[float], positions: int = 20, comm: MPI.Comm = MPI.COMM_WORLD
) -> tuple[PitchSolution, ...]:
    """One angular pitch 2π/z_1 in equal steps, repeated until the friction state is periodic; one solution per
    coefficient.

    All coefficients share search and compliance. Where energy does not balance over the pitch, it is solved again on
    deflected flanks. positions: steps of the pitch. Warns by CoarseContactWarning of a contact that is fewer than two
    elements wide. Raises InputError, NotConverged, SearchError, BalanceError.
    """
    check_condensed(gears)
    check_frictions(frictions)
    check_positions(positions)
    pitch = uniform_pitch(gears.pair.pinion.z, int(positions), gears.pitches)
    solved = certified_pitch(gears, pitch, list(frictions), comm)
    pressures = pitch_pressures(gears, [position.results for position in solved.positions])
    cells = [_cells_across(gears, pressure) for pressure in pressures]
    if comm.rank == 0:
        _warn_if_coarse(min(cells))
    return tuple(
        PitchSolution(friction, results, pressure, gears.width_factor, count, solved.deflected)
        for friction, results, pressure, count in zip(frictions, solved.by_friction, pressures, cells)
    )


def _cells_across(gears: GearModel, pressure: PitchPressure) -> float:
    """Elements across the fitted contact width 2b, median of all positions."""
    pinion, half_widths = gears.bodies[0], np.concatenate([cut.half_width for cut in pressure.cuts])
    return cells_across(half_widths, pinion.z, pinion.roll_length, pinion.gear.base_radius, pinion.mesh.order)


def _warn_of_charts(problem: GearProblem) -> None:
    """Warns at the user's line of flank charts that are extended to the face, or cut, as `evolvent run` does."""
    for gear, words in problem.extended_charts.items():
        warn_user(f"flanks, {gear.label}: {words}", ExtendedChartWarning)


def _warn_if_coarse(cells: float) -> None:
    """Warns at the user's line of a contact of fewer than `FEWEST_CELLS` elements, as `evolvent run` does."""
    if not cells >= FEWEST_CELLS:
        warn_user(
            f"gear pair: wanted a contact at least {FEWEST_CELLS:g} elements wide, found {cells:.2f} (median): peak "
            f'pressures {SCATTER}; take MeshSettings("standard") or MeshSettings(elements_per_contact_width=3)',
            CoarseContactWarning,
        )


def check_condensed(gears: GearModel) -> None:
    """Raises InputError unless these are condensed gears."""
    remedy = "write condense(problem)" if isinstance(gears, GearProblem) else "give what condense(problem) returns"
    instance("gears", gears, GearModel, remedy)


def check_frictions(frictions: Sequence[float]) -> None:
    """Raises InputError unless they are different numbers from 0 to 1."""
    numbers("frictions", frictions)
    for friction in frictions:
        number("friction", friction, "a number from 0 to 1", "dry steel has up to 0.3", lambda μ: 0.0 <= μ <= 1.0)
    if len(frictions) == 0 or len(set(frictions)) < len(frictions):
        refuse("frictions", "one coefficient or several different ones", list(frictions), "give each once")


def check_positions(positions: int) -> None:
    """Raises InputError unless it is a whole number from 2 on."""
    if not (is_index(positions) and positions >= 2):
        refuse("positions", "a whole number from 2 on", positions, "20 are usual")
