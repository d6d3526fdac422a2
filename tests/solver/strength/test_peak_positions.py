"""Further positions around the largest root stresses of He's pair in plane strain, with friction and without."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.meshing.root_meshes import RootMesh
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import SweptPosition, initial_state, uniform_pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent.strength.peak_positions import NARROWEST, roots_of, with_angles, with_peaks
from tests.support.gear_cases import spur_scene

FRICTIONS, POSITIONS = (0.0, 0.1), 8


@cache
def model() -> GearModel:
    return prepare_model(gear_problem(spur_scene("mesh.level=quick")), MPI.COMM_SELF, RootMesh()).model


@cache
def uniform(positions: int) -> list[SweptPosition]:
    pitch = uniform_pitch(model().pair.pinion.z, positions)
    return one_pitch(list(sweep_until_periodic(model(), pitch, FRICTIONS, initial_state(FRICTIONS), MPI.COMM_SELF)))


def test_intervals_beside_the_peaks_are_narrow() -> None:
    """A hundredth of a pitch or less on both sides of each of the eight largest stresses; those of the uniform
    positions are kept, and no peak falls."""
    before, every = uniform(POSITIONS), with_peaks(model(), uniform(POSITIONS), FRICTIONS, MPI.COMM_SELF)
    angles, pitch = [each.angle for each in every], 2.0 * np.pi / model().pair.pinion.z
    assert set(angles) > {each.angle for each in before}
    assert angles == sorted(angles)
    for both, coarse in zip(roots_of(model(), every), roots_of(model(), before)):
        for own, first in zip(both, coarse):
            side = own.loaded_side
            k = int(np.argmax(side.largest))
            assert np.diff(side.angles[k - 1 : k + 2]).max() <= 1.001 * NARROWEST * pitch
            assert side.largest[k] >= first.loaded_side.largest.max() * (1.0 - 1e-9)
            assert own.back_side.smallest.min() <= first.back_side.smallest.min() * (1.0 - 1e-9)


def test_a_further_position_is_that_of_a_pitch_that_has_it() -> None:
    """Positions midway between eight are those of sixteen: the same torques to 1e-6 and root stress to 1e-4 without
    friction; with it to 2e-3, as the step from the position before is twice as long."""
    fine = uniform(2 * POSITIONS)
    wanted = [each.angle for each in fine[1::2]]
    every = with_angles(model(), uniform(POSITIONS), wanted, FRICTIONS, MPI.COMM_SELF)
    assert np.array([each.angle for each in every]) == pytest.approx(np.array([each.angle for each in fine]), abs=1e-12)
    for index, bound in enumerate((1e-4, 2e-3)):
        for found, exact in zip(roots_of(model(), every)[index], roots_of(model(), fine)[index]):
            stress = exact.loaded_side.largest
            assert np.abs(found.loaded_side.largest - stress).max() < bound * stress.max()


def test_narrow_intervals_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where positions lie closer than the limit already, none are added."""
    monkeypatch.setattr("evolvent.strength.peak_positions.NARROWEST", 1.0 / POSITIONS)
    assert with_peaks(model(), uniform(POSITIONS), FRICTIONS, MPI.COMM_SELF) == uniform(POSITIONS)
