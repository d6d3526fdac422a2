"""Pictures of a wear study: depth over profile and flank, its growth, and its effect on load sharing and transmission
error."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from evolvent.results.drawing.offscreen import off_screen
from evolvent.results.drawing.picture_files import Picture
from evolvent.results.drawing.style import (
    ABOVE,
    FAINT,
    PINION,
    PRESSURE_MAP,
    WHEEL,
    friction_colours,
    png_of,
    sheet,
)
from evolvent.results.engagement import engagement
from evolvent.results.fields.flank_field import flank_patch
from evolvent.results.figures.drive import PINION_ANGLE
from evolvent.results.figures.scene3d import flank_picture
from evolvent.results.figures.stress import TOOTH_ANGLE
from evolvent.scene.plain_text import cycles_label
from evolvent.scene.scene import GEARS
from evolvent.wear.results.report import WornPair, WornRun
from evolvent.wear.results.vibration_figure import vibration_over_cycles
from evolvent.wear.results.worn_lines import load_words
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

PATCH = (240, 60)  # points of a flank over profile and width; few suffice, as wear is smooth
Draw = Callable[[WornRun], Figure]


def pictures(study: WornRun) -> Iterator[Picture]:
    """All pictures of a study."""
    for name, draw in _figures(study):
        yield Picture(f"{name}.png", partial(_drawn, draw, study))


def _drawn(draw: Draw, study: WornRun) -> bytes:
    with off_screen():
        return png_of(draw, study)


def _figures(study: WornRun) -> Iterator[tuple[str, Draw]]:
    yield "20_wear_depth", depth_over_profile
    if not study.pairs[0].run.plane:
        yield "21_wear_map", depth_over_flank
    yield "22_wear_growth", growth
    yield "23_force_as_worn", force_on_tooth
    yield "24_transmission_error_as_worn", transmission_error
    yield "25_worn_teeth", worn_teeth
    if study.vibrations:
        yield "26_vibration_as_worn", vibration


def vibration(study: WornRun) -> Figure:
    """Figure of the vibration at the operating speed over the cycles."""
    dynamics = study.scene.dynamics
    assert dynamics is not None and dynamics.operating_rpm is not None
    load = study.scene.load
    return vibration_over_cycles(study.vibrations, dynamics.operating_rpm, f"{load.torque_Nm:g} N·m on the {load.on}")


def wearing(study: WornRun) -> dict[Member, float]:
    """K/H [mm²/N] of the gears that wear."""
    wear = study.scene.wear
    assert wear is not None
    return {gear: K for gear, K in zip(Member, (wear.pinion_mm2_per_N, wear.wheel_mm2_per_N)) if K > 0.0}


def _colours(study: WornRun) -> list[tuple[float, ...]]:
    return friction_colours([pair.cycles for pair in study.pairs])


def depth_over_profile(study: WornRun) -> Figure:
    """Depth over the diameter at each report, mean over the face."""
    last, gears = study.pairs[-1], wearing(study)
    reports = [getattr(last.report(), GEARS[gear]) for gear in gears]
    deepest = ", ".join(
        f"{GEARS[gear]} {_three(report.deepest_um)} µm at d = {report.at_diameter_mm:.1f} mm"
        for gear, report in zip(gears, reports)
    )
    see = f"Largest depth after {cycles_label(last.cycles)} cycles: {deepest}; edge margins, 0.1 mₙ, left out."
    figure = sheet("Wear depth over the profile", see)
    for ax, gear in zip(figure.subplots(1, len(gears), sharey=True, squeeze=False)[0], gears):
        for pair, colour in zip(study.pairs[1:], _colours(study)[1:]):
            ax.plot(*pair.profile(gear), color=colour, label=f"{cycles_label(pair.cycles)} cycles")
        ax.axvline(study.pairs[0].run.pair.working_pitch_diameters[gear], color=FAINT, lw=1.0, ls="--")
        ax.set_title(f"{GEARS[gear]} (dashed: pitch circle)", fontsize=10)
        ax.set(xlabel="diameter [mm]")
        ax.label_outer()
    figure.axes[0].set(ylabel="wear depth, mean over the face [µm]", ylim=(0.0, None))  # once all curves are there
    figure.axes[0].legend()
    return figure


def depth_over_flank(study: WornRun) -> Figure:
    """The worn flanks unrolled, at the end."""
    last, gears = study.pairs[-1], wearing(study)
    title = f"Worn flanks after {cycles_label(last.cycles)} cycles"
    figure = sheet(title, f"{_most(study)} The tip is above, the root below.", (5.8 * len(gears) + 1.0, 5.6))
    for ax, gear in zip(figure.subplots(1, len(gears), squeeze=False)[0], gears):
        chart = last.worn[gear]
        shown = ax.pcolormesh(
            chart.heights, chart.diameters, 1e3 * chart.depth, cmap=PRESSURE_MAP, vmin=0.0, vmax=_deepest(last, gear),
            shading="gouraud",
        )
        ax.axhline(last.run.pair.working_pitch_diameters[gear], color=FAINT, lw=1.0, ls="--")
        ax.set_title(f"{GEARS[gear]} (dashed: pitch circle)", fontsize=10)
        ax.set(xlabel="axial position z [mm]", ylabel="diameter [mm]")
        ax.grid(False)
        _depth_bar(figure, ax, shown)
    return figure


def worn_teeth(study: WornRun) -> Figure:
    """The worn flanks on their teeth, at the end."""
    last, gears = study.pairs[-1], wearing(study)
    title = f"Worn teeth after {cycles_label(last.cycles)} cycles"
    see = f"Little wear along the pitch line, where the flanks roll. {_most(study)}"
    figure = sheet(title, see, (6.2 * len(gears) + 1.0, 5.0))
    for ax, gear in zip(figure.subplots(1, len(gears), squeeze=False)[0], gears):
        patch, top = flank_patch(last.run, gear, PATCH), _deepest(last, gear)
        ρ, z = np.meshgrid(patch.roll_length, patch.z, indexing="ij")
        depth = last.worn[gear].at(last.run.pair.gears[gear], ρ.ravel(), z.ravel()).reshape(ρ.shape)
        result = last.run.positions[0][0].result
        ax.imshow(flank_picture(last.run, result, patch, 1e3 * depth, top, (960, 720)))
        ax.set_title(f"{GEARS[gear]}, {gear.mate.label} hidden", fontsize=10)
        ax.axis("off")
        _depth_bar(figure, ax, ScalarMappable(Normalize(0.0, top), PRESSURE_MAP))
    return figure


def _depth_bar(figure: Figure, ax: Axes, shown: ScalarMappable) -> None:
    """A colour bar per gear, as their depths may differ widely; tip edges are beyond its end."""
    figure.colorbar(shown, ax=ax, label=f"wear depth [µm]   ({ABOVE})", shrink=0.85, extend="max")


def _most(study: WornRun) -> str:
    """Caption with the depths at the upper end of the colours."""
    depths = [f"{GEARS[gear]} {_three(_deepest(study.pairs[-1], gear))} µm" for gear in wearing(study)]
    return f"Largest depth between the edge margins, 0.1 mₙ: {', '.join(depths)}."


def _three(value: float) -> str:
    """A number with three significant digits, trailing zeros included."""
    return f"{value:#.3g}".removesuffix(".")


def _deepest(pair: WornPair, gear: Member) -> float:
    """Largest worn depth [µm] of a gear between the edge margins."""
    return 1e3 * float(pair.worn[gear].depth[pair.inner(gear)].max())


def growth(study: WornRun) -> Figure:
    """Largest depth and worn volume over the cycles; one dot per block."""
    error = 100.0 * max(row.error for row in study.rows)
    see = f"{len(study.rows)} blocks of cycles; estimated error of a block's worn volume at most {error:.1f} %."
    figure = sheet("Wear depth and worn volume over the cycles", see)
    left, right = figure.subplots(1, 2)
    unit, name = _unit(study)
    for gear in wearing(study):
        style = {"color": (PINION, WHEEL)[gear], "linestyle": ("-", "--")[gear], "marker": ".", "label": GEARS[gear],
                 "clip_on": False}
        x = np.array([0.0, *(row.cycles for row in study.rows)]) / unit
        deepest = [0.0, *(getattr(row, f"deepest_{GEARS[gear]}_um") for row in study.rows)]
        volume = [0.0, *(getattr(row, f"volume_{GEARS[gear]}_mm3") for row in study.rows)]
        left.plot(x, deepest, **style)
        right.plot(x, volume, **style)
    for ax, label in ((left, "largest depth between the edge margins [µm]"), (right, "worn volume per tooth [mm³]")):
        ax.set(xlabel=f"revolutions of the pinion [{name}]", ylabel=label, ylim=(0.0, None), xlim=(0.0, None))
        ax.legend()
    return figure


def _unit(study: WornRun) -> tuple[float, str]:
    cycles = study.pairs[-1].cycles
    return (1e6, "millions") if cycles >= 5e5 else (1e3, "thousands") if cycles >= 500.0 else (1.0, "1")


def force_on_tooth(study: WornRun) -> Figure:
    """Normal force on a tooth over its engagement at each report."""
    curves = [engagement(pair.run, 0) for pair in (study.pairs[0], study.pairs[-1])]
    (first, last), (new, worn) = (c.force.max() for c in curves), (np.degrees(np.ptp(c.ends)) for c in curves)
    see = f"Unworn: a tooth is engaged over {new:.2f}° and carries at most {first:.0f} N"
    see += f"; after {cycles_label(study.pairs[-1].cycles)} cycles: {worn:.2f}°, {last:.0f} N."
    title = f"Force on a tooth {load_words(study.scene)}, unworn and worn flanks"
    figure = _over_rotation(study, title, see, "normal force on a tooth [N]", _force)
    figure.axes[0].set(xlabel=TOOTH_ANGLE, ylim=(0.0, None))
    return figure


def _force(pair: WornPair) -> tuple[Floats, Floats]:
    """Rotation [°] and force [N] over the whole engagement of a tooth."""
    curve = engagement(pair.run, 0)
    first, last = curve.ends
    return np.degrees([first, *curve.angle, last]), np.array([0.0, *curve.force, 0.0])


def transmission_error(study: WornRun) -> Figure:
    """Loaded transmission error minus its mean over a pitch at each report."""
    first, last = (pair.report().transmission_error_peak_to_peak_um for pair in (study.pairs[0], study.pairs[-1]))
    see = f"Peak to peak {first:.2f} µm unworn, {last:.2f} µm after {cycles_label(study.pairs[-1].cycles)} cycles."
    title = f"Transmission error {load_words(study.scene)}, unworn and worn flanks"
    return _over_rotation(study, title, see, "transmission error minus its mean [µm]", _error)


def _error(pair: WornPair) -> tuple[Floats, Floats]:
    values = np.array([1e3 * each[0].result.transmission_error for each in pair.run.positions])
    closed = np.append(values, values[0]) - values.mean()
    angles = np.degrees(np.append(pair.run.angles, pair.run.angles[0] + pair.run.pitch))
    return angles, closed


def _over_rotation(
    study: WornRun, title: str, see: str, label: str, curve: Callable[[WornPair], tuple[Floats, Floats]]
) -> Figure:
    figure = sheet(title, see)
    ax: Axes = figure.add_subplot()
    for pair, colour in zip(study.pairs, _colours(study)):
        name = f"{cycles_label(pair.cycles)} cycles" if pair.cycles else "unworn"
        ax.plot(*curve(pair), color=colour, label=name)
    ax.set(xlabel=PINION_ANGLE, ylabel=label)
    ax.legend()
    return figure
