"""K_Hβ by Method C, and the table of docs/evidence.md."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from evidence.benchmarks.accuracy import face_load
from evidence.benchmarks.accuracy.face_load import TABLE, TILTING, method_c
from evidence.checkout import DOCS
from evolvent_meshes.arrays import Floats

SLICES = (np.arange(20_000) + 0.5) / 20_000 - 0.5


@pytest.mark.parametrize("misalignment", [5.0, 20.0, 33.3, 60.0, 200.0])
def test_method_c_is_a_tilt_on_springs(misalignment: float) -> None:
    """Problem: slices on springs of 16 N/(mm µm) that can only be pressed, under 266.7 N/mm, tilted by some µm over the
    face. Exact: the approach that balances the load; the largest slice over the mean. To the thickness of a slice."""
    stiffness, load = 16.0, 266.7

    def pressed(approach: float) -> Floats:
        return np.maximum(approach + misalignment * SLICES, 0.0) * stiffness

    approach = float(brentq(lambda x: pressed(x).mean() - load, -misalignment, load / stiffness + misalignment))
    assert method_c(misalignment, stiffness, load) == pytest.approx(pressed(approach).max() / load, rel=1e-3)


def test_stiffness_against_tilting() -> None:
    """c_γβ = 14.84512 for c_γα = 17.46485 N/(mm µm) in example 1 of ISO/TR 6336-30:2017, all digits."""
    assert pytest.approx(14.84512, abs=1e-5) == TILTING * 17.46485


def test_table_holds_what_the_page_says() -> None:
    """The standard's stiffness is the lowest, that under an even load lies between, that against tilting is the
    highest; the factor of the cycle lies between those of its positions, and above Method C's."""
    rows = TABLE.read(DOCS / face_load.FILE)
    standard, uniform, tilting, lowest, highest, cycle = rows
    assert standard.stiffness < uniform.stiffness < tilting.stiffness
    assert standard.factor < uniform.factor < tilting.factor
    assert lowest.factor < cycle.factor < highest.factor
    assert standard.factor < cycle.factor < tilting.factor
    gained = tilting.factor - uniform.factor
    assert gained > uniform.factor - standard.factor  # coupling is most of the difference
