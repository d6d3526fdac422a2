"""Axial section of a gear's body: rim, web and hub with their sizes, and where it is held."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from evolvent.results.drawing.style import INK
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters

HELD_WIDTH = 3.0
"""Width of the line along the held part of a bore [points]."""


def body_outline(gear: GearParameters) -> Floats:
    """Points (n, 2), height z and radius [mm], around the half section of the body from the bore to the root circle."""
    half, root, bore = 0.5 * gear.face_width, 0.5 * gear.root_diameter, 0.5 * gear.bore_diameter
    if (web := gear.thin_web) is None:
        return np.array([[-half, bore], [half, bore], [half, root], [-half, root]])
    outer, inner = (0.5 * diameter for diameter in gear.web_diameters)
    low, high = web.ends
    hub = [[-half, inner], [-half, bore], [half, bore], [half, inner]] if inner > bore else []
    rim = [[half, outer], [half, root], [-half, root], [-half, outer]]
    return np.array([[low, inner], *hub, [high, inner], [high, outer], *rim, [low, outer]])


def draw_axial_section(axes: Axes, gear: GearParameters, colour: str) -> None:
    """The half section above the axis in one scale."""
    half, root, tip = (0.5 * value for value in (gear.face_width, gear.root_diameter, gear.tip_diameter))
    axes.fill(*body_outline(gear).T, facecolor="none", edgecolor=colour, hatch="///", lw=1.4)
    axes.fill([-half, half, half, -half], [root, root, tip, tip], facecolor=colour, edgecolor=colour, alpha=0.15)
    axes.plot(gear.held_ends, [0.5 * gear.bore_diameter] * 2, color=INK, lw=HELD_WIDTH)
    axes.set_aspect("equal")
    axes.set(xlim=(-1.15 * half, 1.15 * half), ylim=(0.0, 1.04 * tip))
    axes.set_title("\n".join(_sizes(gear)), fontsize=9.0)
    axes.set_xlabel("z from mid-face [mm]")
    axes.set_ylabel("distance from the axis [mm]")
    axes.grid(visible=False)


def _sizes(gear: GearParameters) -> list[str]:
    """Two lines with the dimensions of a gear body."""
    width = f"axial section, b = {gear.face_width:g}, bore {gear.bore_diameter:.6g} mm"
    web = gear.thin_web
    if web is None:
        return [width, f"s_R = {gear.rim_thickness:.4g} mm" if gear.has_rim else ""]
    hub = "" if web.hub_diameter is None else f", hub {web.hub_diameter:.6g}"
    return [width, f"s_R = {web.rim_thickness:.4g}, b_s = {web.thickness:.4g}{hub} mm"]
