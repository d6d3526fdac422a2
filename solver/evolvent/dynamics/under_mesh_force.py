"""Gears whose contact is computed under the mesh force of their vibration."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from mpi4py import MPI

from evolvent.dynamics.operating_point import OperatingPoint, Operation
from evolvent.gears.gear_model import Mesher, Preparation, Preparer, prepare_model
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.problem.gear_problem import GearProblem


class UnderMeshForce:
    """Prepares gears like `prepare_model`. The mesh force is that of the first ones; others, such as those on coarser
    meshes for error bars, have the same.

    point: where the pair runs.
    prepared: makes the condensed gears under the static torque.
    begins: called before their vibration is computed.
    operation: None before the first gears.
    """

    def __init__(
        self, point: OperatingPoint, prepared: Preparer = prepare_model, begins: Callable[[], None] = lambda: None
    ) -> None:
        self.point, self.prepared, self.begins = point, prepared, begins
        self.operation: Operation | None = None

    def __call__(
        self,
        problem: GearProblem,
        comm: MPI.Comm = MPI.COMM_WORLD,
        mesh: Mesher = run_mesh,
        meshed: Callable[[], None] = lambda: None,
    ) -> Preparation:
        """Collective. Raises as `prepare_model` and `OperatingPoint.on`."""
        gears: Preparation = self.prepared(problem, comm, mesh, meshed)
        if self.operation is None:
            self.begins()
            self.operation = self.point.on(gears.model, problem.flanks, comm)
        load = replace(gears.model.load, course=self.operation.load.course)
        return replace(gears, model=replace(gears.model, load=load))
