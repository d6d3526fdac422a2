"""What docs/zhang2023.md says of the spur pair of Zhang et al. 2023, from the figures that were kept of its runs."""

from __future__ import annotations

from pathlib import Path

from evidence.pages.papers.kept_runs.kept import kept
from evidence.pages.papers.zhang_figures import COMMAND, KEPT, RADII
from evolvent.results.archive.error_bar_data import plus_minus

DIFFERENCES = Path(__file__).with_name("zhang_differences.md")
POINTS = Path(__file__).with_name("zhang_points.md")


def points(docs: Path) -> str:
    """The paper's statements beside what was found: zhang_points.md with its figures."""
    f = kept(docs / KEPT, COMMAND)
    bars = {}
    for gear in ("pinion", "wheel"):
        for radius in RADII:
            for end, name in (("still", ""), ("sliding", "_sliding")):
                head = f"{gear}_500_{radius}_{end}_tension_MPa"
                bars[f"{gear}_{radius}{name}"] = plus_minus(f[head], f[f"{head}_error"], 0)
        for end, name in (("still", ""), ("sliding", "_sliding")):
            head = f"{gear}_space_{end}_tension"
            bars[f"{gear}_space{name}"] = plus_minus(f[f"{head}_MPa"], f[f"{head}_error_MPa"], 0)
    return POINTS.read_text(encoding="utf-8").rstrip().format(**f, **bars)


def differences(docs: Path) -> str:
    """Why they differ: zhang_differences.md with its figures."""
    return DIFFERENCES.read_text(encoding="utf-8").rstrip().format(**kept(docs / KEPT, COMMAND))
