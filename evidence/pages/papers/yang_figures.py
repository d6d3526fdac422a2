"""`python -m evidence.pages.papers.yang_figures OUT`: keeps the figures of docs/yang2022.md of a run of its scene.

They are those at the smallest and at the largest friction coefficient of the run. Angles are those of a tooth, 0 at the
pitch point. `python -m evidence.pages` then writes them into the pages. README's picture is that of level standard.
"""

from __future__ import annotations

import sys
from pathlib import Path
from shutil import copy

import numpy as np

from evidence.checkout import DOCS
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evidence.pages.papers.yang_places import TEETH, at_point, paper_points, paper_position
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.pressure.line_peaks import between, pooled_peaks
from evolvent.results.engagement import Engagement, crossing, engagement, largest_peak
from evolvent.results.figures.stress import relative_change
from evolvent.results.figures.trend import trends
from evolvent.results.run_data import RunData, read_run
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.summary_rows import FrictionRow

KEPT = "yang2022"
NEAR_PITCH_LINE = 0.25  # modules of roll distance
NEAR_TIP_deg = 22.0  # a tooth's own rotation from which its contact is near the pinion's tip


def figures(run: RunData) -> Named:
    """(name, value) of each figure."""
    order = np.argsort(run.frictions)
    low, high = int(order[0]), int(order[-1])
    yield from _beside_hertz(run, low)
    yield from _over_the_engagement(engagement(run, low), engagement(run, high))
    for trend in trends([engagement(run, low), engagement(run, high)], list(TEETH)):
        for name, values in (("largest", trend.largest), ("average", trend.average)):
            yield f"tooth_{2 - trend.tooth}_{name}_change_percent", 100.0 * float(values[-1] / values[0] - 1.0)
    yield from _points(run, low, high)
    rows = friction_rows(run)
    yield from _whole_pair(run, "low", low, rows[low])
    yield from _whole_pair(run, "high", high, rows[high])


def _beside_hertz(run: RunData, index: int) -> Named:
    """Peaks as a run reports them over Hertz for the slice's own line load, in the layer at mid-face."""
    cuts = [each[index].cut for each in run.positions]
    whole = Slices.joined(cuts)
    z, ξ, hertz = whole.z, whole.roll_distance, whole.hertz
    peak = np.concatenate([pooled_peaks(cut) for cut in cuts])
    inside = np.isfinite(peak) & between(ξ, run.inner_path)
    middle = inside & (np.abs(z) <= np.abs(z).min() + 1e-9)
    off = 100.0 * (peak[middle] / hertz[middle] - 1.0)
    worst = int(np.argmax(np.abs(off)))
    yield "over_hertz_median_percent", float(np.median(off))
    yield "off_hertz_nine_in_ten_percent", float(np.quantile(np.abs(off), 0.9))
    yield "off_hertz_largest_percent", float(np.abs(off[worst]))
    yield "off_hertz_largest_xi_mm", float(ξ[middle][worst])
    near = inside & (np.abs(ξ) < NEAR_PITCH_LINE * run.pair.pinion.normal_module)
    yield "near_pitch_line_median_MPa", float(np.median(peak[near]))
    yield "largest_xi_mm", largest_peak(run, index).roll_distance


def _over_the_engagement(low: Engagement, high: Engagement) -> Named:
    yield "largest_MPa", low.peak.pressure
    yield "largest_deg", float(np.degrees(low.peak.angle))
    known = np.isfinite(low.max_pressure)
    angle, stress = np.degrees(low.angle[known]), low.max_pressure[known]
    yield "at_pitch_point_MPa", float(np.interp(0.0, angle, stress))
    tip = stress[angle >= NEAR_TIP_deg]
    yield "near_tip_least_MPa", float(tip.min())
    yield "near_tip_largest_MPa", float(tip.max())
    yield "last_deg", float(angle[-1])
    at, change = relative_change(high, low, np.ones(len(high.angle), dtype=bool))
    for name, side in (("before", at < 0.0), ("after", at > 0.0)):
        for share, end in ((0.1, "low"), (0.9, "high")):
            yield f"change_{name}_{end}_percent", 100.0 * float(np.nanquantile(change[side], share))
    yield "crossing_deg", float(np.degrees(crossing(low, high)))


def _points(run: RunData, low: int, high: int) -> Named:
    k = paper_position(run)
    for point in paper_points(run, k):
        one, other = (at_point(run.positions[k][index].cut, point) for index in (low, high))
        yield f"point_{point.name}_MPa", one
        yield f"point_{point.name}_change_MPa", other - one
        yield f"point_{point.name}_change_percent", 100.0 * (other / one - 1.0)


def _whole_pair(run: RunData, name: str, index: int, row: FrictionRow) -> Named:
    curve = engagement(run, index)
    if (errors := row.estimated_error) is None:
        raise ValueError(f"{run.errors.missing}: wanted a run with error bars, `run` with --resume computes them")
    teeth = np.bincount(curve.position[curve.force > 0.0])
    yield f"{name}_friction", row.friction
    yield f"{name}_largest_bar_MPa", errors.max_pressure_MPa
    yield f"{name}_fewest_teeth", float(teeth.min())
    yield f"{name}_most_teeth", float(teeth.max())
    yield f"{name}_largest_share_percent", 100.0 * float(curve.share.max())
    yield f"{name}_transmission_error_um", row.transmission_error_peak_to_peak_um
    yield f"{name}_transmission_error_bar_um", errors.transmission_error_peak_to_peak_um
    yield f"{name}_efficiency_percent", 100.0 - row.loss_percent
    yield f"{name}_efficiency_bar_percent", errors.loss_percent
    yield f"{name}_energy_balance", row.balance_error


def keep(run: RunData, docs: Path) -> Path:
    """The figures of a run, in place of those at the same mesh level. Raises OSError."""
    return kept.keep(docs / KEPT / f"{run.scene.mesh.level}.csv", figures(run))


def level_figures(docs: Path, level: str) -> dict[str, float]:
    """What was kept. Raises ValueError where nothing was."""
    return kept.kept(docs / KEPT / f"{level}.csv", "python -m evidence.pages.papers.yang_figures OUT")


def main() -> None:
    """Keeps the figures of a run, and the picture of its loaded pair."""
    folder = Path(sys.argv[1])
    run = read_run(folder)
    print(keep(run, DOCS))
    if run.scene.mesh.level == "standard":
        copy(folder / "pictures/01_loaded_pair.png", DOCS / "pictures/loaded_pair.png")


if __name__ == "__main__":
    main()
