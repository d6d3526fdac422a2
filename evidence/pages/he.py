"""What docs/he2022.md says of the spur pair of He et al. 2022, from the figures that were kept of its runs."""

from __future__ import annotations

import math
from pathlib import Path

from evidence.pages.he_figures import COMMAND, KEPT
from evidence.pages.kept import kept

ENDS = "_jump_up_rpm", "_jump_down_rpm"
POINTS = Path(__file__).with_name("he_points.md")


def points(docs: Path) -> str:
    """The paper's statements beside what was found: he_points.md with its figures; "none" for a missing jump."""
    figures = kept(docs / KEPT, COMMAND)
    jumps = {name.removesuffix("_rpm"): _jump(value) for name, value in figures.items() if name.endswith(ENDS)}
    return POINTS.read_text(encoding="utf-8").rstrip().format(**figures, **jumps)


def _jump(speed: float) -> str:
    return "none" if math.isnan(speed) else f"{speed:.0f}"
