"""Parameters of a study: their axes, and the values of each scene."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from evolvent.run.study.plan.parameters import axes, combinations
from evolvent.run.study.plan.study_file import load_study
from tests.support.running.study_cases import HEAD, written

HYPERCUBE = """
[latin_hypercube]
samples = 20
seed = 3
[latin_hypercube.ranges]
load.torque_Nm = [100.0, 300.0]
pair.normal_pressure_angle_deg = [16.0, 20.0]
pinion.teeth = [20, 40]
"""


def test_grid_times_list(tmp_path: Path) -> None:
    """A grid of two and two values side by side: four scenes, the list varying fastest."""
    lists = "[list]\npinion.face_width_mm = [20.0, 25.0]\nwheel.face_width_mm = [21.0, 26.0]\n"
    study = load_study(written(tmp_path, f"{HEAD}[grid]\nload.torque_Nm = [1.0, 2.0]\n{lists}"))
    found = [tuple(each.values()) for each in combinations(axes(study))]
    assert found == [(1.0, 20.0, 21.0), (1.0, 25.0, 26.0), (2.0, 20.0, 21.0), (2.0, 25.0, 26.0)]


def test_hypercube_fills_each_interval(tmp_path: Path) -> None:
    """Of 20 samples each twentieth of a range has exactly one; numbers of teeth are whole; the same seed gives the same
    samples, another one others."""
    study = load_study(written(tmp_path, HEAD + HYPERCUBE))
    (axis,) = axes(study)
    torques, angles, teeth = (np.array(column) for column in zip(*axis.rows))
    for values, low, high in ((torques, 100.0, 300.0), (angles, 16.0, 20.0)):
        assert sorted(np.floor(20 * (values - low) / (high - low)).astype(int)) == list(range(20))
    assert all(isinstance(row[2], int) for row in axis.rows) and teeth.min() >= 20 and teeth.max() <= 40
    assert axes(study) == [axis]
    other = load_study(written(tmp_path, HEAD + HYPERCUBE.replace("seed = 3", "seed = 4")))
    assert axes(other) != [axis]
