"""All pictures of a run, drawn from what the run has left on disk."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from matplotlib.figure import Figure

from solver.display import off_screen
from solver.plots_drive import hertz_comparison, line_load, load_sharing, losses, transmission_error
from solver.plots_flank import has_two_lines, line_pressure_over_z, points_over_friction, pressure_map
from solver.plots_stress import engagement_stress, friction_trend, tooth_stress
from solver.plots_style import save, styled
from solver.run_data import RunData, read_run

Draw = Callable[[RunData], Figure]


def plot_directory(folder: Path) -> list[Path]:
    """Draws what the scene asks for into OUT/pictures from OUT/scene.toml and OUT/results; gives the files written.

    Raises SceneError, ArchiveError, OSError; RuntimeError where nothing can be rendered (the message says what to do).
    """
    return draw_all(read_run(folder), folder / "pictures")


def draw_all(run: RunData, folder: Path) -> list[Path]:
    """Draws the pictures and the animation, unless the scene's [output] says otherwise."""
    written = []
    with styled():
        if run.scene.output.pictures:
            written += [save(draw(run), folder / f"{name}.png") for name, draw in figures(run)]
        if run.scene.output.pictures or run.scene.output.animation:
            written += _in_space(run, folder)
    return written


def figures(run: RunData) -> Iterator[tuple[str, Draw]]:
    """(file name, drawing) of every flat figure that this run has the data for."""
    several, helical = len(run.frictions) > 1, run.pair.pinion.helix_angle > 0.0
    if not run.plane:
        yield "02_flank_pressure", pressure_map
    yield "03_stress_over_engagement", engagement_stress
    if helical:
        yield "04_stress_of_teeth", tooth_stress
    if several:
        yield "05_stress_over_friction", friction_trend
    if helical and has_two_lines(run):
        yield "06_pressure_along_lines", line_pressure_over_z
    if helical and several and has_two_lines(run):
        yield "07_points_A_to_D", points_over_friction
    yield "08_load_sharing", load_sharing
    yield "09_transmission_error", transmission_error
    yield "10_hertz", hertz_comparison
    if any(run.frictions):
        yield "11_friction_loss", losses
    yield "12_line_load", line_load


def _in_space(run: RunData, folder: Path) -> list[Path]:
    """The rendered pictures; pyvista is only loaded for them."""
    from solver.plots_space import animation, loaded_pair

    written = []
    with off_screen():
        if run.scene.output.pictures:
            written.append(save(loaded_pair(run), folder / "01_loaded_pair.png"))
        if run.scene.output.animation:
            written.append(animation(run, folder / "animation.gif"))
    return written
