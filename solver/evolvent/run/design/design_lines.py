"""Sentences of `evolvent design`: its last lines, and its warnings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import numpy as np

from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.results.drawing.labels import label
from evolvent.results.tables.table import SceneValue
from evolvent.run.design.checked import BEST, BestRow, Checked
from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.evaluation import Variants
from evolvent.run.design.ranking import SAME, Ranking
from evolvent.run.design.tables import ALLOWED, DESIGN, EDGES, FRONT, VariantRow
from evolvent.scene.schema.design import FIGURES, HARMONIC, Figure, keys_of_both
from evolvent_meshes.arrays import Floats

BEST_SCENE = "best.toml"
"""Scene with the modifications of the best variant."""
SECTION = SceneValue("scene.toml", "design")
"""Targets and limits."""
BAND_ENDS: Mapping[Figure, str] = MappingProxyType(dict(zip(FIGURES, (
    "band_highest_peak_to_peak_um", "band_highest_face_load_factor", "band_highest_pressure_MPa",
    "band_highest_loss_percent", "band_highest_first_harmonic_um",
))))
"""Figure -> column with its largest value within the tolerances."""


def design_lines(folder: Path) -> Iterator[str]:
    """The best variant: its modifications, and under each torque its figures beside those of the scene as it stands and
    of the resolved contact."""
    variants, rows = DESIGN.read(folder), BEST.read(folder)
    counts = [sum(row.status in each for row in variants) for each in ((ALLOWED, FRONT), (EDGES,))]
    yield f"{len(variants)} variants with the scene: {counts[0]} allowed, {counts[1]} whose edges of tips bear"
    best = [row for row in rows if row.rank == 1]
    if best:
        yield f"best: variant {best[0].variant}, {modifications(variants[best[0].variant], variants)}"
    section = SECTION.read(folder)
    yield from _most_robust(rows, section["targets"][0])
    has_harmonic = HARMONIC in (*section["targets"], *dict(section["limits"]))
    for row in best:
        before = next(each for each in rows if each.variant == 0 and each.torque_Nm == row.torque_Nm)
        figures = "; ".join(_figures(row, before, has_harmonic))
        yield f"{row.case}, {row.torque_Nm:.4g} N·m: transmission error {figures}"


def _most_robust(rows: Sequence[BestRow], target: Figure) -> Iterator[str]:
    """A sentence on another of the best variants whose first target is smaller within the tolerances."""
    ranks = sorted({row.rank for row in rows if row.rank})
    groups = {rank: [row for row in rows if row.rank == rank] for rank in ranks}
    worst = {rank: _largest_within(group, BAND_ENDS[target]) for rank, group in groups.items()}
    least = min(worst, key=lambda rank: worst[rank], default=1)
    if least == 1 or math.isinf(worst[least]) or worst[least] > (1.0 - SAME) * worst[1]:
        return
    first = f"up to {worst[1]:.4g}" if math.isfinite(worst[1]) else "not known, as edges of tips bear"
    yield (
        f"within tolerances variant {groups[least][0].variant}, of rank {least}, is better: {label(target)} up to "
        f"{worst[least]:.4g}, of the best one {first}"
    )


def _largest_within(rows: Sequence[BestRow], column: str) -> float:
    """Largest value of a figure within the tolerances of a variant under all torques; ∞ where it is not known of one of
    the variants."""
    values = [getattr(row, column) for row in rows]
    known = np.isfinite(values).all() and not any(row.band_left_out for row in rows)
    return float(max(values)) if known else math.inf


def modifications(row: VariantRow, variants: Sequence[VariantRow]) -> str:
    """Modifications of a variant in words: those that vary."""
    varying = [name for name in row.values if len({each.values[name] for each in variants[1:]}) > 1]
    return ", ".join(f"{name} = {row.values[name]:.6g}" for name in varying or row.values)


def _figures(row: BestRow, before: BestRow, has_harmonic: bool) -> Iterator[str]:
    """Figures of a variant under a torque. before: those of the scene as it stands. has_harmonic: whether the first
    harmonic is asked for."""
    line = plus_minus(row.transmission_error_peak_to_peak_um, row.transmission_error_peak_to_peak_um_error, 2)
    resolved = plus_minus(row.resolved_peak_to_peak_um, row.resolved_peak_to_peak_um_error, 2)
    if math.isnan(row.transmission_error_peak_to_peak_um):
        yield f"{resolved} µm peak to peak with the contact resolved, as edges of tips bear"
    else:
        yield f"{line} µm peak to peak"
        if not math.isnan(row.resolved_peak_to_peak_um):
            yield f"resolved {resolved} µm"
    if before.variant != row.variant:
        yield _before(before)
    if has_harmonic:
        yield from _harmonic(row)
    if not math.isnan(row.face_load_factor):
        yield f"K_Hβ {plus_minus(row.face_load_factor, row.face_load_factor_error, 2)}"
    if not math.isnan(row.largest_pressure_MPa):
        yield f"p_0 {plus_minus(row.largest_pressure_MPa, row.largest_pressure_MPa_error, 0)} MPa"
    yield from _loss(row)
    yield from _band(row)


def _harmonic(row: BestRow) -> Iterator[str]:
    """Amplitude of the first mesh harmonic, where it is known."""
    own = row.transmission_error_first_harmonic_um, row.transmission_error_first_harmonic_um_error
    resolved = row.resolved_first_harmonic_um, row.resolved_first_harmonic_um_error
    for words, pair in (("first harmonic", own), ("first harmonic resolved", resolved)):
        if not math.isnan(pair[0]):
            yield f"{words} {plus_minus(*pair, 3)} µm"


def _loss(row: BestRow) -> Iterator[str]:
    """Friction loss, where it was asked for."""
    if not math.isnan(row.loss_percent):
        yield f"loss {plus_minus(row.loss_percent, row.loss_percent_error, 3)} %"
    if not math.isnan(row.resolved_loss_percent):
        yield f"loss resolved {plus_minus(row.resolved_loss_percent, row.resolved_loss_percent_error, 3)} %"


def _before(before: BestRow) -> str:
    """Transmission error of the scene as it stands."""
    was = before.transmission_error_peak_to_peak_um
    known = was if math.isfinite(was) else before.resolved_peak_to_peak_um
    return f"as it stands {known:.2f} µm" if math.isfinite(known) else "as it stands edges of tips bear"


def _band(row: BestRow) -> Iterator[str]:
    """Figures within the tolerances."""
    if math.isnan(row.band_lowest_peak_to_peak_um):
        return
    yield f"within tolerances {row.band_lowest_peak_to_peak_um:.2f} to {row.band_highest_peak_to_peak_um:.2f} µm"
    if not math.isnan(row.band_lowest_face_load_factor):
        yield f"K_Hβ {row.band_lowest_face_load_factor:.2f} to {row.band_highest_face_load_factor:.2f}"
    yield f"p_0 {row.band_lowest_pressure_MPa:.0f} to {row.band_highest_pressure_MPa:.0f} MPa"
    if not math.isnan(row.band_lowest_loss_percent):
        yield f"loss {row.band_lowest_loss_percent:.3f} to {row.band_highest_loss_percent:.3f} %"


def design_warnings(
    space: DesignSpace, variants: Variants, checked: Sequence[Checked], best: Checked | None, is_resolved: bool
) -> Iterator[str]:
    """Sentences on variants without figures, on the best one and its neighbours, on its tolerances, and on solutions
    of the best ones. is_resolved: as of `Ranking`."""
    ranking, count = Ranking(space.section, variants.figures, is_resolved), len(variants.values)
    if failed := [reason for reason in variants.reasons if reason]:
        yield f"{len(failed)} of {count} variants cannot be computed. The first one: {failed[0]}"
    if best is None:
        yield from _none_allowed(ranking)
    else:
        yield from _at_ends(space, variants.values[best.variant])
        yield from _about_best(ranking, best)
        yield from _within_tolerances(space, best)
    for each in checked:
        for name, solved in (("line contact", each.line), ("resolved contact", each.resolved)):
            for sentence in (*solved.reasons, *solved.warnings):
                yield f"variant {each.variant}, {name}: {sentence}"


def _none_allowed(ranking: Ranking) -> Iterator[str]:
    """Why no variant is allowed."""
    excess = ranking.excess[~ranking.bears_on_edges]
    nearest = float(np.min(excess, initial=math.inf))
    edges = int(ranking.bears_on_edges.sum())
    words = [f"of {edges} edges of tips bear"] if edges else []
    words += [f"the nearest one exceeds a limit by {100.0 * nearest:.2g} %"] if 0.0 < nearest < math.inf else []
    yield f"No variant is allowed ({'; '.join(words)}): widen design.vary, or raise design.limits."


def _about_best(ranking: Ranking, best: Checked) -> Iterator[str]:
    """Sentences on variants that cannot be told from the best one, and on those that were not looked at."""
    count = ranking.figures.shape[1]
    (_, error), (value, _) = (best.figure(name, count) for name in (ranking.section.targets[0], FIGURES[0]))
    if others := len(ranking.like(best.variant, error)):
        yield f"{others} other variants lie within the error bar of the best one: choose among them by design.csv."
    if FIGURES[0] in ranking.section.targets and (left := len(ranking.left_out(value))):
        yield (
            f"Edges of tips bear of {left} variants for which line contact estimates a smaller transmission error than "
            "the best one's, too much for it to be known: resolve their contact by `evolvent excitation`."
        )


def _within_tolerances(space: DesignSpace, best: Checked) -> Iterator[str]:
    """Sentences on limits that do not hold within the tolerances, and on variants that the band leaves out."""
    if best.band is None:
        return
    band = Ranking(space.section, best.band.figures)
    left = int((~(band.on_edges <= band.most_on_edges)).sum())
    if left:
        count = len(best.band.values)
        yield f"Within the tolerances {left} of {count} variants have no figures, as edges of tips bear."
    for limit in space.section.limits:
        most = float(np.nanmax(band.largest(limit.figure)[band.on_edges <= band.most_on_edges], initial=-math.inf))
        if most > limit.most:
            yield f"Within the tolerances {limit.figure} is up to {most:.4g}, above its limit of {limit.most:.4g}."


def _at_ends(space: DesignSpace, variant: Floats) -> Iterator[str]:
    """A sentence on each key whose best value is an end of its range, but for none at all."""
    for row in space.section.vary:
        value = float(variant[space.keys.index(keys_of_both(row.key)[0])])
        if value == row.lowest != 0.0 or value >= row.highest:
            yield f"{row.key}: the best value, {value:.6g}, ends its range; beyond it there may be better ones."
