"""List of all pictures of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from matplotlib.figure import Figure

from evolvent.results.drawing.offscreen import off_screen
from evolvent.results.drawing.picture_files import Picture
from evolvent.results.drawing.style import png_of, styled
from evolvent.results.figures.drive import line_load, load_sharing, losses, transmission_error
from evolvent.results.figures.flank import pressure_map
from evolvent.results.figures.hertz import hertz_comparison
from evolvent.results.figures.lines import has_lines, has_path_points, line_pressure_over_z, points_over_friction
from evolvent.results.figures.modified_flanks import has_modifications, modified_flanks
from evolvent.results.figures.stress import engagement_stress, tooth_stress
from evolvent.results.figures.trend import friction_trend
from evolvent.results.run_data import RunData

Draw = Callable[[RunData], Figure]
"""Function that draws a figure of a run."""


def pictures(run: RunData) -> Iterator[Picture]:
    """The pictures and the animation for which the scene's [output] asks."""
    if run.scene.output.pictures:
        if not run.is_line:
            yield Picture("01_loaded_pair.png", partial(_loaded_pair, run))
        for name, draw in figures(run):
            yield Picture(f"{name}.png", partial(png_of, draw, run))
    if run.scene.output.animation:
        yield Picture("animation.gif", partial(_animation, run))


def figures(run: RunData) -> Iterator[tuple[str, Draw]]:
    """Name, without ending, and drawing function of every plane figure for which the run has data; in line contact
    those that need no pressure across the contact."""
    several, helical = len(run.frictions) > 1, run.pair.pinion.helix_angle > 0.0
    if not (run.plane or run.is_line):
        yield "02_flank_pressure", pressure_map
    yield "03_stress_over_engagement", engagement_stress
    if helical:
        yield "04_stress_of_teeth", tooth_stress
    if several:
        yield "05_stress_over_friction", friction_trend
    if helical and has_lines(run):
        yield "06_pressure_along_lines", line_pressure_over_z
    if helical and several and has_lines(run) and has_path_points(run):
        yield "07_points_over_friction", points_over_friction
    yield "08_load_sharing", load_sharing
    yield "09_transmission_error", transmission_error
    if not run.is_line:
        yield "10_hertz", hertz_comparison
    if any(run.frictions):
        yield "11_friction_loss", losses
    yield "12_line_load", line_load
    if has_modifications(run):
        yield "13_flank_modifications", modified_flanks


def _loaded_pair(run: RunData) -> bytes:
    """PNG of the loaded pair in space."""
    from evolvent.results.figures.space import loaded_pair  # imported here because the import of pyvista is slow

    with off_screen():
        return png_of(loaded_pair, run)


def _animation(run: RunData) -> bytes:
    """GIF of the pair over a pitch."""
    from evolvent.results.figures.space import animation

    with styled(), off_screen():
        return animation(run)
