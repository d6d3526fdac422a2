"""Gear pairs that wear, from Python: the pair, and a certified study of it, block after block."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.operating_point import OperatingPoint
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.solution.certificates import certify, certify_pitch
from evolvent.gears.solution.solver import check_frictions, check_positions, condense
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.wear.archard import Archard
from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.gears.gear_study import StudyState, study_states
from evolvent.wear.gears.gear_wear import GearWear
from evolvent.wear.gears.meshed_pair import GearMeshMotion
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.input_checks import instance, number, numbers, refuse
from evolvent_meshes.mesh.mesh_data import MeshData

FIRST_BLOCK = 1e-2
"""Default length of the first block, over all cycles."""
REFRESH = 5e-3
"""Default wear in modules at which the meshes follow. He's pair worn by 6 µm, 2e-3 modules, has the same depths within
8e-4 of their volume (2.5e-3 with tip relief) whether its meshes follow every 0.5 µm or not at all."""


def wearing_pair(
    problem: GearProblem, law: Archard, friction: float = 0.0, positions: int = 20, refresh: float | None = None,
    comm: MPI.Comm = MPI.COMM_WORLD, operating: OperatingPoint | None = None,
) -> GearWear:
    """A gear pair that wears, its gears condensed; a cycle is one revolution of the pinion. Collective.

    law: wear coefficients of pinion and wheel. refresh: depth [mm] at which the meshes follow the wear, by default 5e-3
    modules. operating: speed under whose mesh force it wears, by default under the constant torque. Raises InputError,
    and what `condense` raises.
    """
    instance("problem", problem, GearProblem, "give the problem itself, its gears are condensed here")
    instance("law", law, Archard, "write Archard(1e-10, 1e-10), of pinion and wheel")
    if refresh is not None:
        number("refresh", refresh, "a depth > 0 [mm]", "leave it out for 5e-3 modules", lambda depth: depth > 0.0)
    check_frictions([friction])
    check_positions(positions)
    if problem.options.deflected_flanks or problem.options.whole_engagement:
        raise InputError(
            "wear of gears: wanted one pitch on flanks before deflection, found the option deflected_flanks or "
            "whole_engagement; leave them out"
        )

    if problem.mesh.two_level is None:  # wear is followed on the nodes of one fine mesh
        problem = replace(problem, mesh=replace(problem.mesh, two_level=False))

    def condensed(mesh: Callable[[Member], MeshData]) -> GearModel:
        return prepare_model(problem, comm, lambda _, member: mesh(member), as_meshed=True).model

    depth = REFRESH * problem.pair.pinion.normal_module if refresh is None else refresh
    pitch = uniform_pitch(problem.pair.pinion.z, int(positions))
    return GearWear(condense(problem, comm), pitch, friction, law, comm, GearMeshMotion(depth, condensed), operating)


def wear_study(pair: GearWear, reports: Sequence[float], settings: BlockSettings | None = None) -> Iterator[StudyState]:
    """The unworn state and that after each block of cycles, each certified; the last report ends the study. Collective.

    reports: revolutions of the pinion at which a block ends, ascending. settings: of the blocks, by default implicit
    ones, the first of a hundredth of all cycles. Raises InputError, WearStopped, VolumeLost, NotConverged,
    BalanceError.
    """
    instance("pair", pair, GearWear, "give what wearing_pair(problem, law) returns")
    numbers("reports", reports)
    cycles = [number("reports", each, "numbers of cycles") for each in reports]
    if not (cycles and (np.diff([0.0, *cycles]) > 0.0).all()):
        refuse("reports", "ascending numbers of cycles above 0", list(reports), "sort them")
    if settings is not None:
        instance("settings", settings, BlockSettings, "write BlockSettings(first=...)")
    return _certified(pair, cycles, settings or BlockSettings(FIRST_BLOCK * cycles[-1]))


def _certified(pair: GearWear, reports: Sequence[float], settings: BlockSettings) -> Iterator[StudyState]:
    """The states of a study, each certified. Raises WearStopped, VolumeLost, NotConverged, BalanceError."""
    for stage in study_states(pair, reports, settings):
        positions = stage.state.evaluation.positions
        certify(positions)
        certify_pitch([result] for result in positions)
        yield stage
