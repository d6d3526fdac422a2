"""Computations without a display of their progress."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from mpi4py import MPI

from evolvent.gears.gear_model import Mesher, Preparation, Preparer, prepare_model
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.run.call import Options
from evolvent.run.computation import Computation
from evolvent.run.compute import compute


def quietly(
    what: Computation[Any], out: Path, resume: bool = False, overwrite: bool = False, prepare: Preparer = prepare_model
) -> list[str]:
    """Computes a scene into a folder; returns the warnings. Parameters as in `Options`."""
    return compute(what, out, Options(resume, overwrite, quiet=True, prepare=prepare))


def prepared_without(fails: Mesher, error: Exception) -> Preparer:
    """Prepares gears, but raises an error for those on meshes that `fails` makes."""

    def prepare(
        problem: GearProblem, comm: MPI.Comm, mesh: Mesher = run_mesh, meshed: Callable[[], None] = lambda: None
    ) -> Preparation:
        if mesh == fails:
            raise error
        return prepare_model(problem, comm, mesh, meshed)

    return prepare
