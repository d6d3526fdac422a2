"""The picture of root stress: what tells the formulas apart."""

from __future__ import annotations

import math

import numpy as np
import pytest

from evolvent.strength.results.root_stress_picture import root_stress_figure
from evolvent.strength.results.tables import StrengthRow, formula_rows
from evolvent.strength.standard.root_stress import RootLoad
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair


def formulas(helix_angle: float) -> list[StrengthRow]:
    """Of both gears of 30 and 50 teeth of 3 mm under 150 N·m, by both editions."""
    pinion, wheel = (
        GearParameters.from_rack(
            z=z, normal_module=3.0, normal_pressure_angle_deg=20.0, helix_angle_deg=helix_angle, face_width=20.0,
            bore_diameter=bore, hand=hand,
        )
        for z, bore, hand in ((30, 40.0, 1), (50, 60.0, -1))
    )
    pair = GearPair(pinion, wheel, 120.0 / math.cos(math.radians(helix_angle)))
    return [row for member in Member for row in formula_rows(RootLoad(pair, member, 150e3), (2006, 2019), 6)]


@pytest.mark.parametrize("helix_angle", [0.0, 25.0])
def test_formulas_are_told_apart(helix_angle: float) -> None:
    """Each entry of the legend looks different from the others, of helical pairs, too, where the standard's editions
    are lines over all rotations; each line stands at its stress."""
    rows = formulas(helix_angle)
    figure = root_stress_figure("a pair", [], rows)
    legend = figure.axes[1].get_legend()
    assert legend is not None
    names = [text.get_text() for text in legend.get_texts()]
    assert sorted(names) == sorted({row.method.split(",")[0] for row in rows})
    lines = legend.get_lines()
    looks = {(line.get_linestyle(), line.get_marker(), str(line.get_markerfacecolor())) for line in lines}
    points = [name for name in names if name.startswith("equal")]
    assert len(looks) == len(names) and len(points) <= 1
    if helix_angle:
        stresses = [line.get_ydata()[0] for line in figure.axes[0].get_lines() if line.get_label().startswith("ISO")]
        assert stresses == pytest.approx([row.stress_MPa for row in rows if row.gear == "pinion"])
        assert not any(np.isnan(stresses))


def test_marks_at_one_point_do_not_hide_each_other() -> None:
    """Problem: a spur pair, where both editions and equal shares have a stress at one rotation. Exact: markers of
    different methods differ in size; a smaller one lies above, and only the smallest is filled."""
    figure = root_stress_figure("a pair", [], formulas(0.0))
    marks = [line for line in figure.axes[0].get_lines() if line.get_marker() not in ("None", "")]
    looks = {
        line.get_label(): (line.get_markersize(), line.get_zorder(), str(line.get_markerfacecolor())) for line in marks
    }
    by_size = sorted(looks.values(), reverse=True)
    assert len(by_size) >= 3 and len({size for size, _, _ in by_size}) == len(by_size)
    assert [order for _, order, _ in by_size] == sorted(order for _, order, _ in by_size)
    assert {filled for _, _, filled in by_size[:-1]} == {"none"} and by_size[-1][2] != "none"
