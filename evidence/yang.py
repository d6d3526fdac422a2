"""`python -m evidence.yang OUT`: the figures of docs/yang2022.md, from a run of demos/yang2022.toml.

Of the smallest and of the largest friction coefficient of the run; angles are a tooth's own, 0 at the pitch point.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from meshes.data import Floats
from solver.engagement import Engagement, crossing, engagement, largest_peak
from solver.figure_rows import friction_rows
from solver.line_peaks import between
from solver.plots_lines import at_point
from solver.plots_stress import relative_change, trends
from solver.plots_teeth import YANG
from solver.plots_yang import paper_points, paper_position
from solver.run_data import RunData, read_run

Line = tuple[str, str]
NEAR_PITCH_LINE = 0.25  # modules of roll distance


def lines(run: RunData) -> Iterator[Line]:
    """(what, found) in the order of the page."""
    order = np.argsort(run.frictions)
    low, high = int(order[0]), int(order[-1])
    yield "friction coefficients", f"{run.frictions[low]:g} and {run.frictions[high]:g}"
    yield from _beside_hertz(run, low)
    yield from _over_the_engagement(engagement(run, low), engagement(run, high))
    yield from _teeth([engagement(run, low), engagement(run, high)])
    yield from _points(run, low, high)
    yield from _whole_pair(run, low, high)


def _beside_hertz(run: RunData, index: int) -> Iterator[Line]:
    """Fitted peaks over Hertz for the slice's own line load, in the layer at mid-face."""
    cuts = [each[index].cut for each in run.positions]
    z, ξ, peak, hertz = (np.concatenate([getattr(cut, name) for cut in cuts]) for name in ("z", "ξ", "peak", "hertz"))
    inside = np.isfinite(peak) & between(ξ, run.inner_path)
    middle = inside & (np.abs(z) <= np.abs(z).min() + 1e-9)
    off = 100.0 * (peak[middle] / hertz[middle] - 1.0)
    yield "mid-face, over Hertz: median, nine in ten within, largest", (
        f"{np.median(off):+.2f} %, {np.quantile(np.abs(off), 0.9):.1f} %, {np.abs(off).max():.1f} %"
    )
    near = inside & (np.abs(ξ) < NEAR_PITCH_LINE * run.pair.pinion.normal_module)
    yield "near the pitch line, median", f"{np.median(peak[near]):.0f} MPa"
    top = largest_peak(run, index)
    yield "largest pressure between the tip-edge zones", f"{top.pressure:.0f} MPa at ξ = {top.ξ:.2f} mm"


def _over_the_engagement(low: Engagement, high: Engagement) -> Iterator[Line]:
    top = int(np.nanargmax(low.max_pressure))
    yield "largest over the engagement", f"{low.max_pressure[top]:.0f} MPa at {np.degrees(low.angle[top]):+.1f}°"
    known = np.isfinite(low.max_pressure)
    angles, stress = low.angle[known], low.max_pressure[known]
    yield "where the tooth passes the pitch point", f"{np.interp(0.0, angles, stress):.0f} MPa"
    yield "near the tip, last of the curve", f"{stress[-1]:.0f} MPa at {np.degrees(angles[-1]):+.1f}°"
    angle, change = relative_change(high, low, np.ones(len(high.angle), dtype=bool))
    for name, side in (("before", angle < 0.0), ("after", angle > 0.0)):
        yield f"change with friction {name} the pitch point, 10 to 90 % of positions", _range(change[side])
    yield "the curves cross at", f"{np.degrees(crossing(low, high)):+.1f}°"


def _range(change: Floats) -> str:
    few, most = (100.0 * float(np.nanquantile(change, share)) for share in (0.1, 0.9))
    return f"{few:+.1f} to {most:+.1f} %"


def _teeth(curves: list[Engagement]) -> Iterator[Line]:
    for trend in trends(curves, list(YANG)):
        largest, average = (100.0 * (v[-1] / v[0] - 1.0) for v in (trend.largest, trend.average))
        yield f"tooth {2 - trend.tooth}: maximum, average", f"{largest:+.1f} %, {average:+.1f} %"


def _points(run: RunData, low: int, high: int) -> Iterator[Line]:
    k = paper_position(run)
    for point in paper_points(run, k):
        one, other = (at_point(run.positions[k][index].cut, point) for index in (low, high))
        yield f"point {point.name}", f"{one:.0f} MPa, {other - one:+.1f} MPa, {100 * (other / one - 1):+.1f} %"


def _whole_pair(run: RunData, low: int, high: int) -> Iterator[Line]:
    rows = friction_rows(run)
    for index in (low, high):
        row, share = rows[index], engagement(run, index).share.max()
        error = row.estimated_error
        yield f"μ = {row.friction:g}: largest share of a tooth", f"{100 * share:.0f} %"
        yield f"μ = {row.friction:g}: transmission error, peak to peak", (
            f"{row.transmission_error_peak_to_peak_um:.3f} µm"
        )
        yield f"μ = {row.friction:g}: efficiency", f"{100 - row.loss_percent:.2f} %"
        yield f"μ = {row.friction:g}: energy balance of the pitch", f"{row.balance_error:.1e}"
        yield f"μ = {row.friction:g}: estimated errors", str(error)


if __name__ == "__main__":
    for what, found in lines(read_run(Path(sys.argv[1]))):
        print(f"{what}: {found}")
