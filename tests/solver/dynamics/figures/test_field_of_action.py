"""What the animation of transient contact shows, of a synthetic run: Hertz pressure of an even line load."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from PIL import Image

from evolvent.dynamics.figures.field_of_action import FieldOfAction
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.results.transient.cases import CasePressures, TransientCase
from evolvent.dynamics.transient.divided_steps import StepsTaken
from evolvent.dynamics.transient.pair_transient import PairMoment
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.dynamics.transient.step_balance import Residuals, StepEnergies
from evolvent.gears.pressure.line_peaks import has_peak, pooled_peaks
from evolvent.gears.pressure.pitch_pressure import PitchPressure
from tests.support.synthetic_run import synthetic_run

ONE = StepsTaken(1, 0, 1.0, 0.0, 1.0, 1.0, 0.0)
FILES = ["demos/yang2022.toml", "demos/he2022.toml"]


def field(file: str) -> FieldOfAction:
    """Forces from 2 to 3 N under a load of 2 N."""
    run = synthetic_run(file=file)
    results = [position[0].result for position in run.positions]
    forces, nothing = np.linspace(2.0, 3.0, len(results)), (0.0,) * 5
    moments = tuple(
        PairMoment(0.0, result, float(force), 0.0, Residuals(*nothing), StepEnergies(*nothing, 0.0, 0.0), ONE)
        for result, force in zip(results, forces)
    )
    periods = MeshPeriods(moments, np.zeros(len(moments)), np.zeros(1), 0.005, Residuals(*nothing), 0.0)
    still = PitchPressure(run.pair, tuple(position[0].cut for position in run.positions), run.inner_path)
    case = TransientCase(MeshSpeed(1500.0, run.pair.pinion.z), run.frictions[0], periods, tuple(results), 2.0)
    return FieldOfAction(run.scene.title, run.pair, CasePressures(case, still, still))


def words(figure: Figure) -> str:
    """Beside the panels."""
    return " ".join(text.get_text() for text in figure.texts)


@pytest.mark.parametrize("file", FILES)
def test_lines_lie_where_the_slices_are(file: str) -> None:
    """A stroke for each slice, about its roll distance and height, with its peak pressure; strokes are parallel to the
    contact line: ξ grows by tan β_b a millimetre of face on a right-hand pinion."""
    drawn = field(file)
    for k, cut in enumerate(drawn.pressures.moving.cuts):
        axes = drawn.figure(k).axes[0]
        (lines,) = [each for each in axes.collections if isinstance(each, LineCollection)]
        ends = np.array(lines.get_segments())
        np.testing.assert_allclose(ends.mean(axis=1), np.column_stack([cut.roll_distance, cut.z]), atol=1e-9)
        along = ends[:, 1] - ends[:, 0]
        slope = drawn.pair.pinion.hand * np.tan(drawn.pair.pinion.base_helix_angle)
        np.testing.assert_allclose(along[:, 0], slope * along[:, 1], atol=1e-9)
        known = has_peak(cut)
        values = np.asarray(lines.get_array())
        np.testing.assert_allclose(values[known], pooled_peaks(cut)[known])
        assert values.max() <= drawn.top or not known.all()


def test_force_has_a_dot_at_the_position() -> None:
    """The dot climbs with the force, from 1 to 1.5 times the load."""
    drawn = field(FILES[0])
    assert drawn.force[[0, -1]].tolist() == [1.0, 1.5]
    for k, force in enumerate(drawn.force):
        dot = drawn.figure(k).axes[1].lines[1]
        assert np.asarray(dot.get_ydata()).tolist() == [force]


def test_the_foot_names_what_is_drawn() -> None:
    """Zones of 1 mm at both tip edges: both are grey, and the foot says so. Relieved tips, without zones: no grey, and
    not a word of it. Blue is named where a slice lies above the scale alone."""
    drawn = field(FILES[1])
    path, still = drawn.pair.path_of_contact, drawn.pressures.still

    def with_inner(path: tuple[float, float]) -> FieldOfAction:
        own = replace(still, inner_path=path)
        return replace(drawn, pressures=CasePressures(drawn.pressures.case, own, own))

    for each, count in ((with_inner((path[0] + 1.0, path[1] - 1.0)), 2), (with_inner(path), 0)):
        figure = each.figure(0)
        foot = words(figure)
        assert len(figure.axes[0].patches) == count
        assert ("grey" in foot) == bool(count)
        assert ("blue" in foot) == each.is_above
    loud = replace(drawn, pressures=replace(drawn.pressures, moving=replace(still, cuts=tuple(
        replace(cut, largest=np.full(len(cut.largest), 1e6), peak=np.full(len(cut.largest), np.nan))
        for cut in still.cuts))))
    assert loud.is_above and "blue" in words(loud.figure(0))


def test_animation_has_a_frame_a_position() -> None:
    """As many frames as positions, which repeat for ever."""
    drawn = field(FILES[1])
    with Image.open(io.BytesIO(drawn.animation())) as image:
        assert getattr(image, "n_frames", 1) == len(drawn.force)
        assert image.info["loop"] == 0
