"""A block flies against a block: what is read of a course, and both programs on a coarse mesh."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from evidence.benchmarks.blow.calculix import by_calculix, read_course
from evidence.benchmarks.blow.comparison import Case, frequency_difference
from evidence.benchmarks.blow.problem import ALL, SPEED, STEEL, WINDOW, Blow, ForceCourse, anvil, by_evolvent, hammer

COARSE = Blow(5e-8, 130, (hammer(4), anvil(4)))
PRINTED = """
 statistics for slave set S0, master set S1 and time  0.5000000E-07

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

    1.000000E+00 -2.500000E+02  0.000000E+00  0.000000E+00  0.000000E+00  0.000000E+00

   center of gravity and mean normal

             NaN           NaN           NaN           NaN           NaN           NaN

 total kinetic energy for set E0 and time  0.5000000E-07

        1.000000E-01

 total internal energy for set E0 and time  0.5000000E-07

        2.000000E-02

 total kinetic energy for set E1 and time  0.5000000E-07

        3.000000E-03

 total internal energy for set E1 and time  0.5000000E-07

        4.000000E-04
"""


def test_figures_of_a_rectangular_pulse() -> None:
    """100 N/mm for 40 steps of 50 ns from 1 µs on: its begin, end, impulse and mean, exact."""
    force = np.zeros(100)
    force[20:60] = 100.0
    course = ForceCourse(5e-8, force, 1.0)
    assert course.contact == pytest.approx((1.05e-6, 3e-6))
    assert course.impulse == pytest.approx(2e-4)
    assert course.mean.max() == pytest.approx(100.0)
    assert np.count_nonzero(course.mean > 50.0) * 5e-8 == pytest.approx(2e-6, abs=WINDOW / 5)
    assert course.difference(ForceCourse(5e-8, 2.0 * force, 1.0)) == pytest.approx(0.5)


def test_what_calculix_prints_is_read() -> None:
    """The force of a step and the four energies after it."""
    course = read_course(PRINTED, COARSE)
    assert course.force.tolist() == [250.0]
    assert course.energy == pytest.approx(0.1234 / (0.5 * STEEL.density * 40.0 * SPEED**2))


def test_a_run_that_stops_is_said() -> None:
    """A course with fewer steps than were asked for has a note and no numbers."""
    course = ForceCourse(5e-8, np.zeros(3), 1.0)
    row = Case("CalculiX", "", course, course, 4).row
    assert row.note == "stops after 0.15 µs"
    assert np.isnan(row.impulse)


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_calculix_gets_the_same_blow(tmp_path: Path) -> None:
    """Cells of 1 mm: natural frequencies to 1e-5, impulse within 1 %, largest mean force within 2 %. At single times
    the mean forces differ more, as cells of that size vibrate within the mean's window."""
    assert frequency_difference(COARSE, 4, tmp_path) < 1e-5
    ours, theirs = by_evolvent(COARSE, ALL), by_calculix(COARSE, 1e6, tmp_path)
    assert theirs.impulse == pytest.approx(ours.impulse, rel=0.01)
    assert theirs.mean.max() == pytest.approx(ours.mean.max(), rel=0.02)
