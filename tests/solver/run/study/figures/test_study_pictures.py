"""Pictures of a study: which there are, and what they draw."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from evolvent.results.drawing.labels import heading, label
from evolvent.run.study.figures.all import study_pictures
from evolvent.run.study.figures.curves import curves_figure
from evolvent.run.study.figures.heat_map import cell_texts, grid_of, map_figure
from evolvent.run.study.figures.parallel_coordinates import parallel_figure
from evolvent.run.study.figures.study_values import StudyValues
from evolvent.run.study.results.study_table import TableRow

COLUMNS = ["peak_MPa", "peak_MPa_error", "mean_MPa", "error_um"]


def values(
    keys: Sequence[tuple[str, ...]], points: Sequence[Sequence[object]], is_sampled: bool = False
) -> StudyValues:
    """A study whose figures are the sum of the numbers of a scene's parameters; the last scene has failed."""
    names = [name for key in keys for name in key]
    rows = []
    for number, point in enumerate(points):
        total = float(sum(value for value in point if isinstance(value, (int, float))))
        found = {"peak_MPa": total, "peak_MPa_error": 0.1, "mean_MPa": 0.5 * total, "error_um": 1.0}
        done = number < len(points) - 1
        rows.append(TableRow(dict(zip(names, point)), found if done else {}, "done" if done else "failed", "", "", 1.0))
    return StudyValues("a study", keys, rows, COLUMNS, is_sampled)


ONE = values([("load.torque_Nm",)], [(300.0,), (100.0,), (200.0,), (400.0,)])
TWO = values([("load.torque_Nm",), ("pair.misalignment_um",)], [(t, m) for t in (2.0, 1.0) for m in (0.0, 5.0, 9.0)])
THREE = values(
    [("load.torque_Nm",), ("pair.misalignment_um",), ("mesh.level",)],
    [(1.0, 0.0, "quick"), (2.0, 5.0, "fine"), (3.0, 1.0, "quick")],
)
SAMPLED = values([("load.torque_Nm",), ("pair.misalignment_um",)], [(1.0, 2.0), (3.0, 4.0), (5.0, 6.0)], True)


@pytest.mark.parametrize(
    ("study", "names"),
    [
        (ONE, ["curves_MPa.png", "curves_um.png"]),
        (TWO, ["map_peak_MPa.png", "map_mean_MPa.png", "map_error_um.png"]),
        (THREE, ["parallel_coordinates.png"]),
        (SAMPLED, ["parallel_coordinates.png"]),
    ],
)
def test_pictures_follow_the_parameters(study: StudyValues, names: list[str]) -> None:
    """A picture a unit, a map a figure, one for all; a figure whose name has "error" in it is no error bar. All are
    drawn."""
    pictures = study_pictures(study)
    assert [each.name for each in pictures] == names
    assert min(len(each.draw()) for each in pictures) > 10_000


def test_no_picture_without_a_figure() -> None:
    """No scene is done."""
    assert study_pictures(values([("load.torque_Nm",)], [(1.0,)])) == []


def test_curves_ascend() -> None:
    """Points in the order of the parameter, with a gap where the last scene has failed; error bars where they are
    known."""
    (axes,) = curves_figure(ONE, ["peak_MPa", "mean_MPa"]).axes
    lines = [line for line in axes.get_lines() if len(line.get_xdata()) == 4]
    assert list(lines[0].get_xdata()) == [100.0, 200.0, 300.0, 400.0]
    assert list(lines[0].get_ydata())[:3] == [100.0, 200.0, 300.0] and math.isnan(list(lines[0].get_ydata())[3])
    assert axes.get_xlabel() == "torque [N·m]" and axes.get_ylabel() == "[MPa]"


def test_map_has_a_cell_a_scene() -> None:
    """Torques along, ascending though the study has them descending; the last scene, the lightest torque at the largest
    misalignment, has no value and is hatched."""
    grid = grid_of(TWO, "peak_MPa")
    assert grid[:2].tolist() == [[1.0, 2.0], [6.0, 7.0]] and np.isnan(grid[2, 0]) and grid[2, 1] == 11.0
    axes = map_figure(TWO, "peak_MPa").axes[0]
    assert [text.get_text() for text in axes.texts] == ["1", "2", "6", "7", "11"]
    assert len(axes.patches) == 1 and axes.patches[0].get_hatch() == "///"
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["1", "2"]


def test_map_says_where_a_figure_is_least_and_largest() -> None:
    """With the numbers of the cells, and the units of the axes; a minus is U+2212. An axis without a unit is named."""
    points = [(t, m) for t in (2.0, 1.0) for m in (-5.0, 9.0)]
    figure = map_figure(values([("load.torque_Nm",), ("pair.misalignment_um",)], [*points, (9.0, 9.0)]), "peak_MPa")
    assert [text.get_text() for text in figure.texts[:2]] == [
        "Peak [MPa]", "a study. Least −4 at 1 N·m and −5 µm, largest 11 at 2 N·m and 9 µm."
    ]
    assert [tick.get_text() for tick in figure.axes[0].get_yticklabels()] == ["−5", "9"]
    named = values([("pinion.profile_shift",), ("mesh.level",)], [(0.5, "fine"), (1.0, "quick"), (2.0, "quick")])
    said = map_figure(named, "peak_MPa").texts[1].get_text()
    assert "least 0.50 at pinion profile shift 0.5 and level fine, largest 1.00 at" in said.lower()


@pytest.mark.parametrize(
    ("numbers", "texts"),
    [
        ([1.0821, 1.2, 1.35, math.nan], ["1.08", "1.20", "1.35", ""]),
        ([1318.4, 995.2, 1204.0], ["1318", "995", "1204"]),
        ([12345.6, 9876.5], ["12346", "9876"]),
        ([-0.0123, 0.0456], ["−0.0123", "0.0456"]),
        ([0.0012, 3.4], ["0.0012", "3.4"]),
        ([3.0, -2.0], ["3", "−2"]),
    ],
)
def test_numbers_of_a_map_have_the_same_decimals(numbers: list[float], texts: list[str]) -> None:
    """Three digits of the largest one and no power of ten below 1000 times the least; whole numbers stay whole."""
    assert cell_texts(np.array([numbers])) == [texts]


def test_face_load_factor_has_its_symbol() -> None:
    """Behind its name, in titles and at colour bars; a title begins with a capital."""
    assert heading(label("face_load_factor")) == "Face load factor K_Hβ"
    assert label("pinion.tension_MPa") == "pinion tension [MPa]"


def test_parallel_lines_are_of_complete_scenes() -> None:
    """Two of three scenes have all figures; texts are an axis, too."""
    figure = parallel_figure(THREE, ["peak_MPa", "mean_MPa"])
    (lines,) = figure.axes[0].collections
    assert len(lines.get_segments()) == 2  # type: ignore[attr-defined]
    assert [tick.get_text() for tick in figure.axes[0].get_xticklabels()] == [
        "torque [N·m]", "misalignment [µm]", "level", "peak [MPa]", "mean [MPa]"
    ]
