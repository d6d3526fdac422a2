"""Commands that look at a scene, at a finished run, at records or at what is kept: `check`, `mesh`, `plot`,
`wear-coefficient`, `cache`, `info`. Rank 0 alone does them."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer

from evolvent.commands.command import Command
from evolvent.commands.exit import reported
from evolvent.commands.options import ExactParts, Force, LevelOption, Overrides, SceneFile, given_number, given_path
from evolvent.commands.scene_argument import loaded_scene, require, require_room, warn
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.line_level import require_resolved
from evolvent_meshes.files import require_writable, write_bytes

# commands import what they need beyond the scene: `check` and `info` must not wait for PETSc or pyvista
LIST, CLEAR = "list", "clear"
"""Requests to `cache`."""


def _require_new(out: Path, suffix: str, overwrite: bool) -> None:
    """Leaves with status 2 unless --out names a file of this kind that may be written."""
    example = f"pair{suffix}"
    require(out.suffix == suffix, f"--out: found {out}; allowed: a name that ends in {suffix}; remedy: --out {example}")
    require_writable(out)
    exists = f"--out: found {out}, which exists; allowed: a new file; remedy: --overwrite, or another name"
    require(overwrite or not (out.exists() or out.is_symlink()), exists)
    require(not out.is_dir(), f"--out: found the directory {out}; allowed: a file; remedy: --out {out}/{example}")


def check(
    scene: SceneFile,
    level: LevelOption = None,
    settings: Overrides = None,
    exact: ExactParts = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.png", help="Picture of the tooth forms.", parser=given_path)
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Write over FILE.png.")] = False,
    contact: Annotated[
        bool, typer.Option("--contact", help="Compute the pitch in line contact, too: in half a minute or less.")
    ] = False,
) -> None:
    """Validate a scene, print what follows from it.

    That is: the gear data, the Hertz estimates, what will be skipped, and an estimate of dofs and memory.
    """
    with reported():
        loaded = loaded_scene(scene, level, settings, exact, warns=False)
        from evolvent.check.check_report import overview

        if out is not None:
            _require_new(out, ".png", overwrite)
        typer.echo(overview(loaded))
        if contact:
            from evolvent.check.contact_rows import contact_table
            from evolvent.scene.skips import line_scene

            require_room(line_scene(loaded), "check", False)
            typer.echo(f"\n{contact_table(loaded)}")
        if out is not None:
            from evolvent.results.drawing.style import png_of
            from evolvent.results.drawing.tooth_form import tooth_form_figure

            write_bytes(out, png_of(tooth_form_figure, loaded.title, loaded.gear_pair()))
            typer.echo(f"\nTooth forms: {out}")


def mesh(
    scene: SceneFile,
    out: Annotated[Path, typer.Option("--out", metavar="FILE.msh", help="The gmsh file to write.", parser=given_path)],
    level: LevelOption = None,
    settings: Overrides = None,
    exact: ExactParts = None,
    force: Force = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Write over FILE.msh.")] = False,
) -> None:
    """Write the mesh of both sectors for gmsh.

    One tooth sector of each gear, in contact at the pitch point, with named groups.
    """
    with reported():
        loaded = loaded_scene(scene, level, settings, exact)
        require_resolved(loaded.mesh, "mesh")
        _require_new(out, ".msh", overwrite)
        require_room(loaded, "mesh", force)
        from evolvent.gears.meshing.levelled_meshes import is_two_level
        from evolvent.gears.meshing.standing_pair import standing_pair
        from evolvent.results.tables.run_warnings import WORST_CELL, bad_cells
        from evolvent_meshes.mesh.gmsh_io import write_msh
        from evolvent_meshes.mesh.quality import scaled_jacobians

        problem = gear_problem(loaded)
        made = standing_pair(problem)
        write_msh(made, out)
        quality = float(scaled_jacobians(made).min())
        counts = f"{len(made.cells):,} cells, {len(made.points):,} nodes"
        typer.echo(f"{out}: {counts}, smallest scaled Jacobian {quality:.2g}")
        if is_two_level(problem):
            typer.echo("The flanks of a run have finer levels: --exact two-level writes one fine mesh a sector")
        if quality < WORST_CELL:
            typer.echo(f"Warning: {bad_cells(quality)}", err=True)


def plot(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Where a command has put its results.", parser=given_path)
    ],
) -> None:
    """Draw the pictures of a finished command again."""
    with reported():
        from evolvent.run.kinds.redraw import plot_folder

        drawn = plot_folder(directory)
        warn(drawn.failures)
        count = len(drawn.written)
        typer.echo(f"{count} picture{'' if count == 1 else 's'} in {directory / 'pictures'}")


def wear_coefficient(
    records: Annotated[
        list[Path], typer.Argument(metavar="RECORD.csv...", help="Columns sliding_distance_m (or _mm, _km) and "
                                   "depth_um (or _mm).", parser=given_path)
    ],
    force: Annotated[float, typer.Option("--force-N", help="Normal force on the pin.", parser=given_number)],
    diameter: Annotated[float, typer.Option("--pin-diameter-mm", help="Diameter of the pin.", parser=given_number)],
    run_in: Annotated[
        float, typer.Option("--run-in-m", help="Sliding distance that is left out.", parser=given_number)
    ] = 0.0,
) -> None:
    """Archard's K/H from pin-on-disc records, with its spread."""
    with reported():
        from evolvent.wear.pin_on_disc import PinOnDisc, Record, coefficient

        test = PinOnDisc(force, diameter)
        read = [Record.read(path, 1e3 * run_in) for path in records]
        estimate = coefficient(read, test)
        for record, value in zip(read, estimate.each):
            typer.echo(f"{record.name}: {len(record.depth)} lines, K/H = {value:.4e} mm²/N")
        rate = 1e9 * estimate.value * test.pressure
        typer.echo(
            f"K/H = {estimate.value:.4e} mm²/N, 95 % between {estimate.low:.4e} and {estimate.high:.4e}; at "
            f"{test.pressure:.3f} MPa {rate:.4g} µm per km"
        )
        if estimate.low <= 0.0:
            warn(["the interval reaches below 0, which no K/H can: give more records"])


def cache(
    what: Annotated[str, typer.Argument(metavar="list|clear", help="Show what is kept, or remove all of it.")],
) -> None:
    """List or clear the condensed gears that are kept between calls."""
    with reported():
        require(what in (LIST, CLEAR), f"cache: found {what!r}; allowed: list, clear; remedy: evolvent cache list")
        from evolvent.fem.cache.cache import Cache

        kept, most = Cache(), Cache.of_environment().bound
        if what == CLEAR:
            typer.echo(f"{kept.clear() / 1e6:.0f} MB removed from {kept.folder}")
            return
        entries = kept.entries()
        for each in entries:
            used = datetime.fromtimestamp(each.used).isoformat(" ", "minutes")
            typer.echo(f"{each.size / 1e6:8.1f} MB  {used}  {each.about}")
        total = sum(each.size for each in entries)
        typer.echo(f"{total / 1e6:8.1f} MB of at most {most / 1e6:.0f} MB in {kept.folder}")


def info() -> None:
    """Print the versions of what a result depends on."""
    with reported():
        from evolvent.fem.backend.dolfinx_compat import versions

        typer.echo("\n".join(f"{name:<10} {version or 'not found'}" for name, version in versions().items()))


def _looking(name: str, function: Callable[..., None], example: str) -> Command:
    return Command(name, function, f"\b\nExample:\n  evolvent {name} {example}".rstrip())


LOOKING = (
    _looking("check", check, "demos/yang2022.toml --set pair.centre_distance_mm=93.1"),
    _looking("mesh", mesh, "demos/yang2022.toml --out pair.msh --level quick"),
    _looking("plot", plot, "out/yang2022"),
    _looking("wear-coefficient", wear_coefficient, "record.csv --force-N 500 --pin-diameter-mm 6 --run-in-m 500"),
    _looking("cache", cache, "list"),
    _looking("info", info, ""),
)
"""The commands of this file, in the order of the help."""
