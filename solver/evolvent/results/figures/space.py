"""Figure of the loaded pair in space, and animation of a pitch: rendered views in matplotlib figures."""

from __future__ import annotations

from contextlib import closing

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from PIL import Image

from evolvent.results.drawing.animations import frame, gif, settled
from evolvent.results.drawing.style import ABOVE, FAINT, OVER_KINK, PINION, PRESSURE_MAP, set_subtitle, sheet
from evolvent.results.engagement import Engagement, engagement
from evolvent.results.figures.flank import pressure_top
from evolvent.results.figures.scene3d import gear_picture, pair_pictures
from evolvent.results.figures.stress import STRESS, TOOTH_ANGLE
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import position_row
from evolvent.results.tables.summary_rows import PositionRow
from evolvent_meshes.gears.member import Member

VIEW_ASPECT = 0.84
"""Height over width of the pair in the animation."""
VIEW_POINTS = (210, 80)
"""Points on its flanks, along the profile and across the face: at most three pixels apart."""


def loaded_pair(run: RunData, index: int = 0) -> Figure:
    """Figure of the pair with the pressure on its flanks, and of the flanks of each gear."""
    k = most_loaded_position(run, index)
    result, top = run.positions[k][index].result, pressure_top(run, index)
    teeth = run.positions[k][index].teeth
    load = f"{run.scene.load.torque_Nm:g} N·m on the {run.scene.load.on}"
    subtitle = f"{load}: {len(teeth)} tooth pairs in contact{_largest(position_row(run, run.positions[k][index]))}"
    subtitle += f" (φ = {np.degrees(run.angles[k]):.2f}°, μ = {run.frictions[index]:g})."
    figure = sheet(f"{run.scene.title}: pressure on the flanks", subtitle, (12.4, 7.0))
    grid = figure.add_gridspec(2, 2, width_ratios=(1.72, 1.0))
    [pair] = pair_pictures(run, [result], top, (1500, 1060))
    _image(
        figure.add_subplot(grid[:, 0]),
        pair,
        "gear pair, wheel transparent (colours seen through it are altered)",
    )
    _image(
        figure.add_subplot(grid[0, 1]),
        gear_picture(run, result, Member.PINION, top, (960, 560)),
        "pinion flanks, wheel hidden",
    )
    _image(
        figure.add_subplot(grid[1, 1]),
        gear_picture(run, result, Member.WHEEL, top, (960, 560)),
        "wheel flanks, pinion hidden",
    )
    bar = figure.colorbar(
        ScalarMappable(Normalize(0.0, top), PRESSURE_MAP),
        ax=figure.axes,
        location="bottom",
        aspect=55,
        shrink=0.7,
        pad=0.015,
        extend="max",
    )
    bar.set_label(f"pressure [MPa]   ({ABOVE})")
    return figure


def most_loaded_position(run: RunData, index: int) -> int:
    """Index of the position with most teeth in contact, and among these with the largest pressure that is known."""
    largest = np.nan_to_num([position_row(run, each[index]).max_pressure_MPa for each in run.positions])
    return max(range(len(largest)), key=lambda k: (len(run.positions[k][index].teeth), largest[k]))


def _image(axes: Axes, image: NDArray[np.uint8], title: str) -> None:
    """Shows a rendered image without axes."""
    axes.imshow(image)
    axes.set_title(title, fontsize=10)
    axes.axis("off")


def animation(run: RunData, index: int = 0) -> bytes:
    """The content of a GIF file with one pitch. It repeats without a seam, since after a pitch every tooth has reached
    the place of the one ahead of it.

    Axes, curve and layout are those of all frames; a rendered view fills the left axes pixel by pixel.
    """
    curve, top = engagement(run, index), pressure_top(run, index)
    figure, view, dots = _stage(run, curve, top)
    left, upper, right, lower = settled(figure, view)
    results = [each[index].result for each in run.positions]
    images = pair_pictures(run, results, top, (right - left, lower - upper), close=1.0, points=VIEW_POINTS)
    frames = []
    with closing(images):
        for k, image in enumerate(images):
            _set_position(dots, run, index, k, curve)
            frames.append(frame(figure))
            frames[k].paste(Image.fromarray(image), (left, upper))
    return gif(frames)


def _largest(row: PositionRow) -> str:
    """Largest pressure of a position in words, with that over the start of a linear relief separately; empty where it
    is not known."""
    kink = [f"{row.kink_pressure_MPa:.0f} MPa {OVER_KINK}"] if row.kink_pressure_MPa > 0.0 else []
    where = "elsewhere" if kink else "at this position"
    peak = [f"at most {row.max_pressure_MPa:.0f} MPa {where}"] if np.isfinite(row.max_pressure_MPa) else []
    return "".join(f", {words}" for words in (*kink, *peak))


def _stage(run: RunData, curve: Engagement, top: float) -> tuple[Figure, Axes, Line2D]:
    """Figure of all frames: empty axes for the pair, the curve of contact stress, and dots of which none is shown yet;
    gives figure, empty axes and dots."""
    figure = sheet(run.scene.title, "", (9.0, 5.0))
    left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    left.set_box_aspect(VIEW_ASPECT)
    left.axis("off")
    scale = ScalarMappable(Normalize(0.0, top), PRESSURE_MAP)
    bar = {"fraction": 0.06, "pad": 0.01, "shrink": 0.8, "aspect": 40, "extend": "max"}
    shown = figure.colorbar(scale, ax=left, location="bottom", **bar)
    shown.set_label(f"pressure [MPa]\n({ABOVE})", size=9.0)
    right.plot(np.degrees(curve.angle), curve.max_pressure, color=FAINT)
    [dots] = right.plot([], [], "o", color=PINION, markersize=8)
    right.set(xlabel=TOOTH_ANGLE.split("   ")[0], ylabel=STRESS)
    right.set_ylim(bottom=0.0)
    return figure, left, dots


def _set_position(dots: Line2D, run: RunData, index: int, k: int, curve: Engagement) -> None:
    """Shows position k in the figure of all frames: its angle, and its teeth in contact on the curve."""
    assert isinstance(dots.figure, Figure)
    words = f"φ = {np.degrees(run.angles[k]):.2f}°, μ = {run.frictions[index]:g}; dots: tooth pairs in contact."
    set_subtitle(dots.figure, words)
    here = curve.position == k
    dots.set_data(np.degrees(curve.angle[here]), curve.max_pressure[here])
