"""Frames of an animation, and the file that shows them."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from evolvent.results.drawing.style import palette, reduced

FRAME_MS = 110
"""Time of a frame [ms]."""


def frame(figure: Figure) -> Image.Image:
    """The figure as an image."""
    canvas = FigureCanvasAgg(figure)
    figure.set_dpi(100)
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def settled(figure: Figure, axes: Axes) -> tuple[int, int, int, int]:
    """Lays the figure out once for all its frames. Gives the left, upper, right and lower end of the axes [pixels of a
    frame]."""
    height = frame(figure).height
    figure.set_layout_engine("none")
    left, low, right, high = (round(each) for each in axes.get_window_extent().extents)
    return left, height - high, right, height - low


def gif(frames: Sequence[Image.Image]) -> bytes:
    """The content of a GIF file that repeats the frames for ever."""
    colours = palette(frames[0])
    first, *others = [reduced(each, colours) for each in frames]
    content = io.BytesIO()
    first.save(
        content, format="GIF", save_all=True, append_images=others, duration=FRAME_MS, loop=0, optimize=True
    )
    return content.getvalue()
