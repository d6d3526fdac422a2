"""The commands of `evolvent` that compute a scene: `run`, `loads`, `excitation`, `dynamics`, `transient`. All ranks
take part in them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from evolvent.command_output import done, warn
from evolvent.failures import STATUSES, reported
from evolvent.fem.parallel.mpi_start import world
from evolvent.options import (
    Force,
    LevelOption,
    NoSkip,
    Overrides,
    Overwrite,
    Quiet,
    Resume,
    SceneFile,
    TablesFolder,
    given_path,
    given_percents,
)
from evolvent.scene.scene import Scene
from evolvent.scene_argument import loaded_scene, require, require_room, unworn

# commands import what they need beyond the scene: their help must not wait for PETSc or pyvista

RESUME = "; `evolvent {} ... --resume` continues"
"""Appended to the message on a signal that ends a command."""
BOTH = (
    "--overwrite: found --resume and --overwrite; allowed: one of them; remedy: --resume keeps what --overwrite removes"
)
"""Message on two options that exclude each other."""
PETSC_OPTIONS = "EVOLVENT_PETSC_OPTIONS"
"""Environment variable that evolvent.fem.backend.petsc reads."""
Percents = Annotated[
    Any, typer.Option("--percent", metavar="LIST", help="In percent of the scene's torque.", parser=given_percents)
]
"""Torques."""
RUN_EPILOG = f"""\b
Examples:
  evolvent run demos/yang2022.toml --out out/yang2022 --level quick
  evolvent run demos/yang2022.toml --out out/t300 --set load.torque_Nm=300 --set contact.friction=[0,0.1]
  mpirun -n 2 evolvent run demos/yang2022.toml --out out/yang2022 --resume

{STATUSES}"""
LOADS_EPILOG = f"""\b
Examples:
  evolvent loads demos/yang2022.toml --out out/loads --level quick
  mpirun -n 2 evolvent loads demos/yang2022.toml --out out/loads --percent 25,50,100,150

{STATUSES}"""
DYNAMICS_EPILOG = f"""\b
Examples:
  evolvent dynamics demos/he2022_dynamics.toml --out out/dynamics
  evolvent dynamics demos/he2022_dynamics.toml --out out/dynamics --resume --set dynamics.damping_ratio=0.05

{STATUSES}"""
EXCITATION_EPILOG = f"""\b
Examples:
  evolvent excitation demos/he2022.toml --out out/excitation --set sweep.positions=40
  mpirun -n 2 evolvent excitation demos/he2022.toml --out out/excitation --percent 10,50,100,200

{STATUSES}"""


TRANSIENT_EPILOG = f"""\b
Examples:
  evolvent transient demos/he2022.toml --out out/transient --level quick --set transient.speeds_rpm=[2000,3000]
  mpirun -n 2 evolvent transient demos/yang2022.toml --out out/fast --level quick --set transient.speeds_rpm=[1500]
  evolvent transient demos/he2022.toml --out out/transient --level quick --set transient.speeds_rpm=[2000,3000] --resume

{STATUSES}"""

def run(
    scene: SceneFile,
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Where tables, fields and pictures go.", parser=given_path)
    ],
    level: LevelOption = None,
    settings: Overrides = None,
    no_skip: NoSkip = None,
    force: Force = False,
    resume: Resume = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
    petsc: Annotated[
        str | None, typer.Option("--petsc-options", metavar="OPTIONS", help='For PETSc, such as "-log_view".')
    ] = None,
) -> None:
    """Compute a scene.

    The positions of one angular pitch 2π/z_1 (one mesh cycle) for every friction coefficient; tables, fields and
    pictures go to DIR.
    """
    with reported(parallel=True, advice=RESUME.format("run")):
        loaded = loaded_scene(scene, level, settings, no_skip, world())
        require(not (resume and overwrite), BOTH)
        if petsc is not None:
            os.environ[PETSC_OPTIONS] = petsc  # before PETSc starts
        require_room(loaded, "run", force, world())
        from evolvent.run.output import last_lines
        from evolvent.run.scene_run import run_scene

        run_scene(loaded, out, resume=resume, quiet=quiet, overwrite=overwrite, source=scene)
        if not quiet:
            typer.echo(last_lines(out, loaded))


def loads(
    scene: SceneFile,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="For a folder of each load.", parser=given_path)],
    percent: Percents = "5,10,25,50,75,100",
    level: LevelOption = None,
    settings: Overrides = None,
    no_skip: NoSkip = None,
    force: Force = False,
    resume: Resume = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Compute a scene under a list of loads.

    The gears are condensed once. DIR gets the folder of a run for each load, and loads.csv and pictures/loads.png.
    """
    with reported(parallel=True, advice=RESUME.format("loads")):
        loaded = loaded_scene(scene, level, settings, no_skip, world())
        require(not (resume and overwrite), BOTH)
        from evolvent.run.load_list import run_loads

        scenes = _scenes(loaded, percent, force)
        warn(run_loads(scenes, out, resume, quiet, overwrite, scene))
        if not quiet:
            done(out, "loads.csv", "pictures/loads.png")


def excitation(
    scene: SceneFile,
    out: TablesFolder,
    percent: Percents = "5,15,30,50,75,100,150,200",
    level: LevelOption = None,
    settings: Overrides = None,
    no_skip: NoSkip = None,
    force: Force = False,
    resume: Resume = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Compute what a pair's mesh does to its vibration.

    Without friction, over one angular pitch: the unloaded transmission error, and under each of a list of torques the
    loaded one and the mesh stiffness, tangent and secant, with their mesh harmonics. The gears are condensed once.
    """
    with reported(parallel=True, advice=RESUME.format("excitation")):
        loaded = loaded_scene(scene, level, settings, no_skip, world())
        require(not (resume and overwrite), BOTH)
        from evolvent.run.dynamics.excitation import run_excitation
        from evolvent.run.dynamics.scene_torques import scene_torques

        torques = scene_torques(loaded, percent)
        require_room(torques.scene, "run", force, world())
        warn(run_excitation(torques, out, resume, overwrite, quiet))
        if not quiet and world().rank == 0:
            done(out, "excitation.csv", "harmonics.csv", "pictures/excitation.png")


def dynamics(
    scene: SceneFile,
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Where tables and pictures go.", parser=given_path)
    ],
    level: LevelOption = None,
    settings: Overrides = None,
    no_skip: NoSkip = None,
    force: Force = False,
    resume: Resume = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Compute the vibration of a pair over the speed.

    The excitation by its mesh, then steady states, jumps, spectra and the motions of a pair that runs up and down, with
    the dynamic factor of ISO 6336-1 beside, as the section [dynamics] of the scene says.
    """
    with reported(parallel=True, advice=RESUME.format("dynamics")):
        loaded = loaded_scene(scene, level, settings, no_skip, world())
        require(not (resume and overwrite), BOTH)
        from evolvent.run.dynamics.vibration import run_dynamics

        require_room(unworn(loaded), "run", force, world())
        warn(run_dynamics(loaded, out, resume, overwrite, quiet))
        if not quiet and world().rank == 0:
            done(out, "response.csv", "dynamics.json", "pictures/vibration.png", "pictures/waterfall.png")


def transient(
    scene: SceneFile,
    out: TablesFolder,
    level: LevelOption = None,
    settings: Overrides = None,
    no_skip: NoSkip = None,
    force: Force = False,
    resume: Resume = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Compute a pair's contact with inertia, over time.

    At each speed of the section [transient] and each friction coefficient, until the motion repeats with the mesh:
    transmission error, mesh force and contact pressure, beside those without inertia.
    """
    with reported(parallel=True, advice=RESUME.format("transient")):
        loaded = loaded_scene(scene, level, settings, no_skip, world())
        require(not (resume and overwrite), BOTH)
        from evolvent.run.dynamics.transient.transient_run import run_transient

        require_room(unworn(loaded), "run", force, world())
        warn(run_transient(unworn(loaded), out, resume, overwrite, quiet))
        if not quiet and world().rank == 0:
            from evolvent.run.dynamics.transient.summary_lines import summary_lines

            for line in summary_lines(out):
                typer.echo(line)
            done(out, "transient.toml", "transient.csv", "transient_teeth.csv", "transient.json",
                 "pictures/transient.png", "pictures/field_of_action.gif")


def _scenes(scene: Scene, percents: Sequence[float], force: bool) -> Mapping[str, Scene]:
    """The scene under each part of its torque, see `load_scenes`, all of which have room. Raises SceneError."""
    from evolvent.run.load_list import load_scenes

    scenes = load_scenes(scene, percents)
    for each in scenes.values():
        require_room(each, "run", force, world())
    return scenes
