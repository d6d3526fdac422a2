"""What docs/he2022.md says of the spur pair of He et al. 2022, from the figures that were kept of its runs."""

from __future__ import annotations

import math
from pathlib import Path

from evidence.pages.papers.he_figures import KEPT, REPORTS, SENSITIVITY
from evidence.pages.papers.he_runs import COMMAND
from evidence.pages.papers.kept_runs.kept import kept

ENDS = "_jump_up_rpm", "_jump_down_rpm"
VARIED = {
    "as_demo": "the demo: K/H = 1.3832e-10 mm²/N, damping ratio 0.03, computed force, rigid bodies, 722 N/µm in series",
    "elastic": "elastic bodies, 603 N/µm in series",
    "half_wear": "half K/H",
    "twice_wear": "twice K/H",
    "half_damping": "damping ratio 0.015",
    "twice_damping": "damping ratio 0.06",
    "tangent": "tangent stiffness times deflection",
    "secant": "secant stiffness times deflection",
}
"""As `he_figures.VARIED`."""
POINTS = Path(__file__).with_name("he_points.md")


def points(docs: Path) -> str:
    """The paper's statements beside what was found: he_points.md with its figures; "none" for a missing jump."""
    figures = kept(docs / KEPT, COMMAND)
    jumps = {name.removesuffix("_rpm"): _jump(value) for name, value in figures.items() if name.endswith(ENDS)}
    return POINTS.read_text(encoding="utf-8").rstrip().format(**figures, **jumps)


def sensitivity(docs: Path) -> str:
    """A line for each way in which the worn pair's vibration was computed."""
    figures = kept(docs / SENSITIVITY, COMMAND)
    heads = [f"{1e-6 * cycles:g}" for cycles in REPORTS]
    lines = [
        "| computed with | out of contact over the speed, at most, after … million meshes: "
        + " | ".join(heads)
        + " | deepest then | least peak-to-peak force at 2000 r/min after |",
        "| --- |" + " --- |" * (len(heads) + 2),
    ]
    for name, words in VARIED.items():
        shares = [f"{figures[f'{name}_worn_{cycles}_separated_percent']:.0f} %" for cycles in REPORTS]
        deepest = f"{figures[f'{name}_worn_{REPORTS[-1]}_deepest_um']:.2f} µm"
        least = f"{figures[f'{name}_worn_least_force_at_million']:.2f} million"
        lines.append(f"| {words} | {' | '.join(shares)} | {deepest} | {least} |")
    return "\n".join(lines)


def _jump(speed: float) -> str:
    return "none" if math.isnan(speed) else f"{speed:.0f}"
