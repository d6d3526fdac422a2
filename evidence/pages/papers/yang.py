"""What pages say of the helical pair of Yang et al. 2022, from the figures that were kept of its runs."""

from __future__ import annotations

from math import ceil
from pathlib import Path

from evidence.pages.papers.yang_estimate import estimates
from evidence.pages.papers.yang_figures import level_figures
from evidence.tables import markdown
from evolvent.gears.meshing.element_sizes import ELEMENTS_PER_WIDTH, LEVELS_PER_WIDTH
from evolvent.results.archive.error_bar_data import plus_minus

POINTS = Path(__file__).with_name("yang_points.md")


def beside_hertz(docs: Path, level: str) -> str:
    """How far the peaks at mid-face stand from Hertz for their own line load."""
    f = level_figures(docs, level)
    largest = ceil(10.0 * f["off_hertz_largest_percent"]) / 10.0
    return (
        f"{f['over_hertz_median_percent']:+.1f} % in the median, nine in ten within "
        f"{f['off_hertz_nine_in_ten_percent']:.1f} %, at most {largest:.1f} % off, "
        f"at ξ = {f['off_hertz_largest_xi_mm']:.1f} mm"
    )


def accuracy(docs: Path) -> str:
    """A sentence on both levels."""
    return (
        "Local resolution, which says nothing of how teeth share the load: peak pressures at mid-face of Yang's "
        "helical pair, compared with Hertz for their own line load: level "
        f"`quick`, for orientation only, {beside_hertz(docs, 'quick')}; level `standard` "
        f"{beside_hertz(docs, 'standard')}."
    )


def levels(docs: Path) -> str:
    """What to expect of each level."""
    usual, levelled = ELEMENTS_PER_WIDTH, LEVELS_PER_WIDTH
    return markdown(
        ("level", "elements across 2b_H", "peak pressure compared with Hertz for its own line load"),
        [
            (
                "quick",
                f"{usual['quick']:g}",
                f"{beside_hertz(docs, 'quick')} ([Yang's pair](yang2022.md), mid-face, with levels)",
            ),
            (
                "standard",
                f"{levelled['standard']:g} with [levels](two_level.md), else {usual['standard']:g}",
                f"{beside_hertz(docs, 'standard')} (the same)",
            ),
            ("fine", f"{usual['fine']:g}", "1 % (measured on the spur pair)"),
        ],
    )


def points(docs: Path) -> str:
    """The paper's statements beside what was found at level standard: yang_points.md with its figures."""
    f = level_figures(docs, "standard")
    bars: dict[str, str | float] = {"largest": plus_minus(f["largest_MPa"], f["low_largest_bar_MPa"], 0)}
    for side in ("low", "high"):
        for name, unit in (("transmission_error", "um"), ("efficiency", "percent")):
            value, bar = f[f"{side}_{name}_{unit}"], f[f"{side}_{name}_bar_{unit}"]
            bars[f"{side}_{name}"] = plus_minus(value, bar, 2)
        bars[f"{side}_balance_percent"] = 100.0 * f[f"{side}_energy_balance"]
    return POINTS.read_text(encoding="utf-8").rstrip().format(**f, **bars, **estimates())
