"""The named points along contact lines: those that exist, each with its meaning, none on top of another."""

from __future__ import annotations

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from evolvent.results.drawing.style import styled
from evolvent.results.figures.lines import (
    PATH_POINTS,
    label_rows,
    line_pressure_over_z,
    path_points,
    points_over_friction,
)
from evolvent.results.run_data import RunData
from tests.support.synthetic_run import synthetic_run


@pytest.fixture(scope="module")
def run() -> RunData:
    """Yang's helical pair, total contact ratio 3.0."""
    return synthetic_run("contact.friction=[0.0, 0.1, 0.2]")


def below(figure: Figure) -> str:
    """What stands at the foot."""
    assert figure._supxlabel is not None
    return str(figure._supxlabel.get_text())


def test_points_that_exist_are_named(run: RunData) -> None:
    """Exact: with a total contact ratio of 2 or more a single pair never bears, so there are no points B and D; 06 and
    07 name the points that they draw and no others."""
    assert run.pair.transverse_contact_ratio < 2.0 < run.pair.total_contact_ratio
    assert [name for name, _ in path_points(run.pair)] == ["A", "C", "E"]
    with styled():
        lines, friction = line_pressure_over_z(run), points_over_friction(run)
    drawn = {text.get_text() for axes in lines.axes for text in axes.texts}
    named = {text.get_text() for text in friction.axes[0].get_legend().get_texts()}
    assert {"AC", "C", "CE"} <= named
    for figure, names in ((lines, drawn), (friction, named)):
        assert names and {part.split(":")[0] for part in below(figure).split("\n")[0].split("; ")[:-1]} == names
        assert names <= set(PATH_POINTS) and "single pair" not in below(figure)


def test_labels_do_not_overlap(run: RunData, monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: five points along a line within a twentieth of the face, as on a steep line. Exact: their letters do not
    meet; places far apart share the first row."""
    near = [(name, 0.01 * run.pair.face_width * k) for k, name in enumerate("ABCDE")]
    monkeypatch.setattr("evolvent.results.figures.lines._marks", lambda *_: near)
    with styled():
        figure = line_pressure_over_z(run)
        FigureCanvasAgg(figure).draw()
    for axes in figure.axes:
        boxes = [text.get_window_extent() for text in axes.texts]
        assert len(boxes) == 5
        assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])
    assert label_rows([0.0, 5.0, 10.0], 1.0) == [0, 0, 0]
    assert label_rows([0.0, 0.5, 0.9, 1.2], 1.0) == [0, 1, 2, 0]


def test_points_of_the_path() -> None:
    """He's pair: A and E at the tips, ε_α p_bt apart, C the pitch point; from B to D a single pair bears, so that they
    are (2 − ε_α) p_bt apart. Zhang's pair, whose contact ratio is above 2, has no single pair contact."""
    pair = synthetic_run(file="demos/he2022.toml").pair
    at, pitch = dict(path_points(pair)), pair.pinion.transverse_base_pitch
    assert list(at) == ["A", "B", "C", "D", "E"] and at["C"] == 0.0
    assert at["E"] - at["A"] == pytest.approx(1.7547 * pitch, rel=1e-4)
    assert at["D"] - at["B"] == pytest.approx((2.0 - 1.7547) * pitch, rel=1e-3)
    assert [name for name, _ in path_points(synthetic_run(file="demos/zhang2023.toml").pair)] == ["A", "C", "E"]
