"""Further positions around the largest root stresses of He's pair in plane strain, with friction and without."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.meshing.root_meshes import RootMesh
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import SweptPosition, initial_state, uniform_pitch
from evolvent.results.error_bars.peak_bounds import peak_bounds
from evolvent.scene.gear_problem import gear_problem
from evolvent.strength.peak_positions import (
    GAIN,
    NARROWEST,
    Roots,
    SweptRoots,
    roots_of,
    with_angles,
    with_peaks,
)
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import spur_scene

FRICTIONS, POSITIONS = (0.0, 0.1), 8


@cache
def model() -> GearModel:
    return prepare_model(gear_problem(spur_scene("mesh.level=quick")), MPI.COMM_SELF, RootMesh()).model


@cache
def uniform(positions: int) -> list[SweptPosition]:
    pitch = uniform_pitch(model().pair.pinion.z, positions)
    return one_pitch(list(sweep_until_periodic(model(), pitch, FRICTIONS, initial_state(FRICTIONS), MPI.COMM_SELF)))


def known(positions: int) -> SweptRoots:
    return SweptRoots(uniform(positions), roots_of(model(), uniform(positions)))


def test_no_stress_may_be_higher_beside_the_peaks() -> None:
    """Beside each of the eight largest stresses, either the interval is narrow or the lines from both sides cross less
    than half a per cent higher; uniform positions are kept, no peak falls, and one rises by more than a per cent."""
    before, every = known(POSITIONS), with_peaks(model(), known(POSITIONS), FRICTIONS, MPI.COMM_SELF)
    angles, pitch = [each.angle for each in every.positions], 2.0 * np.pi / model().pair.pinion.z
    assert set(angles) > {each.angle for each in before.positions}
    assert angles == sorted(angles)
    rises = []
    for found, first in zip(peaks(every.roots), peaks(before.roots)):
        rises.append(found[1].max() / first[1].max() - 1.0)
        for each in peak_bounds(*found):
            assert each.height <= (1.0 + GAIN) * found[1].max() or each.width <= NARROWEST * pitch
    assert min(rises) >= 0.0 and max(rises) > 0.01


def test_peaks_are_those_of_many_positions() -> None:
    """Of He's pair with 8 positions and those around the peaks: tension and compression of both gears without friction
    within 0.8 % of 80 uniform positions, which 8 alone miss by up to 1.7 %."""
    every = with_peaks(model(), known(POSITIONS), FRICTIONS, MPI.COMM_SELF)
    misses = {}
    for name, roots in (("alone", known(POSITIONS).roots), ("further", every.roots)):
        pairs = zip(peaks(roots[:1]), peaks(known(10 * POSITIONS).roots[:1]))
        misses[name] = [1.0 - own[1].max() / exact[1].max() for own, exact in pairs]
    assert np.abs(misses["further"]).max() < 0.008
    assert max(misses["alone"]) > 0.015


def peaks(roots: Roots) -> list[tuple[Floats, Floats]]:
    """Rotations and amounts of stress of both sides of both gears."""
    sides = [(own.loaded_side, own.back_side) for both in roots for own in both]
    return [each for a, b in sides for each in ((a.angles, a.largest), (b.angles, -b.smallest))]


def test_a_further_position_is_that_of_a_pitch_that_has_it() -> None:
    """Positions midway between eight are those of sixteen: the same torques to 1e-6 and root stress to 1e-4 without
    friction; with it to 2e-3, as the step from the position before is twice as long."""
    fine = uniform(2 * POSITIONS)
    wanted = [each.angle for each in fine[1::2]]
    every = with_angles(model(), known(POSITIONS), wanted, FRICTIONS, MPI.COMM_SELF)
    stands, exact = (np.array([each.angle for each in positions]) for positions in (every.positions, fine))
    assert stands == pytest.approx(exact, abs=1e-12)
    for index, bound in enumerate((1e-4, 2e-3)):
        for found, best in zip(every.roots[index], roots_of(model(), fine)[index]):
            stress = best.loaded_side.largest
            assert np.abs(found.loaded_side.largest - stress).max() < bound * stress.max()


def test_joined_roots_are_those_of_all_positions() -> None:
    """Stress at positions that were added is that of evaluating all positions together, 1e-12, in order."""
    wanted = [each.angle for each in uniform(2 * POSITIONS)[1::2]]
    every = with_angles(model(), known(POSITIONS), wanted, FRICTIONS, MPI.COMM_SELF)
    for found, exact in zip(peaks(every.roots), peaks(roots_of(model(), every.positions))):
        assert np.array(found) == pytest.approx(np.array(exact), rel=1e-12, abs=1e-9)


def test_narrow_intervals_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where positions lie closer than the limit already, none are added."""
    monkeypatch.setattr("evolvent.strength.peak_positions.NARROWEST", 1.001 / POSITIONS)
    every = with_peaks(model(), known(POSITIONS), FRICTIONS, MPI.COMM_SELF)
    assert every.positions == uniform(POSITIONS)


def test_further_positions_of_a_driving_wheel() -> None:
    """The wheel drives: positions midway between eight, behind the last one too, are those of sixteen, whose history is
    that of the next higher angle, 1e-6 of the wheel's torque without friction; with it 1e-3."""
    gears = replace(model(), load=replace(model().load, driving=Member.WHEEL))

    def pitch(positions: int) -> list[SweptPosition]:
        angles = uniform_pitch(gears.pair.pinion.z, positions, 1, Member.WHEEL)
        state = initial_state(FRICTIONS)
        return one_pitch(list(sweep_until_periodic(gears, angles, FRICTIONS, state, MPI.COMM_SELF)))

    coarse, fine = pitch(POSITIONS), pitch(2 * POSITIONS)
    wanted = [each.angle for each in fine[1::2]]
    assert wanted[-1] > coarse[-1].angle
    every = with_angles(gears, SweptRoots(coarse, roots_of(gears, coarse)), wanted, FRICTIONS, MPI.COMM_SELF)
    for index, bound in enumerate((1e-6, 1e-3)):
        found, exact = ([each.results[index].torques[1] for each in swept] for swept in (every.positions, fine))
        assert found == pytest.approx(exact, rel=bound)
        assert min(each.results[index].friction_loss for each in every.positions) > -1e-9
