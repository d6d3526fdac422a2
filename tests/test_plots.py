"""Pictures: that each is drawn, says what to see with true numbers, and that the loaded pair shows its pressure."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.text import Text
from PIL import Image
from synthetic_run import synthetic_run
from test_results import store

from solver.display import off_screen
from solver.plain_text import signed
from solver.plots import figures, pictures
from solver.plots_flank import at_point, envelope, paper_points, paper_position
from solver.plots_style import PRESSURE_MAP, friction_colours, sheet, styled
from solver.results import friction_rows
from solver.run_data import RunData
from solver.run_plot import plot_folder


@pytest.fixture(scope="module")
def run() -> RunData:
    return synthetic_run("contact.friction=[0.0, 0.1, 0.2]")


def test_every_figure_has_title_line_units_and_fits(run: RunData) -> None:
    """Each figure has a title and one line below it, in letters that can be read (8 points), and each axis with a label
    names its unit in brackets, unless the quantity has none."""
    bare = ("friction coefficient μ",)
    with styled():
        for name, draw in figures(run):
            figure = draw(run)
            title, see = figure.texts[:2]
            assert title.get_text(), name
            assert see.get_text().endswith("."), name
            assert "nan" not in see.get_text(), name
            assert see.get_fontsize() >= 8.0, (name, len(see.get_text()))
            labels = [text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel())]
            assert any(labels), name
            assert all("[" in text or text in bare for text in labels if text), (name, labels)


def test_pictures_name_the_same_largest_pressure(run: RunData) -> None:
    """What summary.json has as the largest pressure without friction stands in each picture that names one."""
    wanted = f"{friction_rows(run)[0].max_pressure_MPa:.0f}"
    with styled():
        for name, draw in figures(run):
            if name in ("02_flank_pressure", "03_stress_over_engagement", "10_hertz"):
                assert wanted in " ".join(text.get_text() for text in draw(run).findobj(Text)), name


def test_pictures_of_a_directory(run: RunData, tmp_path: Path) -> None:
    """A run on disk is drawn whole: all figures, the pair and an animation of as many frames as positions."""
    store(run, tmp_path)
    drawn = plot_folder(tmp_path)
    assert not drawn.failures
    names = sorted(path.name for path in (tmp_path / "pictures").iterdir())
    assert names == sorted(path.name for path in drawn.written)
    assert len(names) == 13
    with Image.open(tmp_path / "pictures" / "animation.gif") as film:
        assert film.n_frames == len(run.positions)
    with Image.open(tmp_path / "pictures" / "01_loaded_pair.png") as picture:
        assert picture.size[0] > 1500


def test_scene_can_switch_pictures_off() -> None:
    """With both switched off nothing is drawn."""
    silent = synthetic_run("contact.friction=0.1", "output.pictures=false", "output.animation=false")
    assert list(pictures(silent)) == []


@pytest.mark.parametrize("file", ["demos/he2022.toml", "demos/zhang2023.toml"])
def test_other_pairs_are_drawn_as_far_as_they_go(file: str) -> None:
    """A spur pair in 2D and one in 3D with different widths, one coefficient: what needs more is left out."""
    other = synthetic_run(file=file)
    with styled():
        names = [name for name, draw in figures(other) if draw(other)]
    assert "04_stress_of_teeth" not in names
    assert "08_load_sharing" in names
    assert ("02_flank_pressure" in names) == (not other.plane)


def test_loaded_pair_shows_the_pressure(run: RunData) -> None:
    """Rendered with the wheel taken away, the contact lines' colours (towards red) appear, and blue of the pinion; at
    a colour scale a hundred times larger no red is left."""
    from solver.plots3d import gear_picture

    result = run.positions[0][0].result
    with off_screen():
        loaded, faint = (gear_picture(run, result, 0, top, (320, 240)).astype(float) for top in (2500.0, 250000.0))
    assert _red(loaded) > 40
    assert _red(faint) == 0
    blue = (loaded[..., 2] > loaded[..., 0] + 20).mean()
    assert blue > 0.1


def _red(image: np.ndarray) -> int:
    return int((image[..., 0] > image[..., 2] + 70).sum())


def test_envelope_is_hertz_over_the_path(run: RunData) -> None:
    """Exact: with nearly even load the envelope falls from root to tip as the relative radius grows, p0 ∝ R^(−1/2)."""
    ξ = np.linspace(-4.0, 5.0, 40)
    _, peak = envelope(run, 0, ξ)
    mean = np.nanmean(peak, axis=1)
    radius = run.pair.relative_curvature_radius(ξ)
    np.testing.assert_allclose(mean * np.sqrt(radius) / np.mean(mean * np.sqrt(radius)), 1.0, atol=0.03)


def test_points_lie_where_the_paper_says(run: RunData) -> None:
    """A, B, C on the line through the pitch circle: below, at, above it; D on the line near the root. All on the flank
    and under pressure."""
    k = paper_position(run)
    a, b, c, d = paper_points(run, k)
    assert a.ξ < b.ξ == 0.0 < c.ξ
    assert d.ξ < a.ξ
    assert (a.tooth, b.tooth, c.tooth, d.tooth) == (0, 0, 0, -1)
    for point in (a, b, c, d):
        exact = run.pair.roll_distance(run.angles[k], point.tooth, point.z)
        assert float(exact) == pytest.approx(point.ξ, abs=1e-9)
        assert at_point(run.positions[k][0].cut, point) > 1000.0


def test_colours() -> None:
    """The pressure map's lightness falls all the way, so it also reads in grey; more friction is darker; true minus."""
    grey = PRESSURE_MAP(np.linspace(0.0, 1.0, 200))[:, :3] @ [0.299, 0.587, 0.114]
    assert np.all(np.diff(grey) < 1e-3)
    light, dark = (sum(to_rgb(colour)) for colour in friction_colours([0.05, 0.3]))
    assert light > dark
    assert signed(-1.25, 2) == "−1.25"
    assert sheet("t", "x" * 400).texts[1].get_fontsize() < 8.0
