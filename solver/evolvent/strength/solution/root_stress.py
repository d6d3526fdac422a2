"""Root stress of both gears from Python: from the contact solution, and by ISO 6336-3.

On several ranks all of them call `root_stress`, and all get the result.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.meshing.root_meshes import FINER, RootMesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.problem.load_limits import check_load
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.solution.solver import check_frictions, check_positions
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.strength.certified_roots import certified_roots
from evolvent.strength.results.tables import (
    FrictionRoots,
    RootStressRow,
    StrengthRow,
    formula_rows,
    root_stress_rows,
    strength_rows,
)
from evolvent.strength.standard.factors import EDITIONS, Edition
from evolvent.strength.standard.root_stress import RootLoad, StandardStress, standard_stress
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import instance, is_index, number, numbers, refuse

NO_DEEP_TEETH = 12
"""Tolerance class by ISO 1328-1 of gears whose deep tooth factor is 1."""


@dataclass(frozen=True, eq=False)
class RootStress:
    """Nominal root stress of both gears over the engagement of a tooth, without load factors."""

    loads: tuple[RootLoad, RootLoad]
    """Loads of the roots of pinion and wheel, for the standard."""
    by_friction: tuple[FrictionRoots, ...]
    """Root stress of both gears at each friction coefficient: stress tensors at the nodes of their roots, too."""
    deflected: bool
    """Whether contact was searched again on deflected flanks, because energy did not balance without."""

    @property
    def curves(self) -> list[RootStressRow]:
        """Tension and compression over the rotation of a tooth, of both gears at each friction coefficient; the columns
        of root_stress.csv. Error bars are NaN."""
        return list(root_stress_rows(self.by_friction))

    def stresses(self, editions: Sequence[Edition] = (), tolerance_class: int = NO_DEEP_TEETH) -> list[StrengthRow]:
        """Largest stresses of both gears, with place, rotation, mean and amplitude, beside formulas; the columns of
        strength.csv. Error bars are NaN.

        editions: of ISO 6336-3. tolerance_class: by ISO 1328-1, for the deep tooth factor of 2006.

        Raises InputError, also for rims that the standard does not cover.
        """
        numbers("editions", editions)
        return [row for load in self.loads for row in strength_rows(load, self.by_friction, editions, tolerance_class)]

    def save(self, path: Path | str) -> Path:
        """Writes `curves` to a CSV file, and returns its path; creates missing folders. Raises InputError for another
        ending, WriteError."""
        from evolvent.results.solution.user_files import save_rows

        return save_rows(path, self.curves)

    def plot(self, path: Path | str) -> Path:
        """Draws `curves` beside the formulas to a PNG file, and returns its path; creates missing folders. Raises
        InputError for another ending and for rims that the standard does not cover, WriteError."""
        from evolvent.results.solution.user_files import save_picture
        from evolvent.strength.results.root_stress_picture import root_stress_figure

        pair = self.loads[0].pair
        title = f"Gear pair {pair.pinion.z}/{pair.wheel.z}"
        return save_picture(path, root_stress_figure, title, self.curves, self.stresses(EDITIONS))


def root_stress(
    problem: GearProblem, frictions: Sequence[float] = (0.0,), positions: int = 20, refinement: int = FINER,
    comm: MPI.Comm = MPI.COMM_WORLD,
) -> RootStress:
    """Root stress of both gears over a pitch, as of `evolvent strength`, without error bars: gears are meshed with
    finer roots and condensed, the pitch is solved, with further positions around the largest stresses.

    positions: uniform steps of the pitch 2π/z_1.
    refinement: factor on the elements around a fillet, from 1 to 4; at 1 there are six.

    Raises InputError, MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError.
    """
    instance("problem", problem, GearProblem, "write root_stress(GearProblem(pair, torque=...))")
    check_load(problem)
    check_frictions(frictions)
    check_positions(positions)
    if not (is_index(refinement) and 1 <= refinement <= 4):
        refuse("refinement", "a whole number from 1 to 4", refinement, f"{FINER} is usual")
    dolfinx_compat.silence_logs()
    one_sector = replace(problem, options=replace(problem.options, whole_gears=False))  # it has the roots
    gears = prepare_model(one_sector, comm, RootMesh(int(refinement))).model
    pitch = uniform_pitch(gears.pair.pinion.z, int(positions), gears.pitches, gears.load.driving)
    solved = certified_pitch(gears, pitch, list(frictions), comm)
    found = certified_roots(gears, problem, solved, list(frictions), comm)
    pinion, wheel = (RootLoad(problem.pair, member, problem.pinion_torque) for member in Member)
    order = problem.mesh.order
    roots = tuple(FrictionRoots(friction, own, None, order) for friction, own in zip(frictions, found.roots))
    return RootStress((pinion, wheel), roots, solved.deflected)


def iso_6336_3(
    pair: GearPair, pinion_torque: float, edition: Edition, tolerance_class: int = NO_DEEP_TEETH
) -> tuple[StandardStress, StandardStress]:
    """Nominal root stress σ_F0 of pinion and wheel by ISO 6336-3, Method B, with its factors; without load factors.

    pinion_torque: [N·mm].
    edition: 2006 or 2019.
    tolerance_class: by ISO 1328-1, for the deep tooth factor of 2006.

    Raises InputError, also for rims that the standard does not cover.
    """
    loads = _loads(pair, pinion_torque)
    pinion, wheel = (standard_stress(load, edition, tolerance_class) for load in loads)
    return pinion, wheel


def root_formulas(
    pair: GearPair, pinion_torque: float, editions: Sequence[Edition] = EDITIONS, tolerance_class: int = NO_DEEP_TEETH
) -> list[StrengthRow]:
    """Nominal root stress of both gears by all formulas: ISO 6336-3, and of spur gears with equal shares of the load at
    the points where pairs begin or end to share it, and largest over the path of contact with Pedrero's shares; the
    columns of strength.csv. Arguments and errors are those of `iso_6336_3`."""
    numbers("editions", editions)
    loads = _loads(pair, pinion_torque)
    return [row for load in loads for row in formula_rows(load, editions, tolerance_class)]


def _loads(pair: GearPair, pinion_torque: float) -> tuple[RootLoad, RootLoad]:
    """Loads of the roots of pinion and wheel. Raises InputError for a pair or torque that there is not."""
    instance("pair", pair, GearPair, "write GearPair(pinion, wheel, centre_distance)")
    number("pinion_torque", pinion_torque, "a number above 0, in N·mm", "170e3 are 170 N·m", lambda T: T > 0.0)
    pinion, wheel = (RootLoad(pair, member, pinion_torque) for member in Member)
    return pinion, wheel
