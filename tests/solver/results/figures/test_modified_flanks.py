"""The topography of modified flanks: which runs have it, and what it shows.

Problem: Yang's pair with tip relief, helix slope and twist of the pinion, root and end relief of the wheel, misaligned.
"""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from evolvent.results.drawing.style import styled
from evolvent.results.figures.all import figures
from evolvent.results.figures.modified_flanks import POINTS, modified_flanks, topography
from evolvent.results.run_data import RunData
from evolvent_meshes.gears.flank import separation
from tests.support.synthetic_run import synthetic_run

NAME = "13_flank_modifications"
MODIFIED = (
    "pinion.tip_relief_um=8", "pinion.helix_slope_um=-4", "pinion.twist_um=6", "wheel.root_relief_um=5",
    "wheel.end_relief_um=6", "pair.misalignment_um=5",
)


@pytest.fixture(scope="module")
def run() -> RunData:
    return synthetic_run("contact.friction=0.1", *MODIFIED)


def test_only_modified_flanks_are_drawn(run: RunData) -> None:
    """A pair without modifications has none to show, misaligned or not."""
    plain = synthetic_run("contact.friction=0.1", "pair.misalignment_um=5")
    assert NAME in dict(figures(run)) and NAME not in dict(figures(plain))
    assert NAME in dict(figures(synthetic_run("wheel.tip_relief_um=5", file="demos/he2022.toml")))


def test_maps_have_the_amounts_at_their_places(run: RunData) -> None:
    """Exact: on the pinion's tip 8 + 3 µm at the end z > 0, 8 + 4 µm at z < 0; on the wheel's root, which meets it,
    5 µm at mid-face and 5 + 6 µm at its ends; the gap is theirs with the misalignment's."""
    ξ, z, depths = topography(run.pair)
    pinion, wheel, gap = depths.values()
    middle = POINTS // 2
    assert pinion[-1, [0, -1]] == pytest.approx([8.0 + 4.0, 8.0 + 3.0], abs=1e-9)
    assert wheel[-1, [0, middle, -1]] == pytest.approx([11.0, 5.0, 11.0], abs=1e-9)
    assert wheel[0, [0, middle, -1]] == pytest.approx([6.0, 0.0, 6.0], abs=1e-9)
    assert gap.min() == 0.0 and gap.shape == (len(ξ), len(z))
    assert np.ptp(gap - 1e3 * separation(run.pair, ξ[:, None], z)) == pytest.approx(0.0, abs=1e-9)


def test_picture_says_how_much_is_taken_off(run: RunData) -> None:
    """The sentence has the largest of each map, one colour scale serves all of them, and nothing is clipped."""
    with styled():
        figure = modified_flanks(run)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
    largest = [float(depth.max()) for depth in topography(run.pair)[2].values()]
    assert all(f"{value:.1f} µm" in figure.texts[1].get_text() for value in largest)
    scales = {ax.collections[0].get_clim() for ax in figure.axes[:3]}
    assert scales == {(0.0, max(largest))}
    pixels = np.asarray(canvas.buffer_rgba())[..., :3].copy()
    pixels[4:-4, 4:-4] = 255
    assert (pixels == 255).all()
