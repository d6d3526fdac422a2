"""Figures of one mesh passage of a plane pair, each compared with its formula: stress and sliding of one point and over
the profile, and the depth of a million passages (He et al. 2022, Figs 17 to 19)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.results.drawing.picture_files import Picture
from evolvent.results.drawing.style import FAINT, INK, PINION, WHEEL, foot, png_of, sheet
from evolvent.results.mesh_facts import cells_across, few_cells_across
from evolvent.results.run_data import RunData
from evolvent.scene.scene import GEARS
from evolvent.wear.results.figures import wearing
from evolvent.wear.results.mesh_passage import ContactProfile, DepthProfile, PointPassage, pitch_point_depth
from evolvent.wear.results.report import WornRun
from evolvent_meshes.gears.member import Member

FORMULA = {"color": INK, "linestyle": "--", "linewidth": 1.2}
PASSAGES = 1e6
UM = 1e3 * PASSAGES  # from mm per passage to µm in a million


def pictures(study: WornRun, point: PointPassage) -> Iterator[Picture]:
    """The figures of a plane pair's first passage."""
    yield Picture("26_point_in_contact.png", partial(png_of, point_in_contact, point))
    yield Picture("27_stress_and_sliding.png", partial(png_of, stress_and_sliding, study.pairs[0].run))
    yield Picture("28_depth_by_formula.png", partial(png_of, depth_by_formula, study))


def point_in_contact(point: PointPassage) -> Figure:
    """Contact stress and sliding of a point of the pinion while it is in contact (Fig. 17a)."""
    see = f"In contact over {np.degrees(point.lasts):.3f}° of pinion rotation, at most {point.pressure.max():.0f} MPa"
    see += f" (Hertz: {point.hertz.max():.0f} MPa); sliding distance {1e3 * point.sliding[-1]:.1f} µm."
    figure = sheet(f"One mesh passage of the pinion flank point at r = {point.radius:.4g} mm", see)
    left, right = figure.subplots(1, 2)
    angle = np.degrees(point.rotation)
    left.plot(angle, point.pressure, color=PINION, lw=2.2, label="computed, nodal averages")
    left.plot(angle, point.hertz, label="Hertz, same load", **FORMULA)
    left.set(ylabel="contact stress [MPa]", ylim=(0.0, 1.3 * max(point.pressure.max(), point.hertz.max())))
    left.legend(loc="upper right")
    right.plot(angle, 1e3 * point.sliding, color=PINION)
    right.set(ylabel="sliding distance so far [µm]", ylim=(0.0, None))
    for ax in (left, right):
        ax.set(xlabel="pinion rotation from the pitch point [°]")
    return figure


def stress_and_sliding(run: RunData) -> Figure:
    """Largest contact stress and sliding distance of the points over the pinion's profile (Figs 17b and 18)."""
    both = ContactProfile.of(run, Member.PINION), ContactProfile.of(run, Member.WHEEL)
    pinion = both[0]
    stress, width = (
        100.0 * float(np.median(np.abs(computed / formula - 1.0)))
        for computed, formula in ((pinion.peak, pinion.hertz), (pinion.half_width, pinion.hertz_half_width))
    )
    see = f"Half of the points are within {stress:.1f} % of Hertz's stress and {width:.1f} % of Hertz's contact width"
    see += " for the same load."
    figure = sheet("Contact stress and sliding over the profile, one mesh passage", see)
    if few_cells_across(run):
        few = f"Only {cells_across(run):.1f} elements across the contact"
        foot(figure, f"{few}: single points are for orientation only.")
    left, right = figure.subplots(1, 2)
    left.plot(pinion.radius, pinion.peak, ".", color=PINION, label="computed")
    left.plot(pinion.radius, pinion.hertz, label="Hertz, same load", **FORMULA)
    left.set(ylabel="largest contact stress [MPa]", ylim=(0.0, 1.1 * pinion.peak.max()))
    for profile, colour, name in zip(both, (PINION, WHEEL), GEARS):
        right.plot(pinion.radius, 1e3 * profile.sliding, ".", color=colour, label=f"{name}, computed")
    for profile, label in zip(both, ("2b|1 − v₂/v₁|, 2b|1 − v₁/v₂|", None)):
        right.plot(pinion.radius, 1e3 * profile.single_point, label=label, **FORMULA)
    top = 1e3 * max(float(profile.single_point.max()) for profile in both)
    right.set(ylabel="sliding distance per mesh passage [µm]", ylim=(0.0, 1.35 * top))
    for ax, corner in ((left, "lower center"), (right, "upper center")):
        ax.set(xlabel="radius on the pinion [mm]   (dashed: pitch point)")
        _pitch_point(ax, run.pair.working_pitch_diameters[0] / 2.0)
        ax.legend(loc=corner)
    return figure


def depth_by_formula(study: WornRun) -> Figure:
    """Depth of a million mesh passages of the unworn pair, computed and by two formulas (Fig. 19)."""
    pair, coefficients = study.pairs[0], wearing(study)
    see = "Largest stress times sliding distance, He et al. Eq. 24, is 4/π times the exact depth of a line contact."
    figure = sheet("Wear depth after one million mesh cycles, unworn flanks", see)
    columns = figure.subplots(1, len(coefficients), sharey=True, squeeze=False)[0]
    for ax, (gear, coefficient) in zip(columns, coefficients.items()):
        depths = DepthProfile.of(pair, gear, coefficient)
        ax.plot(depths.radius, UM * depths.computed, color=(PINION, WHEEL)[gear], lw=2.6, label="computed")
        ax.plot(depths.radius, UM * depths.line, label="(K/H) (F/L) |ζ|, same load", **FORMULA)
        ax.plot(depths.radius, UM * depths.peak_times_sliding, color=FAINT, ls=":", label="He et al., Eq. 24")
        pitch = pair.run.pair.working_pitch_diameters[gear] / 2.0
        at_pitch_point = UM * pitch_point_depth(pair.run, gear, coefficient)
        passing = "Hertz pressure passing the pitch point"
        ax.plot([pitch], [at_pitch_point], "o", color=INK, mfc="white", ms=5, label=passing)
        _pitch_point(ax, pitch)
        ax.set(xlabel=f"radius on the {GEARS[gear]} [mm]")
        ax.label_outer()
    figure.axes[0].set(ylabel="wear depth [µm per million mesh cycles]", ylim=(0.0, None))  # once all curves are there
    figure.axes[0].legend()
    return figure


def _pitch_point(ax: Axes, at: float) -> None:
    ax.axvline(at, color=FAINT, lw=1.0, ls="--")
