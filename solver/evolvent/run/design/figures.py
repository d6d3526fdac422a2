"""Picture of a design: before and after over the torque, and the target over what varies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from evolvent.results.drawing.labels import UNITS, ending, label
from evolvent.results.drawing.style import FAINT, HOLLOW, INK, PINION, PRESSURE_MAP, WHEEL, foot, sheet
from evolvent.run.design.checked import BestRow
from evolvent.run.design.tables import ALLOWED, EDGES, FRONT, VariantRow
from evolvent_meshes.arrays import Floats

BEFORE, AFTER = WHEEL, PINION
TARGET = "transmission_error_peak_to_peak_um"
WORDS, WORST = "transmission error, peak to peak [µm]", "largest peak-to-peak transmission error [µm]"


def design_figure(title: str, variants: Sequence[VariantRow], best: Sequence[BestRow]) -> Figure:
    """Peak-to-peak transmission error over the torque before and after, beside that of all variants."""
    first = [row for row in best if row.rank == 1]
    before = [row for row in best if row.variant == 0]
    names = varying(variants)
    said = f"{title}. {_said(variants, first)}"
    figure = sheet("Flank modifications", said, (12.6, 5.6))
    left, right = figure.subplots(1, 2)
    _over_torque(left, before, first)
    if len(names) == 1:
        _curve(right, variants, names[0], best)
    elif len(names) == 2 and (grid := lattice(variants, names)) is not None:
        _map(figure, right, variants, names, grid, first)
    else:
        _scatter(right, variants, first)
    foot(figure, "Line contact without friction; bars: estimated error.", *_left_out(variants))
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
    said = f"{count} of {len(variants)} variants are left out or grey: edges of tips bear, or they exceed a limit."
    return [said] * bool(count)


def _over_torque(axes: Axes, before: Sequence[BestRow], after: Sequence[BestRow]) -> None:
    """Peak-to-peak transmission error over the torque."""
    if after and np.isfinite([row.band_highest_peak_to_peak_um for row in after]).any():
        low, high = ([getattr(row, f"band_{end}_peak_to_peak_um") for row in after] for end in ("lowest", "highest"))
        if not np.allclose(low, high, equal_nan=True):
            axes.fill_between([row.torque_Nm for row in after], low, high, color=AFTER, alpha=0.18, lw=0.0,
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
            axes.errorbar(torques, values, bars, color=colour, marker=marker, linestyle=style, capsize=3.0,
                          label=f"{name}{words}", **face)
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("torque [N·m]")
    axes.set_ylabel(WORDS)
    axes.legend(loc="best")


def _values(variants: Sequence[VariantRow], name: str) -> Floats:
    return np.array([row.values[name] for row in variants])


def _target(variants: Sequence[VariantRow]) -> tuple[Floats, Floats]:
    """Largest peak-to-peak transmission error of allowed variants, and of those beyond limits; NaN of others."""
    values = np.array([row.transmission_error_peak_to_peak_um for row in variants])
    allowed = np.array([row.status in (ALLOWED, FRONT) for row in variants])
    return np.where(allowed, values, np.nan), np.where(allowed, np.nan, values)


def _curve(axes: Axes, variants: Sequence[VariantRow], name: str, best: Sequence[BestRow]) -> None:
    """Target over the only key that varies."""
    own = variants[1:]
    order = np.argsort(_values(own, name))
    allowed, beyond = _target(own)
    axes.plot(_values(own, name)[order], allowed[order], color=INK, marker=".", lw=1.4, label="line contact")
    axes.plot(_values(own, name)[order], beyond[order], color=FAINT, marker=".", lw=0.0)
    bears = [row.values[name] for row in own if row.status == EDGES]
    axes.plot(bears, np.zeros(len(bears)), color=FAINT, marker="|", lw=0.0, clip_on=False, label="edges of tips bear")
    groups = [[row for row in best if row.rank == rank] for rank in range(1, 1 + max(row.rank for row in best))]
    found = [(variants[rows[0].variant].values[name], _largest(rows, "resolved")) for rows in groups]
    if np.isfinite(found).any():
        axes.plot(*np.transpose(found), label="contact resolved", **{**HOLLOW, "marker": "s"}, color=AFTER)
    _mark(axes, [(variants[rows[0].variant].values[name], _largest(rows)) for rows in groups[:1]])
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="best")
    axes.set_xlabel(_axis_label(variants, name))
    axes.set_ylabel(WORST)


def lattice(variants: Sequence[VariantRow], names: Sequence[str]) -> Floats | None:
    """(q, p) target over the different values of two keys; None where less than half of the combinations are known."""
    first, second = (np.unique(_values(variants[1:], name)) for name in names)
    if 2 * len(variants) < len(first) * len(second):
        return None
    grid = np.full((len(second), len(first)), np.nan)
    allowed, _ = _target(variants[1:])
    columns, rows = (np.searchsorted(axis, _values(variants[1:], name)) for axis, name in zip((first, second), names))
    grid[rows, columns] = allowed
    return grid


def _map(
    figure: Figure, axes: Axes, variants: Sequence[VariantRow], names: Sequence[str], grid: Floats,
    best: Sequence[BestRow],
) -> None:
    """Target over two keys; variants that are not allowed are hatched."""
    first, second = (np.unique(_values(variants[1:], name)) for name in names)
    axes.grid(visible=False)
    axes.patch.set(facecolor="#f4f4f4", hatch="////", edgecolor=FAINT)
    if np.isfinite(grid).any():
        norm = Normalize(float(np.nanmin(grid)), float(np.nanmax(grid)))
        drawn = axes.pcolormesh(first, second, np.ma.masked_invalid(grid), cmap=PRESSURE_MAP, norm=norm,
                                shading="nearest")
        figure.colorbar(drawn, ax=axes, pad=0.015, label=WORST)
    _mark(axes, [tuple(variants[row.variant].values[name] for name in names) for row in best[:1]])
    axes.set_xlabel(_axis_label(variants, names[0]))
    axes.set_ylabel(_axis_label(variants, names[1]))


def _scatter(axes: Axes, variants: Sequence[VariantRow], best: Sequence[BestRow]) -> None:
    """Largest pressure over the target: what is gained in one costs the other."""
    allowed, beyond = _target(variants)
    pressure = np.array([row.largest_pressure_MPa for row in variants])
    axes.scatter(beyond, pressure, s=12.0, color=FAINT, alpha=0.6)
    axes.scatter(allowed, pressure, s=16.0, color=INK, alpha=0.7, lw=0.0)
    front = [number for number, row in enumerate(variants) if row.status == FRONT]
    axes.scatter(allowed[front], pressure[front], s=34.0, color=AFTER, label="front", lw=0.0)
    _mark(axes, [(_largest(best), pressure[row.variant]) for row in best[:1]])
    if front:
        axes.legend(loc="best")
    axes.set_xlabel(WORST)
    axes.set_ylabel("largest p_0 [MPa]")


def _largest(rows: Sequence[BestRow], kind: str = "transmission_error") -> float:
    """Largest peak-to-peak transmission error of a variant under all torques; of the resolved contact where edges bear,
    and by kind = "resolved"."""
    values = [getattr(row, f"{kind}_peak_to_peak_um") for row in rows]
    return float(max(values if np.isfinite(values).all() else [row.resolved_peak_to_peak_um for row in rows]))


def _mark(axes: Axes, places: Sequence[tuple[float, ...]]) -> None:
    """Marks the best variant."""
    for x, y in places:
        axes.plot(x, y, marker="*", markersize=15.0, color=AFTER, markeredgecolor="white", zorder=5.0)
