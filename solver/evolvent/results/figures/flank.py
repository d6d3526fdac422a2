"""Maps of the pressure on the unrolled flank: envelope over the engagement, and single positions."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from evolvent.gears.pressure.contact_slices import Slices, on_tip_edge, over_kink
from evolvent.gears.pressure.line_peaks import pooled_peaks
from evolvent.gears.pressure.relief_starts import relief_starts
from evolvent.results.drawing.style import AT_ZONE_END, FAINT, INK, PRESSURE_MAP, foot, sheet
from evolvent.results.engagement import largest_peak
from evolvent.results.fields.flank_field import flank_field, flank_patch
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import few_positions
from evolvent.scene.plain_text import signed
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import contact_lines
from evolvent_meshes.gears.member import Member

FACE = "axial position z [mm]"
ROLL = "roll distance ξ from the pitch point [mm]"


def pressure_map(run: RunData, index: int = 0) -> Figure:
    """Figure of the pressure's envelope over the engagement, and of single positions with nominal contact lines."""
    steps = [round(k * len(run.positions) / 3) for k in range(3)]
    top = pressure_top(run, index)
    subtitle = _map_subtitle(run, index)
    figure = sheet(f"Pressure on the unrolled pinion flank, μ = {run.frictions[index]:g}", subtitle, (12.0, 6.2))
    axes = figure.subplots(1, 4, sharey=True, width_ratios=(1.5, 1, 1, 1))
    shown = _envelope_map(axes[0], run, index, top)
    axes[0].set_title("envelope between the tip-edge zones", fontsize=10)
    for ax, k in zip(axes[1:], steps):
        _position_map(ax, run, run.positions[k][index], top)
        ax.set_title(f"at φ = {np.degrees(run.angles[k]):.2f}°, all teeth", fontsize=10)
    axes[0].set_ylabel(ROLL)
    for ax in axes:
        _flank_axes(ax, run)
    _diameters(axes[-1], run)
    bar = figure.colorbar(shown, ax=list(axes), location="bottom", shrink=0.5, aspect=45, pad=0.02, extend="max")
    bar.set_label("pressure [MPa]   (blue: above the scale, where a linear relief begins; grey: a tip edge bears)")
    if few := few_positions(friction_rows(run)[index]):
        foot(figure, few)
    return figure


def pressure_top(run: RunData, index: int) -> float:
    """Upper end of the colour scale [MPa]: the largest of the reported pressure, the envelope, and nodal pressures
    between the tip-edge zones, rounded up. Layers that bear on a tip edge are left out, since their pressure is
    singular beside the edge too, and layers whose contact covers the start of a linear relief."""
    (low, high), z = run.inner_path, run.flank.z
    headline = largest_peak(run, index).pressure
    largest = [headline if np.isfinite(headline) else 0.0]
    _, over_face = envelope(run, index, _path(run))
    largest.append(float(over_face[np.isfinite(over_face)].max(initial=0.0)))
    for cut, result in ((each[index].cut, each[index].result) for each in run.positions):
        ξ = run.flank.roll_length[result.node] - run.pair.pitch_point_roll_lengths[0]
        for tooth in np.unique(result.tooth):
            away = (result.tooth == tooth) & (low <= ξ) & (ξ <= high)
            away &= ~(on_tip_edge(cut, int(tooth), z[result.node]) | over_kink(cut, int(tooth), z[result.node]))
            largest.append(float(result.pressure[away].max(initial=0.0)))
    return float(100.0 * max(1.0, np.ceil(max(largest) / 100.0)))


def envelope(run: RunData, index: int, ξ: Floats) -> tuple[Floats, Floats]:
    """Heights (h,) [mm] and fitted peak pressures (len(ξ), h) [MPa] at roll distances ξ (n,) [mm] over the engagement.

    The contact line passes each height once in an engagement, so that the peaks of all positions of the pitch form one
    curve over ξ there. NaN where no position lies near, or only on a tip edge, and where the contact of a spur pair
    covers the start of a linear relief.
    """
    cuts = [each[index].cut for each in run.positions]
    whole = Slices.joined(cuts)
    z, line = whole.z, whole.roll_distance
    peak = np.concatenate([pooled_peaks(cut) for cut in cuts])
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


def _path(run: RunData) -> Floats:
    """Roll distances (480,) of the envelope's map [mm]."""
    return np.linspace(*run.inner_path, 480)


def _envelope_map(axes: Axes, run: RunData, index: int, top: float) -> QuadMesh:
    """Map of the envelope with labelled contours and nominal contact lines."""
    ξ = _path(run)
    z = np.linspace(-0.5, 0.5, 320) * run.pair.face_width
    fine = envelope_between(run, index, ξ, z)
    shown = axes.pcolormesh(z, ξ, fine, cmap=PRESSURE_MAP, vmin=0.0, vmax=top, shading="nearest", rasterized=True)
    if np.isfinite(fine).any():
        levels = MaxNLocator(8).tick_values(np.nanmin(fine), np.nanmax(fine))
        lines = axes.contour(z, ξ, fine, levels=levels, colors="white", linewidths=0.7)
        axes.clabel(lines, fmt="%.0f", fontsize=8, manual=_label_places(lines, run))
    angle = run.angles[0]
    for tooth in range(-3, 4):
        _nominal_lines(axes, run, angle + tooth * run.pitch / 3.0, only=0)
    return shown


def envelope_between(run: RunData, index: int, ξ: Floats, z: Floats) -> Floats:
    """The envelope (len(ξ), len(z)) [MPa] interpolated between the heights of slices. ξ, z: (n,), (m,) [mm]. The region
    of known values ends at straight lines from slice to slice; NaN beyond it and in its holes."""
    heights, peak = envelope(run, index, ξ)
    known = np.isfinite(peak)
    sliced = known.any(axis=0)
    if not sliced.any():
        return np.full((len(ξ), len(z)), np.nan)
    heights, peak, known = heights[sliced], peak[:, sliced], known[:, sliced]
    first, last = ξ[known.argmax(axis=0)], ξ[len(ξ) - 1 - known[::-1].argmax(axis=0)]
    filled = np.column_stack([np.interp(ξ, ξ[here], column[here]) for here, column in zip(known.T, peak.T)])
    holes = ~known & (first < ξ[:, None]) & (ξ[:, None] < last)
    fine, hole = (np.stack([np.interp(z, heights, row) for row in rows]) for rows in (filled, holes.astype(float)))
    low, high = np.interp(z, heights, first), np.interp(z, heights, last)
    return np.where((low <= ξ[:, None]) & (ξ[:, None] <= high) & (hole < 0.5), fine, np.nan)


def _label_places(lines: ContourSet, run: RunData) -> list[tuple[float, float]]:
    """Places (z, ξ) [mm] of contour labels: for each level the point of its longest line nearest to mid-face. Short
    lines have no label, nor places in the outer fifths of the face or near the tip-edge zones."""
    places, reach = [], 0.3 * run.pair.face_width
    low, high = run.inner_path
    margin = 0.06 * (high - low)
    for segments in lines.allsegs:
        lengths = [float(np.hypot(*np.diff(segment, axis=0).T).sum()) for segment in segments]
        if not lengths or max(lengths) < reach:
            continue
        points = segments[int(np.argmax(lengths))]
        nearest = points[np.argmin(np.abs(points[:, 0]))]
        if abs(nearest[0]) <= reach and low + margin < nearest[1] < high - margin:
            places.append((float(nearest[0]), float(nearest[1])))
    return places


def _position_map(axes: Axes, run: RunData, solved: SolvedPosition, top: float) -> None:
    """The pressures of all teeth at a position on one flank; one colour where a tooth pair bears on a tip edge, as the
    pressure is singular there."""
    result, patch = solved.result, flank_patch(run, Member.PINION)
    pressure, on_edge = np.zeros((2, len(patch.roll_length), len(patch.z)))
    for tooth in map(int, np.unique(result.tooth)):
        own = patch.values(run, result, tooth, flank_field(run, result, tooth))
        edge = on_tip_edge(solved.cut, tooth, patch.z)
        pressure = np.maximum(pressure, own * ~edge)
        on_edge = np.maximum(on_edge, (own > 0.0) & edge)
    ξ = patch.roll_length - run.pair.pitch_point_roll_lengths[0]
    axes.pcolormesh(
        patch.z, ξ, pressure, cmap=PRESSURE_MAP, vmin=0.0, vmax=top, shading="gouraud", rasterized=True
    )
    shown = np.where(on_edge > 0.0, 1.0, np.nan)
    axes.pcolormesh(patch.z, ξ, shown, cmap=ListedColormap([FAINT]), shading="nearest", rasterized=True)
    _nominal_lines(axes, run, solved.result.stand.angle)


def _nominal_lines(axes: Axes, run: RunData, angle: float, only: int | None = None) -> None:
    """Contact lines of rigid flanks at a pinion rotation [rad]. only: of this tooth pair."""
    for line in contact_lines(run.pair, angle):
        if only is None or line.tooth == only:
            axes.plot(line.z, line.roll_distance, color=INK, linewidth=0.8, linestyle=(0, (4, 3)))


def _flank_axes(axes: Axes, run: RunData) -> None:
    """Labels and limits of a flank's axes, its pitch line and the limits of the tip-edge zones."""
    half, (start, end) = 0.5 * run.pair.face_width, run.pair.path_of_contact
    axes.axhline(0.0, color="#2e7d6b", linewidth=1.0)
    for limit in run.inner_path:
        axes.axhline(limit, color=INK, linewidth=0.9, linestyle=":")
    axes.set(xlabel=FACE, xlim=(-half, half), ylim=(start - 0.35, end + 0.15))
    axes.grid(False)


def _diameters(axes: Axes, run: RunData) -> None:
    """Second scale with the diameter on the pinion."""
    base, pitch = run.pair.pinion.base_radius, run.pair.pitch_point_roll_lengths[0]

    def to_diameter(ξ: Floats) -> Floats:
        return 2.0 * np.sqrt(base**2 + np.maximum(pitch + ξ, 0.0) ** 2)

    def to_roll(d: Floats) -> Floats:
        return np.sqrt(np.maximum((0.5 * d) ** 2 - base**2, 0.0)) - pitch

    axes.secondary_yaxis("right", functions=(to_diameter, to_roll)).set_ylabel("pinion diameter [mm]")


def _map_subtitle(run: RunData, index: int) -> str:
    """Subtitle: the largest pressure and its place."""
    top = largest_peak(run, index)
    ξ = top.roll_distance
    side = "below the pitch line, towards the root" if ξ < 0 else "above the pitch line, towards the tip"
    limit = f", {AT_ZONE_END}" if top.at_zone_end else ""
    where = f"at ξ = {signed(ξ, 2)} mm, {side}{limit}" if np.isfinite(ξ) else "nowhere"
    subtitle = f"Between the tip-edge zones (dotted) the largest pressure, {top.pressure:.0f} MPa, occurs {where}"
    blank = "; blank: linear reliefs begin" if relief_starts(run.pair) else ""
    return f"{subtitle}; dashed: contact lines of rigid flanks{blank}."
