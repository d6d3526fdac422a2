"""The picture of bodies in the axial section: outline and held bore lie where the gear has them."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.results.drawing.axial_section import body_outline
from evolvent.results.drawing.tooth_form import tooth_form_figure
from evolvent.scene.scene import scene_from_text
from evolvent_meshes.arrays import Floats
from tests.support.scene_texts import HE

WEB = "wheel.rim_thickness_mm=10", "wheel.web_thickness_mm=6", "wheel.web_offset_mm=2"
HUB = "wheel.hub_diameter_mm=90", "wheel.support_width_mm=8"


def area(outline: Floats) -> float:
    """Of a polygon (n, 2)."""
    x, y = outline.T
    return 0.5 * abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)))


@pytest.mark.parametrize(("keys", "exact", "held"), [
    ((), 20.0 * 36.25, (-10.0, 10.0)), (WEB, 20.0 * 10.0 + 6.0 * 26.25, (-1.0, 5.0)),
    ((*WEB, *HUB), 20.0 * 10.0 + 6.0 * 16.25 + 20.0 * 10.0, (-4.0, 4.0)),
])
def test_outline_has_the_area_of_rim_web_and_hub(
    keys: tuple[str, ...], exact: float, held: tuple[float, float]
) -> None:
    """He's wheel, b = 20, d_f = 142.5, bore 70 mm: exact, by hand; a thick line along the held part of the bore."""
    pair = scene_from_text(HE, ["pinion.support_width_mm=10", *keys]).gear_pair()
    assert area(body_outline(pair.wheel)) == pytest.approx(exact, rel=1e-12)
    line = tooth_form_figure("He", pair).axes[3].lines[0]
    assert tuple(line.get_xdata()) == pytest.approx(held)
    assert tuple(line.get_ydata()) == (35.0, 35.0)


def test_bodies_are_drawn_where_they_are_no_plain_rings() -> None:
    """Without rim, web and partial support there are the two teeth alone."""
    assert len(tooth_form_figure("He", scene_from_text(HE).gear_pair()).axes) == 2
