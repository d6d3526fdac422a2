"""Figures of the pair as a drive: load sharing, transmission error, losses, line load and sliding."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.results.archive.error_bar_data import plus_minus
from evolvent.results.drawing.style import FAINT, INK, PINION, WHEEL, dot_size, foot, friction_colours, sheet
from evolvent.results.engagement import engagements
from evolvent.results.face_load import face_load
from evolvent.results.figures.stress import TOOTH_ANGLE
from evolvent.results.position_figures import loss_percent
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.summary_rows import FrictionRow
from evolvent.scene.plain_text import brief, signed
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import contact_lines

PINION_ANGLE = "pinion rotation φ [°]"
EVEN = 600
"""Number of rotations in a pitch for the load sharing of rigid flanks, which jumps on a spur pair."""
MOST_SLIDING = 8.0
"""The axis of specific sliding ends at its negative: near a base circle specific sliding is unbounded."""


def load_sharing(run: RunData) -> Figure:
    """Figure of the share of the normal force on a tooth over its engagement."""
    curves = engagements(run)
    most = [float(c.share.max()) for c in curves]
    low, high = int(np.argmin(run.frictions)), int(np.argmax(run.frictions))
    counts = [len(each[0].teeth) for each in run.positions]
    subtitle = f"{min(counts)} to {max(counts)} tooth pairs in contact; "
    subtitle += f"a tooth carries at most {100 * most[low]:.0f} % of the load"
    changed = round(100 * most[high]) != round(100 * most[low])
    subtitle += f", {100 * most[high]:.0f} % at μ = {run.frictions[high]:g}." if changed else "."
    figure = sheet("Load sharing", subtitle)
    axes = figure.subplots()
    for curve, colour in zip(curves, friction_colours(run.frictions)):
        first, last = curve.ends
        share, angle = np.array([0.0, *curve.share, 0.0]), np.degrees([first, *curve.angle, last])
        axes.plot(angle, 100.0 * share, color=colour, label=f"μ = {curve.friction:g}")
    angle, share = even_share(run)
    angle, share = np.degrees(angle[[0, *range(len(angle)), -1]]), np.array([0.0, *share, 0.0])
    by_length = {"color": FAINT, "linestyle": "--", "linewidth": 1.2, "label": "proportional to contact line length"}
    axes.plot(angle, 100.0 * share, **by_length)
    axes.set(xlabel=TOOTH_ANGLE, ylabel="share of the normal force [%]")
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="lower center", ncols=1)  # below the curves, which rise from both ends
    return figure


def even_share(run: RunData) -> tuple[Floats, Floats]:
    """Rotations (n,) [rad] of a tooth and its shares (n,) of the load for an even load on the contact lines of rigid
    flanks."""
    rows = []
    for angle in np.linspace(0.0, run.pitch, EVEN, endpoint=False):
        lines = contact_lines(run.pair, float(angle))
        lengths = [line.z[1] - line.z[0] for line in lines]
        rows += [(angle + line.tooth * run.pitch, size / sum(lengths)) for line, size in zip(lines, lengths)]
    table = np.array(sorted(rows))
    return table[:, 0], table[:, 1]


def transmission_error(run: RunData) -> Figure:
    """Figure of the loaded transmission error over a pitch."""
    rows = friction_rows(run)
    bars = [run.errors.bar("transmission_error_peak_to_peak_um", k) for k in range(len(rows))]
    sizes = [plus_minus(row.transmission_error_peak_to_peak_um, bar, 2) for row, bar in zip(rows, bars)]
    low, high = int(np.argmin(run.frictions)), int(np.argmax(run.frictions))
    subtitle = f"Peak to peak {sizes[low]} µm at μ = {run.frictions[low]:g}"
    subtitle += f", {sizes[high]} µm at μ = {run.frictions[high]:g}" if low != high else ""
    stiffness = rows[low].mesh_stiffness_N_per_mm_um
    if np.isfinite(stiffness):
        bar = run.errors.bar("mesh_stiffness_N_per_mm_um", low)
        subtitle += f"; mean mesh stiffness {plus_minus(stiffness, bar, 1)} N/(mm·µm)"
    subtitle += "."
    figure = sheet("Loaded transmission error over a pitch", subtitle)
    axes = figure.subplots()
    foot(figure, _between(len(run.positions), rows[low], bars[low]))
    for index, colour in enumerate(friction_colours(run.frictions)):
        x, y = _closed(run, np.array([1e3 * each[index].result.transmission_error for each in run.positions]))
        axes.plot(x, y, color=colour, marker=".", markersize=5, label=f"μ = {run.frictions[index]:g}")
    axes.set(xlabel=PINION_ANGLE, ylabel="transmission error $r_{b1}φ_1 − r_{b2}φ_2$ [µm]")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=7)
    return figure


def _between(positions: int, row: FrictionRow, bar: float) -> str:
    """Footnote on the spacing error of the peak-to-peak value. bar: its error bar [µm], which holds that part, or
    NaN."""
    missed = row.spacing_error.transmission_error_peak_to_peak_um
    if np.isfinite(bar):
        part = f"Of the error bar at μ = {row.friction:g}, {brief(missed)} µm"
        return f"{part} allow for extremes between the {positions} positions."
    return f"Between the {positions} positions the curve may have extremes: peak to peak up to {brief(missed)} µm more."


def _closed(run: RunData, values: Floats) -> tuple[Floats, Floats]:
    """Rotations φ [°] and values over the closed pitch: the first position is repeated at the end."""
    angles = np.append(run.angles, run.angles[0] + run.pitch)
    return np.degrees(angles), np.append(values, values[0])


def losses(run: RunData) -> Figure:
    """Figure of the friction power over a pitch, and of the mean loss over μ."""
    rows = sorted(friction_rows(run), key=lambda row: row.friction)
    ends = " and ".join(
        f"{_efficiency(row)} at μ = {row.friction:g}" for row in {r.friction: r for r in (rows[0], rows[-1])}.values()
    )
    figure = sheet("Friction loss", f"Efficiency of the mesh over a pitch: {ends}.", (10.6, 4.8))
    over, total = figure.subplots(1, 2, width_ratios=(1.6, 1.0))
    for index, colour in enumerate(friction_colours(run.frictions)):
        x, y = _closed(run, np.array([loss_percent(run, each[index]) for each in run.positions]))
        over.plot(x, y, color=colour, label=f"μ = {run.frictions[index]:g}")
    over.set(xlabel=PINION_ANGLE, ylabel="friction power over input power [%]")
    over.set_ylim(bottom=-0.02 * over.get_ylim()[1])  # a line at 0 is visible
    over.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    bars = [0.0 if row.estimated_error is None else row.estimated_error.loss_percent for row in rows]
    points = [row.friction for row in rows], [row.loss_percent for row in rows]
    total.errorbar(*points, yerr=bars, color=INK, marker="o", capsize=3.0)
    total.set(xlabel="friction coefficient μ", ylabel="mean loss over a pitch [%]")
    most = max(run.frictions)
    total.set_xlim(-0.04 * most, 1.06 * most)
    total.set_ylim(bottom=-0.02 * max(points[1]))
    return figure


def _efficiency(row: FrictionRow) -> str:
    """Efficiency [%] with its error bar, which is that of the loss."""
    bar = math.nan if row.estimated_error is None else row.estimated_error.loss_percent
    return f"{plus_minus(100.0 - row.loss_percent, bar, 2)} %"


def line_load(run: RunData, index: int = 0) -> Figure:
    """Figure of line load and specific sliding along the path of contact, at the friction coefficient with this
    index."""
    start, end = run.pair.path_of_contact
    cut = Slices.joined([each[index].cut for each in run.positions])
    ξ, load, edge = cut.roll_distance, cut.line_load, cut.edge
    even = run.scene.hertz_estimate()
    low, mean, high = (
        even.normal_force / length for length in (even.line_lengths[2], even.line_lengths[1], even.line_lengths[0])
    )
    inside = load[(ξ > start) & (ξ < end) & ~edge]
    subtitle = f"Away from the tip edges {inside.min():.0f} to {inside.max():.0f} N/mm"
    subtitle += f", at most {inside.max() / mean:.2f} times the uniform line load (μ = {run.frictions[index]:g})"
    subtitle += "." if run.plane else f"; rigid shafts: {_face_load_factor(run, index)}."
    figure = sheet("Line load and sliding along the path of contact", subtitle, (10.0, 6.2))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.6, 1.0))
    upper.plot(
        ξ[~edge],
        load[~edge],
        ".",
        color="#556070",
        markersize=dot_size(len(ξ)),
        alpha=0.6,
        label="all slices of all positions",
    )
    upper.plot(ξ[edge], load[edge], "x", color="#c98a1b", markersize=dot_size(len(ξ)) + 1, label="tip-edge contact")
    upper.axhline(mean, color="#3b7a57", linewidth=1.2, label="uniform line load (rigid flanks), mean")
    upper.axhspan(low, high, color="#3b7a57", alpha=0.15, linewidth=0.0, label="its range over the pitch")
    upper.set_ylabel("line load [N/mm]")
    upper.set_ylim(-0.02 * float(np.max(load)), 1.3 * float(np.max(load)))
    upper.legend(loc="upper center", ncols=4)
    _sliding(lower, run)
    ends = min(start, float(ξ.min())), max(end, float(ξ.max()))
    margin = 0.03 * (ends[1] - ends[0])
    lower.set(
        xlabel="roll distance ξ from the pitch point [mm]   (pinion root → pinion tip)",
        xlim=(ends[0] - margin, ends[1] + margin),
    )
    return figure


def _face_load_factor(run: RunData, index: int) -> str:
    """K_Hβ with its error bar."""
    bar = run.errors.bar("face_load_factor", index)
    return f"$K_{{Hβ}}$ {plus_minus(face_load(run, index).factor(), bar, 2)}"


def _sliding(axes: Axes, run: RunData) -> None:
    """Curves of the specific sliding of both gears, (v_1 − v_2)/v_1 and (v_2 − v_1)/v_2."""
    ξ = np.linspace(*run.pair.path_of_contact, 300)
    ρ1, ρ2 = run.pair.curvature_radii(ξ)
    v1, v2 = ρ1, ρ2 / run.pair.ratio
    with np.errstate(divide="ignore"):  # at a base circle
        curves = (("pinion", PINION, 1.0 - v2 / v1, 0), ("wheel", WHEEL, 1.0 - v1 / v2, -1))
    for name, colour, sliding, end in curves:
        axes.plot(ξ, sliding, color=colour, label=name)
        if sliding[end] < -MOST_SLIDING:
            _cut_off(axes, float(ξ[end]), float(sliding[end]), colour)
    axes.axvline(0.0, color=FAINT, linestyle=":", linewidth=1.0)
    axes.set_ylabel("specific sliding [–]")
    least = max(-MOST_SLIDING, min(float(sliding.min()) for _, _, sliding, _ in curves))
    axes.set_ylim(1.08 * least, 1.3)
    axes.legend(loc="lower center")  # both curves decrease towards an end of the path


def _cut_off(axes: Axes, ξ: float, sliding: float, colour: str) -> None:
    """Arrow where a curve leaves the axes, with the value at its end."""
    value = f"{signed(sliding)} at the end" if np.isfinite(sliding) else "unbounded"
    inwards = 1.0 if ξ < 0.0 else -1.0
    axes.annotate(
        value, (ξ, -MOST_SLIDING), (36.0 * inwards, 0.0), textcoords="offset points", color=colour, fontsize=9,
        ha="left" if ξ < 0.0 else "right", va="bottom",
    )
    axes.plot(ξ, -MOST_SLIDING, marker="v", color=colour, markersize=7.0, clip_on=False)
