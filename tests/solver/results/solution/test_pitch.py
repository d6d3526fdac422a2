"""A pitch from Python writes and draws itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from PIL import Image

from evolvent.gears import Member, MeshSettings, PitchSolution, condense, solve_pitch
from evolvent.results.solution.pitch_picture import pitch_figure
from evolvent_meshes.errors import InputError
from tests.support.gears_api_curve import he_problem
from tests.support.recorded_tables import columns_of


@pytest.fixture(scope="module")
def pitch() -> PitchSolution:
    """He's pair on first-order cells, eight positions at μ = 0.1."""
    problem = replace(he_problem(), mesh=MeshSettings("quick", order=1))
    return solve_pitch(condense(problem, MPI.COMM_SELF), 0.1, 8, MPI.COMM_SELF)


def test_saved_columns_are_the_curves(pitch: PitchSolution, tmp_path: Path) -> None:
    """Exact: every curve of the pitch in the unit of its column, to the nine digits of the file."""
    table = columns_of(pitch.save(tmp_path / "new" / "pitch.csv"))
    exact = {
        "pinion_angle_deg": np.degrees(pitch.angles), "torque_pinion_Nm": 1e-3 * pitch.torques[:, 0],
        "torque_gear_Nm": 1e-3 * pitch.torques[:, 1], "transmission_error_um": 1e3 * pitch.transmission_error,
        "mesh_stiffness_N_per_um": 1e-3 * pitch.mesh_stiffness, "max_pressure_MPa": pitch.max_pressure,
        "friction": np.full(8, 0.1),
    }
    for name, values in exact.items():
        np.testing.assert_allclose(table[name], values, rtol=1e-8, err_msg=name)
    assert [text == "True" for text in table["tip_edge"].astype(str)] == pitch.tip_edge.tolist()
    assert pitch.tip_edge.any() and not pitch.tip_edge.all()  # of eight positions two bear on a tip edge


def test_the_picture_shows_the_closed_pitch(pitch: PitchSolution, tmp_path: Path) -> None:
    """A curve a panel over nine places, of which the last is the first one a pitch later; hollow marks at tip edges."""
    with Image.open(pitch.plot(tmp_path / "pitch.png")) as image:
        assert image.format == "PNG" and image.width > 1000
    figure = pitch_figure(pitch.rows)
    assert len(figure.axes) == 3
    for axes, values in zip(figure.axes, (1e3 * pitch.transmission_error, 1e-3 * pitch.mesh_stiffness)):
        curve, hollow = axes.lines
        x, y = (np.asarray(each) for each in curve.get_data())
        np.testing.assert_allclose(x, 7.2 / 8 * np.arange(9), atol=1e-12)
        np.testing.assert_allclose(y, [*values, values[0]], rtol=1e-12)
        np.testing.assert_allclose(np.asarray(hollow.get_xdata()), x[:8][pitch.tip_edge])


def test_pitch_of_a_driving_wheel(pitch: PitchSolution) -> None:
    """The wheel drives under the same torque on the pinion, which is the output now. Exact: rotations ascend as before;
    the input on the wheel exceeds it by the loss, 0.1 % of it; the loss is that of the driving pinion within 3 %."""
    problem = replace(he_problem(), mesh=MeshSettings("quick", order=1), driving=Member.WHEEL)
    wheel = solve_pitch(condense(problem, MPI.COMM_SELF), 0.1, 8, MPI.COMM_SELF)
    assert np.array_equal(wheel.angles, pitch.angles)
    output, given = wheel.torques.sum(axis=0)
    assert (given - output) / given == pytest.approx(wheel.loss_ratio, abs=1e-3)
    assert wheel.loss_ratio == pytest.approx(pitch.loss_ratio, rel=0.03) and wheel.loss_ratio > 5e-3
    assert wheel.transmission_error != pytest.approx(pitch.transmission_error, rel=1e-3)


def test_gear_that_drives_is_a_member() -> None:
    """A name is refused with the gears that there are."""
    with pytest.raises(InputError, match="driving"):
        replace(he_problem(), driving="wheel")  # type: ignore[arg-type]


def test_other_endings_are_refused(pitch: PitchSolution, tmp_path: Path) -> None:
    """InputError says which name would do; nothing is written."""
    with pytest.raises(InputError, match=r"ends in \.csv, found .*pitch\.xlsx'; write .*pitch\.csv"):
        pitch.save(tmp_path / "pitch.xlsx")
    with pytest.raises(InputError, match=r"ends in \.png"):
        pitch.plot(tmp_path / "pitch")
    assert list(tmp_path.iterdir()) == []
