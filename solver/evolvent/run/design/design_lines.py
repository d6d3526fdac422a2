"""Sentences of `evolvent design`: its last lines, and its warnings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.run.design.checked import BEST, BestRow, Checked
from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.evaluation import Variants
from evolvent.run.design.ranking import Ranking
from evolvent.run.design.tables import ALLOWED, DESIGN, FRONT, VariantRow
from evolvent.scene.schema.design import keys_of_both
from evolvent_meshes.arrays import Floats

BEST_SCENE = "best.toml"
"""Scene with the modifications of the best variant."""


def design_lines(folder: Path) -> Iterator[str]:
    """The best variant: its modifications, and under each torque its figures beside those of the scene as it stands and
    of the resolved contact."""
    variants, rows = DESIGN.read(folder), BEST.read(folder)
    yield f"{len(variants)} variants, {sum(row.status in (ALLOWED, FRONT) for row in variants)} of them allowed"
    best = [row for row in rows if row.rank == 1]
    if best:
        yield f"best: variant {best[0].variant}, {modifications(variants[best[0].variant])}"
    for row in best:
        before = next(each for each in rows if each.variant == 0 and each.torque_Nm == row.torque_Nm)
        yield f"{row.torque_Nm:.4g} N·m: transmission error {'; '.join(_figures(row, before))}"


def modifications(row: VariantRow) -> str:
    """Modifications of a variant in words."""
    return ", ".join(f"{name} = {value:.6g}" for name, value in row.values.items())


def _figures(row: BestRow, before: BestRow) -> Iterator[str]:
    """Figures of a variant under a torque. before: those of the scene as it stands."""
    line = _bar(row.transmission_error_peak_to_peak_um, row.transmission_error_peak_to_peak_um_error)
    resolved = _bar(row.resolved_peak_to_peak_um, row.resolved_peak_to_peak_um_error)
    if math.isnan(row.transmission_error_peak_to_peak_um):
        yield f"{resolved} µm peak to peak with the contact resolved, as edges of tips bear"
    else:
        yield f"{line} µm peak to peak"
        if not math.isnan(row.resolved_peak_to_peak_um):
            yield f"resolved {resolved} µm"
    was = before.transmission_error_peak_to_peak_um
    known = was if math.isfinite(was) else before.resolved_peak_to_peak_um
    if math.isfinite(known) and before.variant != row.variant:
        yield f"as it stands {known:.2f} µm"
    if not math.isnan(row.band_lowest_peak_to_peak_um):
        yield f"within tolerances {row.band_lowest_peak_to_peak_um:.2f} to {row.band_highest_peak_to_peak_um:.2f} µm"
    if not math.isnan(row.face_load_factor):
        yield f"K_Hβ {_bar(row.face_load_factor, row.face_load_factor_error)}"
    if not math.isnan(row.largest_pressure_MPa):
        yield f"p_0 {plus_minus(row.largest_pressure_MPa, row.largest_pressure_MPa_error, 0)} MPa"


def _bar(value: float, error: float) -> str:
    return plus_minus(value, error, 2)


def design_warnings(
    space: DesignSpace, variants: Variants, checked: Sequence[Checked], best: Checked | None
) -> Iterator[str]:
    """Sentences on variants without figures, on a best one at the end of an axis, on tolerances within which edges
    bear, and on the solutions of the best ones."""
    count = len(variants.values)
    if edges := int(Ranking(space.section, variants.figures).bears_on_edges.sum()):
        yield (
            f"{edges} of {count} variants have no figures: edges of tips bear, which is no line contact, as their "
            "reliefs are too small for the heaviest torque."
        )
    if failed := [reason for reason in variants.reasons if reason]:
        yield f"{len(failed)} of {count} variants cannot be computed. The first one: {failed[0]}"
    if best is None:
        yield "No variant is allowed: widen design.vary, or raise design.limits."
    else:
        yield from _at_ends(space, variants.values[best.variant])
    if best is not None and best.band is not None and Ranking(space.section, best.band).bears_on_edges.any():
        yield "Within the tolerances edges of tips bear: under these torques design_best.csv has no band."
    for each in checked:
        for name, solved in (("line contact", each.line), ("resolved contact", each.resolved)):
            for sentence in solved.warnings if solved is not None else ():
                yield f"variant {each.variant}, {name}: {sentence}"


def _at_ends(space: DesignSpace, variant: Floats) -> Iterator[str]:
    """A sentence on each key whose best value is an end of its range, but for none at all."""
    for row in space.section.vary:
        value = float(variant[space.keys.index(keys_of_both(row.key)[0])])
        if value == row.lowest != 0.0 or value + row.step > row.highest:
            yield f"{row.key}: the best value, {value:.6g}, ends its range; beyond it there may be better ones."
