"""Pressure on the unrolled flank, along contact lines, and at the paper's points A to D (Yang et al. 2022, Figs 11 to
13, Table 5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from meshes.data import Floats
from meshes.flank import contact_lines
from solver.engagement import largest_peak
from solver.flank_field import flank_field, flank_patch
from solver.gear_results import Slices
from solver.plain_text import signed
from solver.plots_style import FAINT, INK, PRESSURE_MAP, friction_colours, note, sheet
from solver.run_data import RunData, SolvedPosition

FACE = "face width z [mm]"
ROLL = "roll distance ξ from the pitch point [mm]"


@dataclass(frozen=True)
class Point:
    """A point of the paper's Fig. 11: on the contact line of tooth pair `tooth` at height z, roll distance ξ [mm]."""

    name: str
    tooth: int
    z: float
    ξ: float


def pressure_map(run: RunData, index: int = 0) -> Figure:
    """The envelope of the pressure over the engagement, and single positions with the nominal contact lines."""
    steps = [round(k * len(run.positions) / 3) for k in range(3)]
    top = pressure_top(run, index)
    see = _see_map(run, index)
    figure = sheet(f"Pressure on the unrolled pinion flank, μ = {run.frictions[index]:g}", see, (12.0, 6.2))
    axes = figure.subplots(1, 4, sharey=True, width_ratios=(1.5, 1, 1, 1))
    shown = _envelope_map(axes[0], run, index, top)
    axes[0].set_title("envelope over the engagement", fontsize=10)
    for ax, k in zip(axes[1:], steps):
        _position_map(ax, run, run.positions[k][index], top)
        ax.set_title(f"at φ = {np.degrees(run.angles[k]):.2f}°, all teeth", fontsize=10)
    axes[0].set_ylabel(ROLL)
    for ax in axes:
        _flank_axes(ax, run)
    _diameters(axes[-1], run)
    bar = figure.colorbar(shown, ax=list(axes), location="bottom", shrink=0.5, aspect=45, pad=0.02)
    bar.set_label("pressure [MPa]")
    return figure


def pressure_top(run: RunData, index: int) -> float:
    """Upper end of the colours [MPa]: the largest fitted peak, rounded up."""
    peaks = np.concatenate([each[index].cut.peak for each in run.positions])
    return float(100.0 * np.ceil(np.nanmax(peaks) / 100.0))


def envelope(run: RunData, index: int, ξ: Floats) -> tuple[Floats, Floats]:
    """(heights (h,), fitted peak pressure (len(ξ), h) [MPa]) that a line at ξ leaves at each height; NaN where
    no position came near, or only with a tip edge.

    The contact line passes every height once in an engagement, so the peaks of all positions of the pitch are one
    curve over ξ there.
    """
    cuts = [each[index].cut for each in run.positions]
    z, line, peak = (np.concatenate([getattr(cut, name) for cut in cuts]) for name in ("z", "ξ", "peak"))
    reach = 0.75 * run.pair.pinion.base_radius * run.pitch / len(run.positions)
    heights, known = np.unique(z), np.isfinite(peak)
    columns = []
    for height in heights:
        here = np.flatnonzero((z == height) & known)
        order = here[np.argsort(line[here])]
        column = np.interp(ξ, line[order], peak[order]) if len(order) else np.full(len(ξ), np.nan)
        gap = np.abs(ξ[:, None] - line[order]).min(axis=1, initial=np.inf)
        columns.append(np.where(gap <= reach, column, np.nan))
    return heights, np.column_stack(columns)


def _envelope_map(axes: Axes, run: RunData, index: int, top: float):  # type: ignore[no-untyped-def]
    ξ = np.linspace(*run.pair.path_of_contact, 240)
    heights, peak = envelope(run, index, ξ)
    shown = axes.pcolormesh(heights, ξ, peak, cmap=PRESSURE_MAP, vmin=0.0, vmax=top, shading="gouraud", rasterized=True)
    levels = MaxNLocator(8).tick_values(np.nanmin(peak), np.nanmax(peak))
    lines = axes.contour(heights, ξ, peak, levels=levels, colors="white", linewidths=0.7)
    axes.clabel(lines, fmt="%.0f", fontsize=8)
    angle = run.angles[0]
    for tooth in range(-3, 4):
        _nominal_lines(axes, run, angle + tooth * run.pitch / 3.0, only=0)
    return shown


def _position_map(axes: Axes, run: RunData, solved: SolvedPosition, top: float) -> None:
    """The pressures of all teeth at a position on one flank."""
    result, patch = solved.result, flank_patch(run, 0)
    fields = [flank_field(run, result, int(tooth)) for tooth in np.unique(result.tooth)]
    teeth = [patch.values(run, result, int(tooth), field) for tooth, field in zip(np.unique(result.tooth), fields)]
    ξ = patch.roll_length - run.pair.pitch_point_roll_lengths[0]
    axes.pcolormesh(
        patch.z, ξ, np.max(teeth, axis=0), cmap=PRESSURE_MAP, vmin=0.0, vmax=top, shading="gouraud", rasterized=True
    )
    _nominal_lines(axes, run, solved.result.stand.angle)


def _nominal_lines(axes: Axes, run: RunData, angle: float, only: int | None = None) -> None:
    """The contact lines of rigid flanks."""
    for line in contact_lines(run.pair, angle):
        if only is None or line.tooth == only:
            axes.plot(line.z, line.roll_distance, color=INK, linewidth=0.8, linestyle=(0, (4, 3)))


def _flank_axes(axes: Axes, run: RunData) -> None:
    half, (start, end) = 0.5 * run.pair.face_width, run.pair.path_of_contact
    axes.axhline(0.0, color="#2e7d6b", linewidth=1.0)
    for limit in run.inner_path:
        axes.axhline(limit, color=INK, linewidth=0.9, linestyle=":")
    axes.set(xlabel=FACE, xlim=(-half, half), ylim=(start - 0.35, end + 0.15))
    axes.grid(False)


def _diameters(axes: Axes, run: RunData) -> None:
    """A second scale: the pinion's diameter."""
    base, pitch = run.pair.pinion.base_radius, run.pair.pitch_point_roll_lengths[0]

    def to_diameter(ξ: Floats) -> Floats:
        return 2.0 * np.sqrt(base**2 + np.maximum(pitch + ξ, 0.0) ** 2)

    def to_roll(d: Floats) -> Floats:
        return np.sqrt(np.maximum((0.5 * d) ** 2 - base**2, 0.0)) - pitch

    axes.secondary_yaxis("right", functions=(to_diameter, to_roll)).set_ylabel("pinion diameter [mm]")


def _see_map(run: RunData, index: int) -> str:
    top = largest_peak(run, index)
    side = "below the pitch line, towards the root" if top.ξ < 0 else "above the pitch line, towards the tip"
    where = f"at ξ = {signed(top.ξ, 2)} mm, {side}" if np.isfinite(top.ξ) else "nowhere"
    see = f"Between the tip-edge zones (dotted) the largest pressure, {top.pressure:.0f} MPa, comes {where}"
    return see + "; dashed: contact lines of rigid flanks."


def line_pressure_over_z(run: RunData) -> Figure:
    """Fitted peak pressure over z along the lines of teeth 2 and 3 at the paper's moment, for every μ (Fig. 12)."""
    k = paper_position(run)
    figure = sheet(
        f"Pressure along the contact lines at φ = {np.degrees(run.angles[k]):.2f}°", _see_line(run, k), (11.0, 5.2)
    )
    axes = figure.subplots(1, 2, sharey=True)
    for ax, tooth in zip(axes, (0, -1)):
        for solved, colour in zip(run.positions[k], friction_colours(run.frictions)):
            z, _, peak = line_of(solved.cut, tooth)
            ax.plot(z, peak, color=colour, label=f"μ = {solved.result.friction:g}")
        for point in paper_points(run, k):
            if point.tooth == tooth:
                ax.axvline(point.z, color=FAINT, linestyle=":", linewidth=1.0)
                ax.text(point.z, 0.97, point.name, transform=ax.get_xaxis_transform(), ha="center", fontweight="bold")
        where = "through the pitch line" if tooth == 0 else "near the root"
        ax.set_title(f"tooth {2 - tooth}: {where}", fontsize=10)
        ax.set(xlabel=FACE, xlim=(-0.5 * run.pair.face_width, 0.5 * run.pair.face_width))
    axes[0].set_ylabel("peak pressure across the line [MPa]")
    axes[0].set_ylim(bottom=0.0)
    axes[1].legend(title="friction coefficient", loc="center left")
    note(axes[1], "where the line bears on a tip edge\nnothing is drawn", 0.02, 0.98)
    return figure


def points_over_friction(run: RunData) -> Figure:
    """Pressure at the points A to D over μ, with the table of their changes (Fig. 13, Table 5)."""
    k = paper_position(run)
    points = paper_points(run, k)
    order = np.argsort(run.frictions)
    μ = np.array(run.frictions)[order]
    values = {p.name: np.array([at_point(run.positions[k][i].cut, p) for i in order]) for p in points}
    spread = {name: v.max() - v.min() for name, v in values.items()}
    part = {name: 100.0 * spread[name] / v.min() for name, v in values.items()}
    ranked = sorted(spread, key=lambda name: -spread[name])
    see = "Largest change with friction: " + ", ".join(f"{n} {spread[n]:.0f} MPa" for n in ranked) + "."
    figure = sheet(
        f"Pressure at the points A to D over the friction coefficient, φ = {np.degrees(run.angles[k]):.2f}°",
        see,
        (10.6, 6.0),
    )
    grid = figure.add_gridspec(2, 2, width_ratios=(1.35, 1.0))
    above, below, side = (figure.add_subplot(grid[place]) for place in ((0, 0), (1, 0), (slice(None), 1)))
    for point, colour, marker in zip(points, ("#3b7a57", "#2d6fb0", "#8a5a9e", "#c98a1b"), "osD^"):
        own = values[point.name]
        above.plot(μ, own, color=colour, marker=marker, label=point.name)
        below.plot(μ, 100.0 * (own / own[0] - 1.0), color=colour, marker=marker)
    above.set_ylabel("pressure [MPa]")
    above.set_ylim(0.0, 1.4 * max(v.max() for v in values.values()))
    above.legend(ncols=4, loc="upper right")
    below.axhline(0.0, color=FAINT, linewidth=1.0)
    below.set(xlabel="friction coefficient μ", ylabel=f"change against μ = {μ[0]:g} [%]")
    side.axis("off")
    rows = [
        [p.name, f"{2 - p.tooth}", signed(p.z, 2), signed(p.ξ, 2), f"{spread[p.name]:.1f}", f"{part[p.name]:.1f} %"]
        for p in points
    ]  # fmt: skip
    heads = ["point", "tooth", "z\n[mm]", "ξ\n[mm]", "max − min\n[MPa]", "of min"]
    table = side.table(rows, colLabels=heads, loc="center", cellLoc="center", edges="horizontal")
    table.auto_set_font_size(False)
    table.set_fontsize(9)
    table.scale(1.0, 1.9)
    return figure


def paper_position(run: RunData) -> int:
    """The position nearest to the paper's moment, 5.25e-5 s at 1500 r/min or 0.47° after the start of its pitch."""
    return int(np.argmin(np.abs(np.degrees(run.angles) - 0.4725)))


def has_two_lines(run: RunData) -> bool:
    """True if teeth 2 and 3 both have a contact line at the paper's moment, tooth 2's across the pitch line."""
    lines = {line.tooth: line for line in contact_lines(run.pair, float(run.angles[paper_position(run)]))}
    return -1 in lines and 0 in lines and min(lines[0].roll_distance) < 0.0 < max(lines[0].roll_distance)


def paper_points(run: RunData, k: int) -> list[Point]:
    """A, B, C on tooth 2's contact line: halfway from its root end to the pitch line, at the pitch line, halfway to its
    tip end; D in the middle of tooth 3's line, near the root. The paper gives no coordinates, only these words."""
    lines = {line.tooth: line for line in contact_lines(run.pair, float(run.angles[k]))}
    second, third = lines[0], lines[-1]
    root, tip = sorted(second.roll_distance)
    wanted = [
        ("A", second, 0.5 * root),
        ("B", second, 0.0),
        ("C", second, 0.5 * tip),
        ("D", third, float(np.mean(third.roll_distance))),
    ]
    points = []
    for name, line, ξ in wanted:
        (ξ0, ξ1), (z0, z1) = line.roll_distance, line.z
        z = z0 + (z1 - z0) * (ξ - ξ0) / (ξ1 - ξ0)
        points.append(Point(name, line.tooth, z, ξ))
    return points


def line_of(cut: Slices, tooth: int) -> tuple[Floats, Floats, Floats]:
    """(z, ξ, fitted peak) of a tooth's slices, z ascending; tip edges left out."""
    here = np.flatnonzero((cut.tooth == tooth) & np.isfinite(cut.peak))
    here = here[np.argsort(cut.z[here])]
    return cut.z[here], cut.ξ[here], cut.peak[here]


def at_point(cut: Slices, point: Point) -> float:
    """Fitted peak pressure at a point of the contact line [MPa], linear between slices; NaN off the line."""
    z, _, peak = line_of(cut, point.tooth)
    return float(np.interp(point.z, z, peak, left=np.nan, right=np.nan)) if len(z) else float("nan")


def _see_line(run: RunData, k: int) -> str:
    lowest, highest = int(np.argmin(run.frictions)), int(np.argmax(run.frictions))
    texts = []
    for tooth in (0, -1):
        _, _, peak = line_of(run.positions[k][lowest].cut, tooth)
        _, _, other = line_of(run.positions[k][highest].cut, tooth)
        change = f", {signed(100 * (other.mean() / peak.mean() - 1))} % on average" if highest != lowest else ""
        texts.append(f"tooth {2 - tooth} {peak.min():.0f} to {peak.max():.0f} MPa{change}")
    ends = f"μ = {run.frictions[lowest]:g}" + (f", and to {run.frictions[highest]:g}" if highest != lowest else "")
    return f"At {ends}: " + "; ".join(texts) + "."
