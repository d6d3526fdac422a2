"""Pictures: that each is drawn, says what to see with true numbers, and that the loaded pair shows its pressure."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.text import Text
from PIL import Image

from evolvent.commands.app import Exit, main
from evolvent.results.drawing.offscreen import off_screen
from evolvent.results.drawing.style import PRESSURE_MAP, friction_colours, sheet, styled
from evolvent.results.engagement import engagement, engagements
from evolvent.results.figures.all import figures, pictures
from evolvent.results.figures.drive import even_share, line_load, load_sharing
from evolvent.results.figures.flank import pressure_map
from evolvent.results.figures.stress import engagement_stress, running_median, smoothed, tooth_stress
from evolvent.results.mesh_facts import few_cells_across
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.run.kinds.redraw import plot_folder
from evolvent.scene.plain_text import signed
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from tests.support.run_parts import store
from tests.support.synthetic_run import synthetic_run


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


def test_nothing_reaches_over_the_rim(run: RunData) -> None:
    """Of every figure the outermost two points are white: nothing is clipped there."""
    with styled():
        for name, draw in figures(run):
            figure = draw(run)
            canvas = FigureCanvasAgg(figure)
            canvas.draw()
            margin = round(2.0 * figure.dpi / 72.0)
            pixels = np.asarray(canvas.buffer_rgba())[..., :3].copy()
            pixels[margin:-margin, margin:-margin] = 255
            assert (pixels == 255).all(), name


def test_pictures_name_the_same_largest_pressure(run: RunData) -> None:
    """What summary.json has as the largest pressure without friction stands in each picture that names one."""
    wanted = f"{friction_rows(run)[0].max_pressure_MPa:.0f}"
    with styled():
        for name, draw in figures(run):
            if name in ("02_flank_pressure", "03_stress_over_engagement", "10_hertz"):
                assert wanted in " ".join(text.get_text() for text in draw(run).findobj(Text)), name


@pytest.mark.evidence
@pytest.mark.slow
def test_pictures_of_a_directory(run: RunData, tmp_path: Path) -> None:
    """A run on disk is drawn whole: all figures, the pair and an animation of as many frames as positions."""
    store(run, tmp_path)
    (tmp_path / "summary.json").touch()
    drawn = plot_folder(tmp_path)
    assert not drawn.failures
    names = sorted(path.name for path in (tmp_path / "pictures").iterdir())
    assert names == sorted(path.name for path in drawn.written)
    assert len(names) == 13
    with Image.open(tmp_path / "pictures" / "animation.gif") as film:
        assert film.n_frames == len(run.positions)
    with Image.open(tmp_path / "pictures" / "01_loaded_pair.png") as picture:
        assert picture.size[0] > 1500


def test_plot_draws_what_a_run_did_not(tmp_path: Path) -> None:
    """A run without pictures, drawn afterwards: all figures and the pair are there; no animation, which was not asked
    for."""
    silent = synthetic_run("contact.friction=0.1", "output.pictures=false", "output.animation=false")
    store(silent, tmp_path)
    assert main(["plot", str(tmp_path)]) == Exit.BAD_INPUT  # not finished
    (tmp_path / "summary.json").touch()
    assert main(["plot", str(tmp_path)]) == Exit.DONE
    names = {path.name for path in (tmp_path / "pictures").iterdir()}
    assert "01_loaded_pair.png" in names and "10_hertz.png" in names and "animation.gif" not in names


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
    """Rendered with the wheel hidden, the contact lines' colours (towards red) appear, and blue of the pinion; at
    a colour scale a hundred times larger no red is left."""
    from evolvent.results.figures.scene3d import gear_picture

    result = run.positions[0][0].result
    with off_screen():
        pictures = (gear_picture(run, result, Member.PINION, top, (320, 240)) for top in (2500.0, 250000.0))
        loaded, faint = (picture.astype(float) for picture in pictures)
    assert _red(loaded) > 40
    assert _red(faint) == 0
    blue = (loaded[..., 2] > loaded[..., 0] + 20).mean()
    assert blue > 0.1


def _red(image: Floats) -> int:
    return int((image[..., 0] > image[..., 2] + 70).sum())


def test_a_tooth_takes_up_load_from_nothing() -> None:
    """Exact: each curve of load sharing begins and ends at 0; He's rigid pair jumps from 50 to 100 % within a five
    hundredth of a pitch, where a single pair begins to bear."""
    he = synthetic_run(file="demos/he2022.toml")
    with styled():
        lines = load_sharing(he).axes[0].lines
    for line in lines:
        assert line.get_ydata()[0] == 0.0 == line.get_ydata()[-1]
    angle, share = even_share(he)
    jump = int(np.argmax(np.diff(share)))
    assert share[jump + 1] - share[jump] == pytest.approx(0.5)
    assert angle[jump + 1] - angle[jump] < he.pitch / 500.0


def texts_of(run: RunData) -> dict[str, str]:
    """All that is written in each figure."""
    with styled():
        return {name: " ".join(text.get_text() for text in draw(run).findobj(Text)) for name, draw in figures(run)}


def test_pairs_and_points_have_their_own_names(run: RunData) -> None:
    """Tooth pairs have their numbers of teeth.csv in all pictures, points the names of ISO 21771:2007; a published
    study's are in none."""
    texts = texts_of(run)
    for name, text in texts.items():
        assert not any(word in text for word in ("Eq. 4", "1788", "tooth 1", "tooth 2", "tooth 3")), name
    assert "pair 0 (at the pitch point, φ = 0)" in texts["04_stress_of_teeth"]
    assert "pair −1" in texts["06_pressure_along_lines"]
    assert "points of the path of contact" in texts["07_points_over_friction"]


def test_labels_are_not_clipped_nor_crossed(run: RunData) -> None:
    """In the map of the envelope every contour's label lies within its axes; what is above the scale has a colour of
    its own, which the bar shows. In 03 no word lies on the line at 0; in 12 the legend of sliding meets neither
    curve."""
    with styled():
        figure = pressure_map(run)
        FigureCanvasAgg(figure).draw()
        inside = figure.axes[0].get_window_extent()
        labels = [text.get_window_extent() for text in figure.axes[0].texts]
        assert labels and all(inside.x0 < box.x0 and box.x1 < inside.x1 for box in labels)
        assert figure.axes[-1]._colorbar.extend == "max"
        assert tuple(PRESSURE_MAP(2.0)) != tuple(PRESSURE_MAP(1.0))
        figure = engagement_stress(run)
        FigureCanvasAgg(figure).draw()
        main, x = figure.axes[0], figure.axes[0].transData.transform((0.0, 0.0))[0]
        area = main.get_window_extent()
        boxes = [text.get_window_extent() for text in main.findobj(Text) if text.get_text()]
        assert not any(box.x0 < x < box.x1 and area.y0 < box.y0 and box.y1 < area.y1 for box in boxes)
        figure = line_load(run)
        FigureCanvasAgg(figure).draw()
        lower = figure.axes[1]
        box = lower.get_legend().get_window_extent()
        for line in lower.lines[:2]:
            assert not any(box.contains(*point) for point in lower.transData.transform(line.get_xydata()))


def test_notes_stand_below(run: RunData) -> None:
    """What one has to know to read a figure stands below it in one size, and nothing above the axes but their titles;
    beside a difference that a coarse mesh makes stands that it is for orientation only."""
    with styled():
        drawn = {name: draw(run) for name, draw in figures(run)}
    below = [f._supxlabel for f in drawn.values() if f._supxlabel is not None]
    assert len(below) >= 4 and len({text.get_fontsize() for text in below}) == 1
    assert all(text.get_text().endswith(".") for text in below)
    assert not any(ax.get_title(loc="left") for f in drawn.values() for ax in f.axes)
    assert "For orientation only" in drawn["10_hertz"].texts[1].get_text()


def test_sentence_has_the_changes_that_are_drawn(run: RunData) -> None:
    """Problem: at one of six positions the peaks with friction are 20 % too high, as a coarse mesh makes them. 04 draws
    curves without it, and its sentence has their least and largest changes."""
    first, second, *rest = run.positions
    spoilt = replace(second[2], cut=replace(second[2].cut, peak=1.2 * second[2].cut.peak))
    with styled():
        figure = tooth_stress(replace(run, positions=(first, (*second[:2], spoilt), *rest)))
    for axes in figure.axes[len(figure.axes) // 2 :]:
        changes = axes.lines[-1].get_ydata()
        wanted = f"by {signed(float(np.nanmin(changes)))} to {signed(float(np.nanmax(changes)))} %"
        assert wanted in figure.texts[1].get_text()


def test_median_where_the_contact_is_not_resolved(run: RunData) -> None:
    """Problem: quick, with 1.7 elements across: points and their median are drawn, and said. Exact: of a constant with
    every third point lifted that constant, but for the ends; of a straight line itself; NaN stays NaN."""
    assert few_cells_across(run)
    with styled():
        words = " ".join(text.get_text() for text in engagement_stress(run).findobj(Text))
    assert "elements across the contact: points as computed; lines: Hertz for the same loads" in words
    line = np.arange(12.0)
    assert not running_median(np.where(line % 3 == 1, 100.0, 0.0))[2:-2].any()
    holes = running_median(np.concatenate([[np.nan], line, [np.nan]]))
    np.testing.assert_array_equal(holes[1:-1], line)
    assert np.isnan(holes[[0, -1]]).all()


def test_a_single_pair_is_not_smoothed_away() -> None:
    """Problem: a spur pair at quick, whose load is twice as high while a single pair bears, at one of four positions,
    with Hertz's pressure. Exact: smoothing leaves that curve as it is; a plain running median would halve its peak."""
    pair = synthetic_run("sweep.positions=4", file="demos/he2022.toml")
    assert few_cells_across(pair)
    curve, line = engagement(pair, 0), smoothed(pair, engagements(pair))[0]
    known = np.isfinite(curve.max_pressure)
    np.testing.assert_allclose(line.max_pressure[known], curve.max_pressure[known], rtol=0.03)
    assert np.nanmax(running_median(curve.max_pressure)) < 0.9 * np.nanmax(curve.max_pressure)


def test_colours() -> None:
    """The pressure map's lightness falls all the way, so it also reads in grey; more friction is darker, and the least
    stands out from white by three to one (WCAG 2.1, non-text contrast); true minus."""
    grey = PRESSURE_MAP(np.linspace(0.0, 1.0, 200))[:, :3] @ [0.299, 0.587, 0.114]
    assert np.all(np.diff(grey) < 1e-3)
    light, dark = (sum(to_rgb(colour)) for colour in friction_colours([0.05, 0.3]))
    assert light > dark
    for colour in friction_colours(np.linspace(0.0, 0.3, 7).tolist()):
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
        assert 1.05 / (float(np.dot(linear, [0.2126, 0.7152, 0.0722])) + 0.05) > 3.0
    assert signed(-1.25, 2) == "−1.25" and signed(-0.001, 2) == "0.00" and signed(0.004, 2) == "0.00"
    assert sheet("t", "x" * 400).texts[1].get_fontsize() < 8.0
