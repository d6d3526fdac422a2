"""What docs/he2022.md says of the spur pair of He et al. 2022, from the figures that were kept of its runs."""

from __future__ import annotations

from pathlib import Path

from evidence.pages.he_figures import COMMAND, KEPT
from evidence.pages.kept import kept

POINTS = Path(__file__).with_name("he_points.md")


def points(docs: Path) -> str:
    """The paper's statements beside what was found: he_points.md with its figures."""
    return POINTS.read_text(encoding="utf-8").rstrip().format(**kept(docs / KEPT, COMMAND))
