"""What `evolvent check` tells of a tooth form that is not that of the basic rack alone."""

from __future__ import annotations

from collections.abc import Callable

from evolvent.scene.plain_text import fixed
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair

Line = tuple[str, str, str, tuple[str, ...]]
"""Name, symbol, unit and the values of pinion and wheel, or of both."""


def gear_lines(pair: GearPair) -> list[Line]:
    """Of each gear, where one of the two has the input from which they follow."""
    return _thickness(pair)


def pair_lines(pair: GearPair) -> list[Line]:
    """Of the pair."""
    if not any(gear.tooth_thickness_allowance_um for gear in pair.gears):
        return []
    return [("circumferential backlash", "j_wt", "µm", (fixed(1e3 * pair.circumferential_backlash, 2),))]


def _thickness(pair: GearPair) -> list[Line]:
    if not any(gear.tooth_thickness_allowance_um for gear in pair.gears):
        return []
    return [
        _each(pair, "tooth thickness allowance", "A_sn", "µm", 1, lambda gear: gear.tooth_thickness_allowance_um),
        _each(pair, "generating profile shift coefficient", "x_E", "", 4, lambda gear: gear.generating_shift),
        _each(
            pair, "normal tooth thickness", "s_n", "mm", 4, lambda gear: gear.normal_thickness(gear.reference_diameter)
        ),
    ]


def _each(
    pair: GearPair, name: str, symbol: str, unit: str, digits: int, value: Callable[[GearParameters], float]
) -> Line:
    return name, symbol, unit, tuple(fixed(value(gear), digits) for gear in pair.gears)
