"""A scene under a list of torques: a run for each, on gears that are condensed once. `evolvent loads` calls only
this."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.shared_gears import SharedGears
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import draw
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.results.figures.loads_picture import LOADS_PICTURE
from evolvent.results.tables.load_table import LOADS, RUNS, load_results
from evolvent.run.folder_checks import check_folder, require_no_study
from evolvent.run.scene_run import run_scene
from evolvent.run.start import resume_point, scene_to_solve
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.part_torque import under_torque
from evolvent.scene.scene import Scene
from evolvent.scene.schema.errors import InputProblem, SceneError


def run_loads(
    scenes: Mapping[str, Scene],
    out: Path,
    resume: bool = False,
    quiet: bool = False,
    overwrite: bool = False,
    source: Path | None = None,
) -> list[str]:
    """Computes a scene under some torques, one after the other, and writes everything to `out`: the folder of a run for
    each, a table and a picture of all. Returns a sentence for each picture that could not be drawn.

    scenes: see `load_scenes`. Other parameters: see `run_scene`, whose errors are raised; results of torques that are
    complete stay. Collective.
    """
    comm = MPI.COMM_WORLD

    def check() -> None:
        with locked(out):  # a folder that cannot be written is refused here
            require_no_study(out)
            RunFolder(out).require_free([LOADS.name, f"pictures/{LOADS_PICTURE.name}"])
            for name, each in scenes.items():
                check_folder(each, out / name, resume, overwrite, source)
                if resume:  # before the first of them is computed
                    solved = scene_to_solve(each, Archive(out / name, each), resume)
                    resume_point(solved, Archive(out / name, solved, "loads"), resume)

    on_first(comm, check)
    gears = SharedGears([gear_problem(each) for each in scenes.values()])
    for name, each in scenes.items():
        run_scene(each, out / name, resume, quiet, overwrite, source, gears.prepare)
    return on_first(comm, lambda: _written(out, list(scenes)))


def load_scenes(scene: Scene, percents: Sequence[float]) -> Mapping[str, Scene]:
    """Name of its folder -> the scene under each part of its torque, on meshes that serve all of them; the heaviest
    first. percents: different ones. Raises SceneError where the gears wear, or where one of the torques is refused."""
    if scene.wear is not None:
        found, allowed = "a load list of gears that wear", "a scene without [wear]"
        raise SceneError([InputProblem("wear", found, allowed, "delete the section, or take `evolvent run`")])
    torques = {percent: scene.load.torque_Nm * percent / 100.0 for percent in sorted(percents, reverse=True)}
    served = min(torques.values()), max(torques.values())
    return {_folder(percent): under_torque(scene, torque, served) for percent, torque in torques.items()}


def _folder(percent: float) -> str:
    """Name of the folder of a run, different for each percentage."""
    whole, point, decimals = str(float(percent)).partition(".")
    return RUNS.format(f"{whole:0>3}{point}{decimals}")


def _written(out: Path, names: Sequence[str]) -> list[str]:
    """Writes the table and the picture. On rank 0 alone. Raises WriteError, FolderError."""
    with locked(out):
        folder = RunFolder(out)
        LOADS.write(folder, [each.row for each in load_results(out / name for name in names)])
        return list(draw(from_tables([LOADS_PICTURE], out), folder).failures)
