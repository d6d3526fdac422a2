"""The mesh force at one speed, under which contact is computed."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Literal

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.dynamics.figures.operation import operation_figure
from evolvent.dynamics.operating_point import LEAST_FORCE, OperatingPoint, Operation
from evolvent.dynamics.operation_figures import OperationFacts, OperationFigures, operation_warnings
from evolvent.dynamics.oscillator.mesh_speed import speeds_to_periods
from evolvent.dynamics.oscillator.response import response
from evolvent.dynamics.oscillator.speed_sweep import sweep_speeds
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.dynamics.results.histories import Motion, history_rows
from evolvent.dynamics.results.tables import excitation_rows
from evolvent.dynamics.under_mesh_force import UnderMeshForce
from evolvent.gears.gear_model import GearModel
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import model_of, spur_scene

INERTIA = 7.65  # t·mm², He et al. 2022
SCENE = spur_scene("mesh.level=quick")
POINT = OperatingPoint(DriveSettings((INERTIA, INERTIA), 0.03, 0.05), 3000.0, "up", (0.25, 1.0, 2.0), 10)


@cache
def model() -> GearModel:
    return model_of(SCENE)


@cache
def operation(speed: float, direction: Literal["up", "down"] = "up") -> Operation:
    point = replace(POINT, speed=speed, direction=direction)
    return point.on(model(), (None, None), MPI.COMM_SELF)


def test_a_slow_pair_is_loaded_by_its_torque() -> None:
    """At 2 r/min inertia does nothing. Exact: the torque itself; what is left are forces of the order of (ω/ω_n)², of
    its harmonics, 1e-3."""
    found = operation(2.0)
    course = found.load.course
    assert course is not None and found.repeats == 1 and found.lifted == 0.0
    assert course.shares == pytest.approx(np.ones(240), abs=1e-3)


def test_mean_force_is_the_load() -> None:
    """Over a mesh period of a steady motion the momentum does not change: the mean of the mesh force, damping included,
    is F_0, 1e-3 by the trapezoidal rule."""
    course = operation(3000.0).load.course
    assert course is not None
    assert course.shares.mean() == pytest.approx(1.0, abs=1e-3)
    assert np.ptp(course.shares) > 0.2


def test_motion_is_that_of_the_sweep_over_the_speed() -> None:
    """Problem: a speed at which running up and down differ. Exact: the motions of `sweep_speeds` there, its last speed
    running up, its first running down."""
    pair = operation(4000.0).drive
    speed = 0.9 * pair.natural_speed
    ways: tuple[tuple[Literal["up", "down"], tuple[float, float]], ...] = (
        ("up", (pair.natural_speed / 6.0, speed)),
        ("down", (speed, 1.6 * pair.natural_speed)),
    )
    for direction, ends in ways:
        found = operation(speed, direction)
        swept = sweep_speeds(pair.model, speeds_to_periods(np.linspace(*ends, 30), pair.teeth))
        wanted = swept.up[-1] if direction == "up" else swept.down[0]
        size, exact = (
            response(pair.model, found.speed.mesh_period, state).equivalent_amplitude
            for state in (found.state, wanted.motion.state)
        )
        assert size == pytest.approx(exact, rel=1e-6)
    assert np.abs(operation(speed, "up").state - operation(speed, "down").state).max() > 1e-4


def test_motion_goes_on_from_the_last_one() -> None:
    """On the same flanks a motion that is given is kept: that of a pair which has run down stays what it is for one
    that would have run up, within Newton's tolerance."""
    speed = 0.9 * operation(4000.0).drive.natural_speed
    down = operation(speed, "down")
    kept = replace(POINT, speed=speed).on(model(), (None, None), MPI.COMM_SELF, down.start)
    assert kept.state == pytest.approx(down.state, rel=1e-8)


def test_where_flanks_part_a_least_force_is_left() -> None:
    """At resonance the flanks part for some of the time: that share of the load's course is LEAST_FORCE."""
    found = operation(0.92 * operation(4000.0).drive.natural_speed, "down")
    course = found.load.course
    assert course is not None
    assert found.paths[0].separated_share > 0.05
    assert found.lifted == pytest.approx(found.paths[0].separated_share, abs=0.02)
    assert course.shares.min() == LEAST_FORCE


def test_coarser_gears_get_the_same_course() -> None:
    """The gears of a companion mesh are loaded by the mesh force of the first gears: the same object."""
    prepare = UnderMeshForce(POINT)
    first, second = (prepare(gear_problem(SCENE), MPI.COMM_SELF).model.load for _ in range(2))
    assert prepare.operation is not None and first.course is prepare.operation.load.course
    assert second.course is first.course


def test_forces_beyond_the_heaviest_torque_are_told() -> None:
    """Near resonance, on a force surface up to the torque itself: the largest force over that of the torque, and a
    sentence; none where heavier torques reach it, or where the mesh is a stiffness."""
    speed = 0.92 * operation(4000.0).drive.natural_speed
    light = replace(POINT, shares=(0.5, 1.0), speed=speed).on(model(), (None, None), MPI.COMM_SELF)
    figures = OperationFigures.of(light)
    share = figures.heaviest_torque_share
    assert share > 1.0
    assert share == pytest.approx(figures.largest_force_N / figures.static_force_N, rel=1e-6)
    (sentence,) = operation_warnings([figures])
    assert f"{share:.3g} times that of the heaviest torque" in sentence
    assert operation_warnings([OperationFigures.of(operation(3000.0))]) == []
    stiff = replace(POINT, settings=replace(POINT.settings, mesh="tangent")).on(model(), (None, None), MPI.COMM_SELF)
    assert np.isnan(stiff.heaviest_torque_share)


def test_picture_names_the_gear_bodies() -> None:
    """Below the title, as operation.json has them: elastic and rigid ones have other natural speeds."""
    found = operation(4000.0)
    motion = list(history_rows([Motion(found.speed, "up", found.repeats, found.paths)]))
    rows = excitation_rows(found.excitation)
    assert OperationFacts.of(found).bodies == "rigid"
    for bodies in ("elastic", "rigid"):
        figure = operation_figure(replace(OperationFacts.of(found), bodies=bodies), motion, rows, None)
        assert f" r/min, {bodies} gear bodies." in " ".join(text.get_text() for text in figure.texts)


def test_stresses_of_several_meshes_are_those_of_the_largest_force() -> None:
    """At twice the natural speed, hardly damped, the motion repeats after two meshes. Exact: the course of the larger
    of both forces at each phase, or for wear of their mean."""
    twice = replace(
        POINT, settings=replace(POINT.settings, damping_ratio=0.003), speed=2.0 * operation(4000.0).drive.natural_speed
    )
    mean = twice.on(model(), (None, None), MPI.COMM_SELF)
    largest = replace(twice, of_several="largest").on(model(), (None, None), MPI.COMM_SELF, mean.start)
    assert mean.repeats == largest.repeats == 2
    wear, stress = mean.load.course, largest.load.course
    assert wear is not None and stress is not None
    phases = np.arange(240) / 240
    both = [np.interp(phases, path.phases, path.force) / mean.drive.model.load for path in mean.paths]
    assert wear.shares == pytest.approx(np.maximum(np.mean(both, axis=0), LEAST_FORCE), rel=1e-9)
    assert stress.shares == pytest.approx(np.maximum(np.max(both, axis=0), LEAST_FORCE), rel=1e-6)
    assert stress.shares.max() > 1.2 * wear.shares.max()
    *_, sentence = operation_warnings([OperationFigures.of(largest)])
    assert "after 2 meshes" in sentence


def test_driving_wheel_passes_the_mesh_backwards() -> None:
    """Problem: equal gears without modifications, whose mesh is the same forwards and backwards but for the cells of
    both gears. Exact: the wheel drives, and the mesh force over the rotation is that over time backwards, 1e-12; over
    time it is nearly that where the pinion drives, 0.2 % of the load, and over the rotation it is 4 % off."""
    point = replace(POINT, settings=replace(POINT.settings, driving=Member.WHEEL))
    found = point.on(model(), (None, None), MPI.COMM_SELF)
    course, plain = found.load.course, operation(3000.0).load.course
    assert course is not None and plain is not None
    (path,), static = found.paths, found.drive.model.load
    for phase in (0.1, 0.3, 0.8):
        force = float(np.interp(1.0 - phase, path.phases, path.force)) / static
        assert course.at(phase * 2.0 * np.pi / 50.0) == pytest.approx(force, rel=1e-12)
    assert np.roll(course.shares[::-1], 1) == pytest.approx(plain.shares, abs=2e-3)
    assert np.abs(course.shares - plain.shares).max() > 0.04
