"""Pictures of a study: which there are, and what they draw."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from evolvent.run.study.figures.all import study_pictures
from evolvent.run.study.figures.curves import curves_figure
from evolvent.run.study.figures.heat_map import grid_of, map_figure
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


def test_parallel_lines_are_of_complete_scenes() -> None:
    """Two of three scenes have all figures; texts are an axis, too."""
    figure = parallel_figure(THREE, ["peak_MPa", "mean_MPa"])
    (lines,) = figure.axes[0].collections
    assert len(lines.get_segments()) == 2  # type: ignore[attr-defined]
    assert [tick.get_text() for tick in figure.axes[0].get_xticklabels()] == [
        "torque [N·m]", "misalignment [µm]", "level", "peak [MPa]", "mean [MPa]"
    ]  # fmt: skip
