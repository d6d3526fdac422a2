"""The commands of `evolvent` that compute what a scene does to its gears: `strength` at the roots, `fatigue` of the
flanks. All ranks take part in them."""

from __future__ import annotations

import typer

from evolvent.command_output import done, warn
from evolvent.failures import STATUSES, reported
from evolvent.fem.parallel.mpi_start import world
from evolvent.options import Force, LevelOption, NoSkip, Overrides, Overwrite, Quiet, SceneFile, TablesFolder
from evolvent.scene_argument import loaded_scene, require_room, unworn

# commands import what they need beyond the scene: their help must not wait for PETSc or pyvista

STRENGTH_EPILOG = f"""\b
Examples:
  evolvent strength demos/zhang2023.toml --out out/zhang2023 --set pinion.face_width_mm=25
  evolvent strength demos/he2022.toml --out out/roots --level quick --set contact.friction=[0,0.1]

{STATUSES}"""

FATIGUE_EPILOG = f"""\b
Examples:
  evolvent fatigue demos/yang2022.toml --out out/fatigue --level quick --set contact.friction=[0.132,0.107]
  mpirun -n 2 evolvent fatigue demos/he2022.toml --out out/pitting --set fatigue.yield_stress_MPa=2000

{STATUSES}"""


def strength(
    scene: SceneFile,
    out: TablesFolder,
    level: LevelOption = None,
    settings: Overrides = None,
    no_skip: NoSkip = None,
    force: Force = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Compute the stress at the roots of a pair's teeth.

    By finite elements over the whole engagement of a tooth, on both sides, beside ISO 6336-3 and formulas for chosen
    points of load. Nominal stresses: load factors multiply them.
    """
    with reported(parallel=True):
        loaded = loaded_scene(scene, level, settings, no_skip, world())
        from evolvent.run.strength.strength_run import run_strength

        require_room(unworn(loaded), "strength", force, world())
        warn(run_strength(loaded, out, overwrite, quiet))
        if not quiet and world().rank == 0:
            from evolvent.run.strength.summary_lines import summary_lines

            for line in summary_lines(out):
                typer.echo(line)
            done(out, "strength.toml", "strength.csv", "root_stress.csv", "gauges.csv", "pictures/root_stress.png")


def fatigue(
    scene: SceneFile,
    out: TablesFolder,
    level: LevelOption = None,
    settings: Overrides = None,
    no_skip: NoSkip = None,
    force: Force = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Compute what contact does to the flanks: criteria of fatigue over flank and depth.

    Under the pressures and the friction of the contact solution, by several criteria, as the section [fatigue] says;
    lives at several friction coefficients relative to the first.
    """
    with reported(parallel=True):
        loaded = loaded_scene(scene, level, settings, no_skip, world())
        from evolvent.run.strength.fatigue_run import run_fatigue

        require_room(unworn(loaded), "run", force, world())
        warn(run_fatigue(loaded, out, overwrite, quiet))
        if not quiet and world().rank == 0:
            from evolvent.run.strength.fatigue_lines import fatigue_lines

            for line in fatigue_lines(out):
                typer.echo(line)
            done(out, "fatigue.toml", "fatigue.csv", "fatigue_life.csv", "fatigue_map.csv", "fatigue_depth.csv",
                  "fatigue.json", "pictures/fatigue.png")
