"""Rows of `evolvent check` on tooth forms that differ from that of the basic rack alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from evolvent.check.text_table import Row
from evolvent.scene.plain_text import fixed
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair


def gear_lines(pair: GearPair) -> list[Row]:
    """Lines on the tooth form and body of both gears, each where one of the gears has the input that it follows from.
    """
    return [*_tip_edge(pair), *_protuberance(pair), *_thickness(pair), *_web(pair), *_support(pair)]


def pair_lines(pair: GearPair) -> list[Row]:
    """Line on the circumferential backlash; none where no tooth thickness allowance is given."""
    if not any(gear.tooth_thickness_allowance_um for gear in pair.gears):
        return []
    return [Row("circumferential backlash", "j_wt", "µm", (fixed(1e3 * pair.circumferential_backlash, 2),))]


def _thickness(pair: GearPair) -> list[Row]:
    if not any(gear.tooth_thickness_allowance_um for gear in pair.gears):
        return []
    return [
        _each(pair, "tooth thickness allowance", "A_sn", "µm", 1, lambda gear: gear.tooth_thickness_allowance_um),
        _each(pair, "generating profile shift coefficient", "x_E", "", 4, lambda gear: gear.generating_shift),
        _each(
            pair, "normal tooth thickness", "s_n", "mm", 4, lambda gear: gear.normal_thickness(gear.reference_diameter)
        ),
    ]


def _tip_edge(pair: GearPair) -> list[Row]:
    lines = [
        _each(pair, name, symbol, "µm", 1, value)
        for name, symbol, value in (
            ("tip chamfer, radial", "h_K", lambda gear: gear.tip_chamfer_um),
            ("radius of the tip rounding", "ρ_K", lambda gear: gear.tip_rounding_um),
        )
        if any(value(gear) for gear in pair.gears)
    ]
    form = _each(pair, "tip form diameter", "d_Fa", "mm", 3, lambda gear: gear.tip_form_diameter)
    land = _each(pair, "normal land between chamfers or roundings", "", "mm", 4, _tip_land)
    return [*lines, form, land] if lines else []


def _tip_land(gear: GearParameters) -> float:
    """Normal width of the tip land that remains [mm]: s_an of a sharp tip."""
    whole, edge = gear.normal_thickness(gear.tip_diameter), gear.tip_edge
    return whole if edge is None else whole * edge.end[1] / gear.half_angle(gear.tip_diameter)


def _protuberance(pair: GearPair) -> list[Row]:
    if not any(gear.protuberance_um for gear in pair.gears):
        return []
    return [_each(pair, "residual protuberance of the rack", "s_pr", "µm", 1, lambda gear: gear.protuberance_um)]


def _web(pair: GearPair) -> list[Row]:
    webs = [gear.thin_web for gear in pair.gears]
    if not any(webs):
        return []

    def each(name: str, symbol: str, values: Iterable[float | None]) -> Row:
        return Row(name, symbol, "mm", tuple("–" if value is None else fixed(value, 3) for value in values))

    return [
        each("rim, on a web", "s_R", (None if web is None else web.rim_thickness for web in webs)),
        each("web thickness", "b_s", (None if web is None else web.thickness for web in webs)),
        each("  from", "z", (None if web is None else web.ends[0] for web in webs)),
        each("  to", "", (None if web is None else web.ends[1] for web in webs)),
        each("hub diameter (–: no hub)", "", (None if web is None else web.hub_diameter for web in webs)),
    ]


def _support(pair: GearPair) -> list[Row]:
    lines = []
    if any(gear.support.is_rim for gear in pair.gears):
        rims = tuple(fixed(gear.rim_thickness, 3) if gear.support.is_rim else "–" for gear in pair.gears)
        lines.append(Row("rim, held at its inside", "s_R", "mm", rims))
    if any(gear.support.is_partial(gear.face_width) for gear in pair.gears):
        low, high = (tuple(fixed(gear.held_ends[i], 3) for gear in pair.gears) for i in (0, 1))
        lines += [Row("bore held from", "z", "mm", low), Row("  to", "", "mm", high)]
    return lines


def _each(
    pair: GearPair, name: str, symbol: str, unit: str, digits: int, value: Callable[[GearParameters], float]
) -> Row:
    return Row(name, symbol, unit, tuple(fixed(value(gear), digits) for gear in pair.gears))
