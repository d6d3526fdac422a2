"""Picture of a design: before and after over the torque, and the target over what varies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from evolvent.results.drawing.labels import UNITS, ending, label
from evolvent.results.drawing.style import FAINT, HOLLOW, INK, PINION, PRESSURE_MAP, WHEEL, foot, sheet
from evolvent.run.design.checked import BestRow
from evolvent.run.design.tables import ALLOWED, BEYOND, EDGES, FRONT, VariantRow
from evolvent.scene.schema.design import FIGURES, HARMONIC, LOSS
from evolvent_meshes.arrays import Floats

BEFORE, AFTER = WHEEL, PINION
ASIDE = 0.008
"""Distance of points of line and resolved contact from their torque, over the largest one: bars lie side by side."""
LEAST_HEIGHT = 0.5
"""Ratio of the smallest and the largest value from which on an axis does not begin at zero."""
TARGET = FIGURES[0]
RESOLVED: Mapping[str, str] = MappingProxyType({
    TARGET: "resolved_peak_to_peak_um", LOSS: "resolved_loss_percent", HARMONIC: "resolved_first_harmonic_um",
})
"""Figure -> column of the resolved contact, of those that have one."""
WORDS = "transmission error, peak to peak [µm]"


def design_figure(
    title: str, section: Mapping[str, Any], variants: Sequence[VariantRow], best: Sequence[BestRow]
) -> Figure:
    """Peak-to-peak transmission error over the torque before and after, beside the first target of all variants.
    section: [design] as scene.toml has it."""
    first = [row for row in best if row.rank == 1]
    before = [row for row in best if row.variant == 0]
    names = varying(variants)
    said = f"{title}. {_said(variants, first)}"
    figure = sheet("Flank modifications", said, (12.6, 5.6))
    left, right = figure.subplots(1, 2)
    _over_torque(left, before, first)
    target = (section.get("targets") or [TARGET])[0]
    if len(names) == 1:
        _curve(right, variants, names[0], best, target)
    elif len(names) == 2 and (grid := lattice(variants, names, target)) is not None:
        _map(figure, right, variants, names, grid, first, target)
    else:
        _scatter(right, section, variants, first)
    has_loss = bool(np.isfinite([row.loss_percent for row in variants]).any())
    without = f"Line contact without friction{', but for the loss' if has_loss else ''}; bars: estimated error."
    foot(figure, without, *_left_out(variants))
    return figure


def varying(variants: Sequence[VariantRow]) -> list[str]:
    """Names of the keys of which variants have different values; keys that are alike in all of them count once."""
    columns = {name: tuple(row.values[name] for row in variants[1:]) for name in variants[0].values}
    different = {values: name for name, values in reversed(columns.items()) if len(set(values)) > 1}
    return sorted(different.values(), key=list(columns).index)


def _said(variants: Sequence[VariantRow], best: Sequence[BestRow]) -> str:
    if not best:
        return "No variant is allowed."
    values = variants[best[0].variant].values
    chosen = ", ".join(
        f"{names_in_words(variants, name)} {values[name]:.4g} {UNITS[ending(name)]}" for name in varying(variants)
    )
    return f"Best of {len(variants)}: {chosen}."


def names_in_words(variants: Sequence[VariantRow], name: str) -> str:
    """A key in words, without its unit; without the gear where the other one's has the same values throughout."""
    section, _, last = name.partition(".")
    other = f"{'wheel' if section == 'pinion' else 'pinion'}.{last}"
    alike = all(row.values.get(other) == row.values[name] for row in variants[1:])
    return f"{label(last, unit=False)} of both gears" if alike else label(name, unit=False)


def _axis_label(variants: Sequence[VariantRow], name: str) -> str:
    return f"{names_in_words(variants, name)} [{UNITS[ending(name)]}]"


def _left_out(variants: Sequence[VariantRow]) -> list[str]:
    count = sum(row.status not in (ALLOWED, FRONT) for row in variants)
    said = f"{count} of {len(variants)} variants are not allowed: edges of tips bear, or a limit is exceeded."
    return [said] * bool(count)


def _over_torque(axes: Axes, before: Sequence[BestRow], after: Sequence[BestRow]) -> None:
    """Peak-to-peak transmission error over the torque."""
    within = [row for row in after if row.band_highest_peak_to_peak_um > row.band_lowest_peak_to_peak_um]
    if within:
        low, high = (
            np.array([getattr(row, f"band_{end}_peak_to_peak_um") for row in within]) for end in ("lowest", "highest")
        )
        axes.vlines([row.torque_Nm for row in within], low, high, color=AFTER, alpha=0.22, lw=11.0,
                    label="within the tolerances")
    for rows, colour, name in ((before, BEFORE, "as it stands"), (after, AFTER, "best variant")):
        if rows is after and after and after[0].variant == 0:
            continue
        torques = [row.torque_Nm for row in rows]
        for part, marker, style, words in (
            ("transmission_error", "o", "-", ""), ("resolved", "s", ":", ", contact resolved"),
        ):
            values = np.array([getattr(row, f"{part}_peak_to_peak_um") for row in rows])
            if not np.isfinite(values).any():
                continue
            bars = np.nan_to_num([getattr(row, f"{part}_peak_to_peak_um_error") for row in rows])
            face = {"markerfacecolor": "white", "zorder": 4.0} if words else {}
            aside = ASIDE * max(torques) * (1 if words else -1)
            beside = [torque + aside for torque in torques]
            axes.errorbar(beside, values, bars, color=colour, marker=marker, linestyle=style, capsize=3.0,
                          label=f"{name}{words}", **face)
    axes.set_xlim(left=0.0)
    axes.set_ylim(0.0, 1.25 * axes.get_ylim()[1])  # room for the legend
    axes.set_xlabel("torque [N·m]")
    axes.set_ylabel(WORDS)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper left")


def _values(variants: Sequence[VariantRow], name: str) -> Floats:
    return np.array([row.values[name] for row in variants])


def _worst(name: str) -> str:
    """A figure's largest value under all torques, in words."""
    if name == TARGET:
        return "largest peak-to-peak transmission error [µm]"
    return f"largest {label(name).removeprefix('largest ')}"


def _target(variants: Sequence[VariantRow], target: str) -> tuple[Floats, Floats]:
    """A figure of allowed variants, and of those beyond limits; NaN of others."""
    values = np.array([getattr(row, target) for row in variants], dtype=float)
    allowed = np.array([row.status in (ALLOWED, FRONT) for row in variants])
    return np.where(allowed, values, np.nan), np.where(allowed, np.nan, values)


def _curve(
    axes: Axes, variants: Sequence[VariantRow], name: str, best: Sequence[BestRow], target: str
) -> None:
    """Target over the only key that varies, of the scene as it stands, too."""
    own = variants if variants[0].values[name] in {row.values[name] for row in variants[1:]} else variants[1:]
    own = sorted(own, key=lambda row: row.values[name])
    allowed, beyond = _target(own, target)
    x = _values(own, name)
    axes.plot(x, allowed, color=INK, marker=".", lw=1.4, label="line contact")
    if np.isfinite(beyond).any():
        axes.plot(x, beyond, color=FAINT, marker=".", lw=0.0, label="beyond a limit")
    groups = [[row for row in best if row.rank == rank] for rank in range(1, 1 + max(row.rank for row in best))]
    found = [(variants[rows[0].variant].values[name], _largest_resolved(rows, target)) for rows in groups]
    if np.isfinite([y for _, y in found]).any():
        axes.plot(*np.transpose(found), label="contact resolved", **{**HOLLOW, "marker": "s"}, color=AFTER)
    _mark(axes, [(variants[rows[0].variant].values[name], _largest(rows, target)) for rows in groups[:1]])
    known = [*allowed[np.isfinite(allowed)], *(y for _, y in found if np.isfinite(y))]
    low = min(known, default=0.0)
    axes.set_ylim(bottom=0.0 if not known or low < LEAST_HEIGHT * max(known) else 0.9 * low)
    bears = [row.values[name] for row in own if row.status == EDGES]
    if bears:
        axes.plot(bears, np.full(len(bears), axes.get_ylim()[0]), color=FAINT, marker="|", markersize=9.0, lw=0.0,
                  clip_on=False, label="edges of tips bear")
    axes.set_xlabel(_axis_label(variants, name))
    axes.set_ylabel(_worst(target))
    axes.legend(loc="best")


def lattice(variants: Sequence[VariantRow], names: Sequence[str], target: str) -> Floats | None:
    """(q, p) target over the different values of two keys; None where less than half of the combinations are known."""
    own = _on_lattice(variants, names)
    first, second = (np.unique(_values(own, name)) for name in names)
    if 2 * len(own) < len(first) * len(second):
        return None
    grid = np.full((len(second), len(first)), np.nan)
    columns, rows = (np.searchsorted(axis, _values(own, name)) for axis, name in zip((first, second), names))
    grid[rows, columns] = _target(own, target)[0]
    return grid


def _on_lattice(variants: Sequence[VariantRow], names: Sequence[str]) -> Sequence[VariantRow]:
    """All variants that vary, with the scene as it stands where its values are among theirs."""
    axes = [{row.values[name] for row in variants[1:]} for name in names]
    stands = all(variants[0].values[name] in axis for name, axis in zip(names, axes))
    return variants if stands else variants[1:]


def _map(
    figure: Figure, axes: Axes, variants: Sequence[VariantRow], names: Sequence[str], grid: Floats,
    best: Sequence[BestRow], target: str,
) -> None:
    """Target over two keys. Variants of which edges bear are hatched, those beyond a limit dotted."""
    own = _on_lattice(variants, names)
    first, second = (np.unique(_values(own, name)) for name in names)
    axes.grid(visible=False)
    for status, hatch, words in ((EDGES, "/", "edges of tips bear"), (BEYOND, ".", "beyond a limit")):
        places = [[row.values[name] for name in names] for row in own if row.status == status]
        if places:
            _hatched(axes, first, second, places, hatch)
            axes.scatter([], [], marker="s", s=90.0, facecolor="white", edgecolor=FAINT, hatch=4 * hatch, label=words)
    if np.isfinite(grid).any():
        low, high = float(np.nanmin(grid)), float(np.nanmax(grid))
        norm = Normalize(low - 0.3 * (high - low), high)  # the best value has a colour of its own, too
        drawn = axes.pcolormesh(first, second, np.ma.masked_invalid(grid), cmap=PRESSURE_MAP, norm=norm,
                                shading="nearest")
        figure.colorbar(drawn, ax=axes, pad=0.015, label=_worst(target))
    _mark(axes, [tuple(variants[row.variant].values[name] for name in names) for row in best[:1]])
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper right")
    axes.set_xlabel(_axis_label(variants, names[0]))
    axes.set_ylabel(_axis_label(variants, names[1]))


def _hatched(axes: Axes, first: Floats, second: Floats, places: Sequence[Sequence[float]], hatch: str) -> None:
    """Hatches the cells of some points of two axes."""
    width, height = (float(np.diff(axis).min()) if len(axis) > 1 else 1.0 for axis in (first, second))
    for x, y in places:
        axes.add_patch(Rectangle((x - 0.5 * width, y - 0.5 * height), width, height, facecolor="white", edgecolor=FAINT,
                                 hatch=4 * hatch, lw=0.0))


def _scatter(axes: Axes, section: Mapping[str, Any], variants: Sequence[VariantRow], best: Sequence[BestRow]) -> None:
    """Another figure over the transmission error: the second target, else one with a limit, else the pressure."""
    limits = dict(section.get("limits", ()))
    name = next(each for each in (*section.get("targets", ()), *limits, FIGURES[2]) if each != TARGET)
    allowed, beyond = _target(variants, TARGET)
    other = np.array([getattr(row, name) for row in variants], dtype=float)
    axes.scatter(beyond, other, s=14.0, color=FAINT, alpha=0.6, lw=0.0, label="beyond a limit")
    axes.scatter(allowed, other, s=16.0, color=INK, alpha=0.7, lw=0.0, label="allowed")
    front = [number for number, row in enumerate(variants) if row.status == FRONT]
    if front:
        axes.scatter(allowed[front], other[front], s=34.0, color=AFTER, label="front", lw=0.0)
    if np.isfinite(allowed[0]):
        axes.scatter(allowed[:1], other[:1], s=46.0, color=BEFORE, marker="s", label="as it stands")
    for key, draw in ((name, axes.axhline), (TARGET, axes.axvline)):
        if key in limits:
            draw(limits[key], color=FAINT, lw=1.2, ls="--", label="limit")
    _mark(axes, [(_largest(best, TARGET), other[row.variant]) for row in best[:1]])
    axes.legend(loc="best")
    axes.set_xlabel(_worst(TARGET))
    axes.set_ylabel(_worst(name))


def _largest(rows: Sequence[BestRow], target: str) -> float:
    """Largest value of a figure of a variant under all torques; of the resolved contact where edges bear."""
    values = [getattr(row, target) for row in rows]
    return float(max(values)) if np.isfinite(values).all() else _largest_resolved(rows, target)


def _largest_resolved(rows: Sequence[BestRow], target: str) -> float:
    """Largest value of a figure with the contact resolved, under all torques; NaN where there is none."""
    return float(max(getattr(row, RESOLVED[target]) for row in rows)) if target in RESOLVED else float("nan")


def _mark(axes: Axes, places: Sequence[tuple[float, ...]]) -> None:
    """Marks the best variant."""
    for x, y in places:
        axes.plot(x, y, marker="*", markersize=15.0, color=AFTER, markeredgecolor="white", zorder=5.0)
