"""Picture of the tooth forms of a pair: transverse profiles at mid-face with their key diameters, axial sections."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evolvent.results.drawing.axial_section import draw_axial_section
from evolvent.results.drawing.style import FAINT, INK, PINION, WHEEL, foot, sheet
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.gears.profile import Profile, polar

POINTS = 200
"""Number of points on a segment of a profile."""
COLOURS = PINION, WHEEL
TEXT_HEIGHT = 0.045
"""Height of a label over that of the axes."""


def tooth_form_figure(title: str, pair: GearPair) -> Figure:
    """A tooth of pinion and wheel, each in its own scale; below, their axial sections where a body is no full ring that
    is held over its face. title: of the scene."""
    has_sections = any(_has_form(gear) for gear in pair.gears)
    name = "Tooth forms in the transverse section" + (", bodies in the axial section" if has_sections else "")
    figure = sheet(name, title, (11.0, 11.4 if has_sections else 6.2))
    grid = figure.subplots(1 + has_sections, 2, squeeze=False)
    for member, axes, colour in zip(Member, grid[0], COLOURS):
        _draw_tooth(axes, pair, member, colour)
    for member, axes, colour in zip(Member, grid[1] if has_sections else (), COLOURS):
        draw_axial_section(axes, pair.gears[member], colour)
    foot(
        figure, "Seen from z < 0, loaded flank: right. Relief, crowning and charts are left out.",
        *(["Dashed: the tooth without thickness allowance."] if _are_thin(pair) else []),
        *(["Thick: where the bore is held."] if has_sections else []),
    )
    return figure


def _has_form(gear: GearParameters) -> bool:
    """Whether a body is a rim, has a web, or is held on a part of its face."""
    return gear.has_rim or gear.support.is_partial(gear.face_width)


def key_diameters(pair: GearPair, member: Member) -> dict[str, float]:
    """Symbol of ISO 21771 -> diameter [mm], from the tip down."""
    gear = pair.gears[member]
    found = {
        "d_a": gear.tip_diameter, "d_Fa": gear.tip_form_diameter, "d_w": pair.working_pitch_diameters[member],
        "d": gear.reference_diameter, "d_Nf": pair.active_start_diameters[member], "d_Ff": gear.root_form_diameter,
        "d_b": gear.base_diameter, "d_f": gear.root_diameter,
    }
    if gear.tip_edge is None:
        del found["d_Fa"]
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def _are_thin(pair: GearPair) -> bool:
    return any(gear.tooth_thickness_allowance_um for gear in pair.gears)


def _draw_tooth(axes: Axes, pair: GearPair, member: Member, colour: str) -> None:
    gear = pair.gears[member]
    outline = _upright(Profile(gear).outline(POINTS))
    low = 0.5 * gear.root_diameter - 0.35 * gear.normal_module
    axes.fill(*np.concatenate([outline, [[outline[-1, 0], low], [outline[0, 0], low]]]).T, color=colour, alpha=0.15)
    axes.plot(*outline.T, color=colour)
    if gear.tooth_thickness_allowance_um:
        flank = _full_thickness(gear)
        for side in (flank, flank * [-1.0, 1.0]):
            axes.plot(*side.T, color=colour, lw=0.9, ls="--")
    axes.set_aspect("equal")
    width = 1.15 * float(abs(outline[:, 0]).max())
    axes.set(xlim=(-width, width), ylim=(low, 0.5 * gear.tip_diameter + 0.25 * gear.normal_module))
    axes.set_title(f"{member.label}, z = {gear.z}, generating shift x_E = {gear.generating_shift:.4f}")
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("distance from the axis [mm]")
    axes.grid(visible=False)
    _draw_diameters(axes, key_diameters(pair, member), width)


def _full_thickness(gear: GearParameters) -> Floats:
    """Points (n, 2) of the flank without allowance, between the form circles of the thin tooth."""
    radius = 0.5 * np.linspace(gear.root_form_diameter, gear.tip_form_diameter, POINTS)
    half = -5e-4 * gear.tooth_thickness_allowance_um / (0.5 * gear.normal_module * gear.z)
    return _upright(polar(radius, Profile(gear).angle(radius) + half))


def _upright(points: Floats) -> Floats:
    """Points (n, 2) of a gear's frame with the tooth's centre line upwards, θ > 0 to the right."""
    return points[:, ::-1]


def _draw_diameters(axes: Axes, diameters: dict[str, float], width: float) -> None:
    """Draws arcs of the diameters in the picture, and their names at the right, moved apart where they would cover each
    other."""
    bottom, top = axes.get_ylim()
    step = TEXT_HEIGHT * (top - bottom)
    free = np.inf
    for name, diameter in diameters.items():
        radius, x = 0.5 * diameter, np.linspace(-width, width, 101)
        y = np.sqrt(radius**2 - x**2)
        if y[-1] < bottom:
            continue
        axes.plot(x, y, color=FAINT, lw=0.7, zorder=0.5)
        free = min(float(y[-1]), free - step)
        axes.annotate(
            f"{name} = {diameter:.3f}", (width, y[-1]), (1.06 * width, free), color=INK, fontsize=8.5, va="center",
            annotation_clip=False, arrowprops={"arrowstyle": "-", "color": FAINT, "lw": 0.5},
        )
