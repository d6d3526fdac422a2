"""A pitch of a gear pair from Python: solved, certified, and the curves that it gives.

It stands above the gear rooms because a solution draws and writes itself. What it needs for that is imported then, so
that a program that only solves loads neither scenes nor matplotlib. On several ranks all of them call these functions,
and all get all results.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.contact.problem.user_warnings import warn_user
from evolvent.contact.step.contact_width import CoarseContactWarning
from evolvent.gears.gear_load import GearLoad
from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.contact_cells import FEWEST_CELLS, SCATTER, cells_across
from evolvent.gears.pressure.line_peaks import LinePeak
from evolvent.gears.pressure.pitch_pressure import PitchPressure, pitch_pressures
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.solution.solver import check_friction, check_frictions, check_positions, check_resolved
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.solution.pitch_row import PitchRow
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True, eq=False)
class PitchSolution:
    """A certified pitch at one friction coefficient: k positions in equal steps, whose friction history is periodic."""

    pair: GearPair
    """Gear pair."""
    load: GearLoad
    """Torque that the gears were condensed for, per mm of face width of a plane problem."""
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
        """Moments of the contact forces about both axes (k, 2) [N·mm], both positive: input on the gear that drives,
        output of the other one."""
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
        return float(lost / sum(abs(result.input_power) for result in self.results))

    @property
    def rows(self) -> list[PitchRow]:
        """Curves of the pitch as a table, a row a position, in the units of positions.csv."""
        columns = zip(
            np.degrees(self.angles), 1e-3 * self.torques, 1e3 * self.transmission_error, 1e-3 * self.mesh_stiffness,
            self.max_pressure, self.tip_edge,
        )
        return [
            PitchRow(
                pinion_angle_deg=float(angle), friction=self.friction, torque_pinion_Nm=float(torque[0]),
                torque_gear_Nm=float(torque[1]), transmission_error_um=float(error),
                mesh_stiffness_N_per_um=float(stiffness), max_pressure_MPa=float(pressure), tip_edge=bool(edge),
            )
            for angle, torque, error, stiffness, pressure, edge in columns
        ]

    def save(self, path: Path | str) -> Path:
        """Writes `rows` to a CSV file, and returns its path; creates missing folders. Raises InputError for another
        ending, WriteError."""
        from evolvent.results.solution.user_files import save_rows

        return save_rows(path, self.rows)

    def plot(self, path: Path | str) -> Path:
        """Draws transmission error, mesh stiffness and largest pressure over the pitch to a PNG file, and returns its
        path; creates missing folders. Raises InputError for another ending, WriteError."""
        from evolvent.results.solution.pitch_picture import pitch_figure
        from evolvent.results.solution.user_files import save_picture

        return save_picture(path, pitch_figure, self.rows)


def solve_pitch(
    gears: GearModel, friction: float = 0.0, positions: int = 20, comm: MPI.Comm = MPI.COMM_WORLD
) -> PitchSolution:
    """The pitch at one friction coefficient, see `solve_pitches`."""
    check_friction(friction)
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
    check_resolved(gears)
    check_frictions(frictions)
    check_positions(positions)
    pitch = uniform_pitch(gears.pair.pinion.z, int(positions), gears.pitches, gears.load.driving)
    solved = certified_pitch(gears, pitch, list(frictions), comm)
    pressures = pitch_pressures(gears, [position.results for position in solved.positions])
    cells = [_cells_across(gears, pressure) for pressure in pressures]
    if comm.rank == 0:
        _warn_if_coarse(min(cells))
    return tuple(
        PitchSolution(gears.pair, gears.load, friction, results, pressure, gears.width_factor, count, solved.deflected)
        for friction, results, pressure, count in zip(frictions, solved.by_friction, pressures, cells)
    )


def _cells_across(gears: GearModel, pressure: PitchPressure) -> float:
    """Elements across the fitted contact width 2b, median of all positions."""
    pinion, half_widths = gears.bodies[0], np.concatenate([cut.half_width for cut in pressure.cuts])
    return cells_across(half_widths, pinion.z, pinion.roll_length, pinion.gear.base_radius, pinion.mesh.order)


def _warn_if_coarse(cells: float) -> None:
    """Warns at the user's line of a contact of fewer than `FEWEST_CELLS` elements, as `evolvent run` does."""
    if not cells >= FEWEST_CELLS:
        warn_user(
            f"gear pair: wanted a contact at least {FEWEST_CELLS:g} elements wide, found {cells:.2f} (median): peak "
            f'pressures {SCATTER}; take MeshSettings("standard") or MeshSettings(elements_per_contact_width=3)',
            CoarseContactWarning,
        )
