"""The commands of `evolvent` that compute a scene into a folder; all ranks take part in them.

One factory, `_command`, makes them: their options, how they end and what they print are alike. A command says in a
function what it computes; the docstring of the function is its help.
"""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import typer

from evolvent.commands.command import Command
from evolvent.commands.exit import STATUSES, reported
from evolvent.commands.options import (
    ExactParts,
    Force,
    LevelOption,
    Overrides,
    Overwrite,
    Percents,
    PetscOptions,
    Quiet,
    ResultsFolder,
    Resume,
    SceneFile,
    results_folder,
)
from evolvent.commands.scene_argument import loaded_scene, require, require_room, unworn, warn
from evolvent.fem.parallel.mpi_start import world
from evolvent.scene.scene import Scene

# commands import what they need beyond the scene: their help must not wait for PETSc or pyvista

BOTH = (
    "--overwrite: found --resume and --overwrite; allowed: one of them; remedy: --resume keeps what --overwrite removes"
)
"""Message on two options that exclude each other."""
PETSC_OPTIONS = "EVOLVENT_PETSC_OPTIONS"
"""Environment variable that evolvent.fem.backend.petsc reads."""


@dataclass(frozen=True)
class Call:
    """Scene and options of a command line."""

    scene: Scene
    """Scene with --level, --set and --exact."""
    source: Path
    """Path of the scene file."""
    out: Path
    percents: Sequence[float]
    """Torques in percent of the scene's torque."""
    force: bool
    resume: bool
    overwrite: bool
    quiet: bool

    def require_room(self, scene: Scene, command: str = "run") -> None:
        """Raises SceneError where the machine has too little memory for the command. Collective."""
        require_room(scene, command, self.force, world())


@dataclass(frozen=True)
class Finished:
    """Outcome of computing a scene."""

    warnings: Sequence[str] = ()
    """Warnings on the results, a sentence each."""
    lines: Callable[[], Iterable[str]] = tuple
    """Figures for rank 0 to print, unless --quiet is given."""


Compute = Callable[[Call], Finished]
"""Function that computes a scene. Collective."""


def _run(call: Call) -> Finished:
    """Compute a scene.

    The positions of one angular pitch 2π/z_1 (one mesh cycle) for every friction coefficient; tables, fields and
    pictures go to DIR.
    """
    call.require_room(call.scene)
    from evolvent.run.output import last_lines
    from evolvent.run.scene_run import run_scene

    run_scene(
        call.scene, call.out, resume=call.resume, quiet=call.quiet, overwrite=call.overwrite, source=call.source
    )
    return Finished(lines=lambda: [last_lines(call.out, call.scene)])


def _loads(call: Call) -> Finished:
    """Compute a scene under a list of loads.

    The gears are condensed once. DIR gets the folder of a run for each load, and loads.csv and pictures/loads.png.
    """
    from evolvent.run.load_list import load_scenes, run_loads

    scenes = load_scenes(call.scene, call.percents)
    for each in scenes.values():
        call.require_room(each)
    return Finished(run_loads(scenes, call.out, call.resume, call.quiet, call.overwrite, call.source))


def _excitation(call: Call) -> Finished:
    """Compute what a pair's mesh does to its vibration.

    Without friction, over one angular pitch: the unloaded transmission error, and under each of a list of torques the
    loaded one and the mesh stiffness, tangent and secant, with their mesh harmonics. The gears are condensed once.
    """
    from evolvent.run.dynamics.excitation import run_excitation
    from evolvent.run.dynamics.scene_torques import scene_torques

    torques = scene_torques(call.scene, call.percents)
    call.require_room(torques.scene)
    return Finished(run_excitation(torques, call.out, call.resume, call.overwrite, call.quiet))


def _dynamics(call: Call) -> Finished:
    """Compute the vibration of a pair over the speed.

    The excitation by its mesh, then steady states, jumps, spectra and the motions of a pair that runs up and down, with
    the dynamic factor of ISO 6336-1 beside, as the section [dynamics] of the scene says.
    """
    from evolvent.run.dynamics.summary_lines import summary_lines
    from evolvent.run.dynamics.vibration import run_dynamics

    call.require_room(unworn(call.scene))
    warnings = run_dynamics(call.scene, call.out, call.resume, call.overwrite, call.quiet)
    return Finished(warnings, lambda: summary_lines(call.out))


def _transient(call: Call) -> Finished:
    """Compute a pair's contact with inertia, over time.

    At each speed of the section [transient] and each friction coefficient, until the motion repeats with the mesh:
    transmission error, mesh force and contact pressure, beside those without inertia.
    """
    from evolvent.run.dynamics.transient.summary_lines import summary_lines
    from evolvent.run.dynamics.transient.transient_run import run_transient

    unworn_scene = unworn(call.scene)
    call.require_room(unworn_scene)
    warnings = run_transient(unworn_scene, call.out, call.resume, call.overwrite, call.quiet)
    return Finished(warnings, lambda: summary_lines(call.out))


def _strength(call: Call) -> Finished:
    """Compute the stress at the roots of a pair's teeth.

    By finite elements over the whole engagement of a tooth, on both sides, beside ISO 6336-3 and formulas for chosen
    points of load. Nominal stresses: load factors multiply them.
    """
    from evolvent.run.strength.strength_run import run_strength
    from evolvent.run.strength.summary_lines import summary_lines

    call.require_room(unworn(call.scene), "strength")
    return Finished(run_strength(call.scene, call.out, call.overwrite, call.quiet), lambda: summary_lines(call.out))


def _fatigue(call: Call) -> Finished:
    """Compute what contact does to the flanks: criteria of fatigue over flank and depth.

    Under the pressures and the friction of the contact solution, by several criteria, as the section [fatigue] says;
    lives at several friction coefficients relative to the first.
    """
    from evolvent.run.strength.fatigue_lines import fatigue_lines
    from evolvent.run.strength.fatigue_run import run_fatigue

    call.require_room(unworn(call.scene))
    return Finished(run_fatigue(call.scene, call.out, call.overwrite, call.quiet), lambda: fatigue_lines(call.out))


def _command(
    compute: Compute,
    examples: str,
    folder: str = "Where tables and the picture go.",
    files: Sequence[str] = (),
    percents: str = "",
    without: Sequence[str] = ("petsc",),
) -> Command:
    """The command that is named as the function that computes.

    examples: command lines of the help. folder: help of --out. files: named at the end where they exist: pictures, and
    tables that a scene asks for, may be missing. percents: default of --percent; empty: no such option. without:
    further options that it has not.
    """
    name = compute.__name__.removeprefix("_")
    left_out = (*without, *(() if percents else ("percents",)))
    resuming = "" if "resume" in left_out else f"; `evolvent {name} ... --resume` continues"

    def command(
        scene: SceneFile,
        out: ResultsFolder,
        percents: Percents = (),
        level: LevelOption = None,
        settings: Overrides = None,
        exact: ExactParts = None,
        force: Force = False,
        resume: Resume = False,
        overwrite: Overwrite = False,
        quiet: Quiet = False,
        petsc: PetscOptions = None,
    ) -> None:
        with reported(parallel=True, advice=resuming):
            loaded = loaded_scene(scene, level, settings, exact, world())
            require(not (resume and overwrite), BOTH)
            if petsc is not None:
                os.environ[PETSC_OPTIONS] = petsc  # before PETSc starts
            call = Call(loaded, scene, out, percents, force, resume, overwrite, quiet)
            finished = compute(call)
            warn(finished.warnings)
            if not quiet and world().rank == 0:
                for line in finished.lines():
                    typer.echo(line)
                if existing := [str(out / each) for each in files if (out / each).exists()]:
                    typer.echo("done: " + ", ".join(existing))

    own = {"out": {"annotation": results_folder(folder)}, "percents": {"default": percents}}
    signature = inspect.signature(command, eval_str=True)
    parameters = [each.replace(**own.get(each.name, {})) for each in signature.parameters.values()
                  if each.name not in left_out]
    command.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {each.name: each.annotation for each in parameters}
    command.__doc__ = compute.__doc__
    epilog = "\n".join(["\b", "Examples:", *(f"  {line}" for line in examples.strip().split("\n")), "", STATUSES])
    return Command(name, command, epilog, parallel=True)


COMPUTING = (
    _command(
        _run, """\
evolvent run demos/yang2022.toml --out out/yang2022 --level quick
evolvent run demos/yang2022.toml --out out/t300 --set load.torque_Nm=300 --set contact.friction=[0,0.1]
mpirun -n 2 evolvent run demos/yang2022.toml --out out/yang2022 --resume""",
        folder="Where tables, fields and pictures go.", without=(),
    ),
    _command(
        _loads, """\
evolvent loads demos/yang2022.toml --out out/loads --level quick
mpirun -n 2 evolvent loads demos/yang2022.toml --out out/loads --percent 25,50,100,150""",
        folder="For a folder of each load.", files=("loads.csv", "pictures/loads.png"), percents="5,10,25,50,75,100",
    ),
    _command(
        _excitation, """\
evolvent excitation demos/he2022.toml --out out/excitation --set sweep.positions=40
mpirun -n 2 evolvent excitation demos/he2022.toml --out out/excitation --percent 10,50,100,200""",
        files=("excitation.csv", "harmonics.csv", "pictures/excitation.png"), percents="5,15,30,50,75,100,150,200",
    ),
    _command(
        _dynamics, """\
evolvent dynamics demos/he2022_dynamics.toml --out out/dynamics
evolvent dynamics demos/he2022_dynamics.toml --out out/dynamics --resume --set dynamics.damping_ratio=0.05""",
        folder="Where tables and pictures go.",
        files=("response.csv", "dynamics.json", "pictures/vibration.png", "pictures/waterfall.png"),
    ),
    _command(
        _transient, """\
evolvent transient demos/he2022.toml --out out/transient --level quick --set transient.speeds_rpm=[2000,3000]
mpirun -n 2 evolvent transient demos/yang2022.toml --out out/fast --level quick --set transient.speeds_rpm=[1500]
evolvent transient demos/he2022.toml --out out/transient --level quick --set transient.speeds_rpm=[2000,3000] \
--resume""",
        files=("transient.toml", "transient.csv", "transient_teeth.csv", "transient.json", "pictures/transient.png",
               "pictures/field_of_action.gif"),
    ),
    _command(
        _strength, """\
evolvent strength demos/zhang2023.toml --out out/zhang2023 --set pinion.face_width_mm=25
evolvent strength demos/he2022.toml --out out/roots --level quick --set contact.friction=[0,0.1]""",
        files=("strength.toml", "strength.csv", "root_stress.csv", "gauges.csv", "pictures/root_stress.png"),
        without=("resume", "petsc"),
    ),
    _command(
        _fatigue, """\
evolvent fatigue demos/yang2022.toml --out out/fatigue --level quick --set contact.friction=[0.132,0.107]
mpirun -n 2 evolvent fatigue demos/he2022.toml --out out/pitting --set fatigue.yield_stress_MPa=2000""",
        files=("fatigue.toml", "fatigue.csv", "fatigue_life.csv", "fatigue_map.csv", "fatigue_depth.csv",
               "fatigue.json", "pictures/fatigue.png"),
        without=("resume", "petsc"),
    ),
)
"""The commands of this file, in the order of the help."""
