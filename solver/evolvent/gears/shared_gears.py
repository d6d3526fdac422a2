"""Gears under a list of torques, or at several misalignments: condensed once, for all of them."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import replace

from mpi4py import MPI

from evolvent.gears.gear_model import CondensedGears, Mesher, Preparation, condensed_gears
from evolvent.gears.meshing.levelled_meshes import is_two_level, run_mesh
from evolvent.gears.meshing.sector_meshes import unmodified
from evolvent.gears.problem.gear_problem import GearProblem


def under_torques(problem: GearProblem, torques: Sequence[float]) -> list[GearProblem]:
    """The problem under each of some torques [N·mm], on meshes that serve all of them."""
    served = min(torques), max(torques)
    return [replace(problem, torque=torque, mesh_torques=served) for torque in torques]


class SharedGears:
    """Prepares each of some problems, condensing their gears when the first one is asked for.

    problems: alike but for what problems of one `shared_gears_name` may differ in.
    """

    def __init__(self, problems: Sequence[GearProblem]) -> None:
        self._problems = list(problems)
        self._gears: dict[Mesher, CondensedGears] = {}

    def prepare(
        self,
        problem: GearProblem,
        comm: MPI.Comm = MPI.COMM_WORLD,
        mesh: Mesher = run_mesh,
        meshed: Callable[[], None] = lambda: None,
    ) -> Preparation:
        """Gear model of one of the list's problems, as by `prepare_model`. The time of condensing counts for the first
        one."""
        if (known := self._gears.get(mesh)) is not None:
            meshed()
            return known.under(problem).without_time()
        self._gears[mesh] = condensed_gears(self._problems, comm, mesh, meshed)
        return self._gears[mesh].under(problem)


def shared_gears_name(problem: GearProblem) -> str:
    """Name of the condensed gears of a problem: problems of one name can have them from one `SharedGears`.
    They differ in torque and misalignment at most, and have the same `mesh_torques`; in line contact they may differ in
    these, too, and in the modifications and charts of their flanks."""
    if problem.is_line:
        gears = *map(unmodified, problem.pair.gears), problem.pair.centre_distance
        alike = gears, problem.materials, problem.options, problem.torque_on, problem.is_plane
        return hashlib.sha256(repr(("line", alike)).encode()).hexdigest()
    served = (problem.torque, problem.torque) if problem.mesh_torques is None else problem.mesh_torques
    bodies = replace(problem.pair, misalignment_um=0.0), problem.materials, problem.mesh, problem.options
    charts = [None if chart is None else chart.text() for chart in problem.flanks]
    content = repr((bodies, charts, problem.torque_on, served, problem.is_plane, is_two_level(problem)))
    return hashlib.sha256(content.encode()).hexdigest()
