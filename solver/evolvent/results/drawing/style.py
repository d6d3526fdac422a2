"""Style of all figures: colours, sizes, title with subtitle, footnotes, and files."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont, get_font
from matplotlib.path import Path as Outline
from matplotlib.textpath import TextPath
from PIL import Image

from evolvent_meshes.files import write_bytes

PINION, WHEEL = "#1f5fa8", "#c0392b"
"""Colours of curves of the pinion and of the wheel."""
PINION_BODY, WHEEL_BODY = "#7d9cc4", "#cf8a7f"
"""Colours of the gears in space."""
TEETH = ("#3b7a57", "#8a5a9e", "#c98a1b", "#2d6fb0")
"""Colours of tooth pairs, the leading pair first."""
INK, FAINT = "#222222", "#8a8f98"
"""Colours of text and main lines, and of auxiliary lines."""
OVER = "#1f6fd0"
"""Colour of values above the upper end of a colour scale."""
ABOVE = "blue: above the scale, at a tip edge or the start of a linear relief"
"""Note on the colour `OVER`."""
AT_ZONE_END = "at the limit of a tip-edge zone"
"""Legend of a pressure at the limit of a tip-edge zone."""
OVER_KINK = "over the start of a linear relief"
"""Legend of a pressure where the contact of a spur pair covers the kink at which a linear relief begins."""
HOLLOW: dict[str, Any] = {"marker": "o", "markersize": 6.0, "markerfacecolor": "white", "linestyle": "", "zorder": 4.0}
"""Marker of a pressure at the limit of a tip-edge zone."""
PRESSURE_MAP = LinearSegmentedColormap.from_list(
    "evolvent_pressure", ["#eef0f2", "#fbe3a1", "#f7b24b", "#e8702a", "#c22a20", "#7d0c22", "#3a0418"]
).with_extremes(over=OVER)
"""Sequential colours from zero to the largest pressure; their lightness decreases throughout."""
FRICTION_MAP = LinearSegmentedColormap.from_list("evolvent_friction", ["#d97706", "#c2386b", "#6d3fa0", "#16213d"])
"""Colours of friction coefficients; even the lightest has a contrast of three to one on white."""
TORQUE_MAP = matplotlib.colormaps["YlGnBu"]
"""Colours of torques; its lightest third has too little contrast on white."""
STYLE = {  # of matplotlib
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#e3e6ea",
    "grid.linewidth": 0.8,
    "legend.frameon": True,
    "legend.framealpha": 1.0,  # no line shows through the text of a legend
    "legend.edgecolor": "none",
    "legend.fancybox": False,
    "legend.fontsize": 9.0,
    "lines.linewidth": 1.6,
    "savefig.dpi": 140.0,
    "figure.facecolor": "white",
}


@contextmanager
def styled() -> Iterator[None]:
    """Context in which matplotlib draws in this style."""
    with matplotlib.rc_context(STYLE):  # type: ignore[arg-type]  # the stubs list every key as a literal
        yield


def sheet(title: str, subtitle: str, size: tuple[float, float] = (9.6, 5.4)) -> Figure:
    """An empty figure with title and subtitle. subtitle: the main result in a sentence; size: width and height
    [inch]."""
    title = drawable(title)
    figure = Figure(figsize=size, layout="constrained")
    band, left, bottom = 0.62 / size[1], 0.14 / size[0], 0.08 / size[1]
    inside = (0.5 * left, bottom, 1.0 - 1.5 * left, 1.0 - band - bottom)  # labels extend beyond their axes
    figure.get_layout_engine().set(rect=inside)  # type: ignore[union-attr, call-arg]
    figure.text(
        left, 1.0 - 0.14 / size[1], title, va="top", ha="left", fontsize=13, fontweight="bold", color=INK,
        parse_math=False,  # a user's words, not a formula
    )
    figure.text(left, 1.0 - 0.42 / size[1], "", va="top", ha="left", color="#444444")
    set_subtitle(figure, subtitle)
    return figure


def set_subtitle(figure: Figure, subtitle: str) -> None:
    """Writes a subtitle below the title of a `sheet`, in smaller letters where it would be wider than the figure."""
    text = drawable(subtitle)
    size = 10.0 * min(1.0, (figure.get_figwidth() - 0.3) / max(text_width(text, 10.0), 1e-9))
    figure.texts[1].set(text=text, fontsize=size)


def text_width(text: str, size: float) -> float:
    """Width of a text [inch]. size: of its letters [points].

    It is that of the points of the letters' outlines, between which none bulges out sideways. Finding the extrema of
    all curves would take a tenth of a second.
    """
    outline = TextPath((0.0, 0.0), text, size=size)
    drawn = outline.vertices[outline.codes != Outline.CLOSEPOLY, 0]  # closing points lie at the origin
    return float(np.ptp(drawn)) / 72.0 if len(drawn) else 0.0


def foot(figure: Figure, *sentences: str) -> None:
    """Adds footnotes below a figure, one sentence per line."""
    if sentences:
        left = 0.14 / figure.get_figwidth()
        figure.supxlabel("\n".join(map(drawable, sentences)), fontsize=9.0, x=left, ha="left", color="#444444")


def drawable(text: str) -> str:
    """The text with a question mark for each character that the font of the pictures has not, such as control
    characters: matplotlib would warn of it and draw a box."""
    font = get_font(findfont(FontProperties(family=STYLE["font.family"])))  # type: ignore[arg-type]
    return "".join(each if font.get_char_index(ord(each)) else "?" for each in text)


def friction_colours(frictions: Sequence[float]) -> list[tuple[float, ...]]:
    """Colours of friction coefficients in their order, darker for more friction."""
    ranks = np.argsort(np.argsort(frictions)) / max(1, len(frictions) - 1)
    return [tuple(FRICTION_MAP(rank)) for rank in ranks]


def torque_colours(count: int) -> list[tuple[float, ...]]:
    """Colours of so many torques, the lightest first: the darker the heavier."""
    return [tuple(TORQUE_MAP(0.35 + 0.65 * rank / max(1, count - 1))) for rank in range(count)]


def dot_size(count: int) -> float:
    """Marker size for a scatter plot of `count` points."""
    return 3.0 if count > 400 else 7.0


def note(axes: Axes, text: str, x: float = 0.01, y: float = 0.98) -> None:
    """Adds a note inside the axes at (x, y) as parts of their size, by default at the upper left."""
    axes.text(x, y, text, transform=axes.transAxes, va="top", ha="left", fontsize=9, color="#444444")


def palette(image: Image.Image) -> Image.Image:
    """A palette image of at most 255 colours: white, the colours of the pressure map, that above its scale, and colours
    of the image. The first ones are fixed because quantisation would drop colours of few pixels."""
    scale = (255 * PRESSURE_MAP(np.append(np.linspace(0.0, 1.0, 70), 2.0))[:, :3]).round().astype(int)
    fixed = [255, 255, 255, *scale.ravel().tolist()]
    others = image.quantize(255 - len(fixed) // 3, dither=Image.Dither.NONE).getpalette() or []
    colours = Image.new("P", (1, 1))
    colours.putpalette([*fixed, *others][: 3 * 255])
    return colours


def reduced(image: Image.Image, colours: Image.Image) -> Image.Image:
    """The image in the colours of `palette`. White pixels are set explicitly, since Pillow rounds them."""
    indexed = image.quantize(palette=colours, dither=Image.Dither.NONE)
    white = (np.asarray(image) == 255).all(axis=-1)
    indexed.paste(0, mask=Image.fromarray(white))
    return indexed


def png(figure: Figure) -> bytes:
    """The content of a PNG file with the figure."""
    content = io.BytesIO()
    figure.savefig(content, format="png")
    return content.getvalue()


def png_of(figure: Callable[..., Figure], *content: object) -> bytes:
    """The content of a PNG file with the figure of some content, in this style."""
    with styled():
        return png(figure(*content))


def save(figure: Figure, path: Path) -> Path:
    """Writes a figure to a PNG file; returns its path. Raises WriteError."""
    return write_bytes(path, png(figure))
