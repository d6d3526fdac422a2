"""Gear pairs from Python: condensed gears and a single position.

On several ranks all of them call these functions, and all get all results.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from mpi4py import MPI

from evolvent.contact.problem.user_warnings import warn_user
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.line.line_start import with_line_starts
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.problem.load_limits import check_load
from evolvent.gears.solution.certificates import certify
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.input_checks import Words, instance, is_index, number, numbers, refuse


class ExtendedChartWarning(UserWarning):
    """A flank chart does not end where the face of its gear does: it is extended by the depths at its ends, or cut."""


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
    return with_line_starts(prepare_model(problem, comm).model)


def solve_single_position(gears: GearModel, angle: float, friction: float = 0.0) -> PositionResult:
    """A position without friction history: the flanks have slid as they do in a twentieth of a pitch, from the state
    without friction. Every rank solves it.

    angle: pinion rotation [rad], from 0 to 2π/z_1 and a little beyond: positions repeat with
    2π/z_1, tooth pair i + 1 where pair i was; other angles are refused, for some of their teeth are not searched.

    Raises InputError, NotConverged, SearchError, BalanceError.
    """
    check_resolved(gears)
    first, last = searched_angles(gears)
    wanted = f"a rotation [rad] within one engagement, {first:.4g} to {last:.4g}"
    remedy = f"is it in degrees? Positions repeat with 2π/z_1, {2.0 * np.pi / gears.pair.pinion.z:.4g} rad"
    number("angle", angle, wanted, remedy, lambda φ: first <= φ <= last)
    check_friction(friction)
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


def _warn_of_charts(problem: GearProblem) -> None:
    """Warns at the user's line of flank charts that are extended to the face, or cut, as `evolvent run` does."""
    for gear, words in problem.extended_charts.items():
        warn_user(f"flanks, {gear.label}: {words}", ExtendedChartWarning)


def check_condensed(gears: GearModel) -> None:
    """Raises InputError unless these are condensed gears."""
    remedy = "write condense(problem)" if isinstance(gears, GearProblem) else "give what condense(problem) returns"
    instance("gears", gears, GearModel, remedy)


def check_resolved(gears: GearModel) -> None:
    """Raises InputError unless these are condensed gears whose contact is resolved."""
    check_condensed(gears)
    if gears.is_line:
        remedy = 'condense them with MeshSettings("quick"), or compute dynamics.mesh_excitation of these'
        refuse("gears", "gears whose contact is resolved", Words('gears of mesh level "line"'), remedy)


def check_friction(friction: float) -> None:
    """Raises InputError unless it is a number from 0 to 1."""
    number("friction", friction, "a number from 0 to 1", "dry steel has up to 0.3", lambda μ: 0.0 <= μ <= 1.0)


def check_frictions(frictions: Sequence[float]) -> None:
    """Raises InputError unless they are different numbers from 0 to 1."""
    numbers("frictions", frictions)
    for friction in frictions:
        check_friction(friction)
    if len(frictions) == 0 or len(set(frictions)) < len(frictions):
        refuse("frictions", "one coefficient or several different ones", list(frictions), "give each once")


def check_positions(positions: int) -> None:
    """Raises InputError unless it is a whole number from 2 on."""
    if not (is_index(positions) and positions >= 2):
        refuse("positions", "a whole number from 2 on", positions, "20 are usual")
