"""Time steps of different lengths: the order of the scheme, the estimate of a step's error, what follows from it."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from evolvent import (
    Body,
    CoarseTimeStepWarning,
    Contact,
    Fixed,
    Freedom,
    InitialState,
    InputError,
    Material,
    MotionState,
    Problem,
    Rigid,
    Step,
    Transient,
    TransientSettings,
)
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.transient import solver
from evolvent.contact.transient.adaptive_steps import StepLengths
from evolvent.contact.transient.one_step import SolvedStep
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, LinearSystem, TimeScheme, TimeStep
from evolvent_meshes.shapes.blocks import rectangle

DENSITY, LOAD, DRIVE = 7.85e-9, 10.0, 2e4  # t/mm³, N/mm, rad/s


def lifted() -> Problem:
    """A block of 1 mm² under a lid that is drawn upwards, away from one below."""
    upper = Body(rectangle(1.0, 1.0, 1, 1, origin=(0.0, 1.5)), rigid=Rigid("top", (Freedom("y", load=LOAD),)))
    lower = Body(rectangle(1.0, 1.0, 1, 1), supports=(Fixed("bottom"),))
    return Problem((upper, lower), (Contact((0, "bottom"), (1, "top"), reach=1.0),))


def sine(time: float) -> Step:
    return Step(float(np.sin(DRIVE * time)))


def thrown_bar() -> tuple[Problem, InitialState]:
    """A steel bar of 4 mm, ν = 0, that flies 10 µm to a rigid wall with 1 m/s: ten times as long as the blow takes."""
    steel = Material(210e3, 0.0)
    bar = Body(rectangle(1.0, 4.0, 1, 2, origin=(0.0, 0.01)), steel, (Fixed("left", "x"),), name="bar")
    wall = Body(rectangle(1.0, 1.0, 1, 1, origin=(0.0, -1.0)), steel, (Fixed("top"), Fixed("bottom")), name="wall")
    return Problem((bar, wall), (Contact((0, "bottom"), (1, "top"), reach=1.0),)), InitialState(
        velocities={0: (0.0, -1000.0)}
    )


@pytest.mark.parametrize("spectral_radius", [0.0, 0.5])
def test_second_order_with_steps_of_alternating_lengths(spectral_radius: float) -> None:
    """A rigid block under F sin ωt, in steps h, h, h/2, 2h in turn: way and speed at 0.2 ms against
    F/(mω)·(t − sin ωt/ω) and F/(mω)·(1 − cos ωt). Both errors fall fourfold when the steps are halved. They would not
    if the acceleration kept the lag of the step before."""
    end, errors = 2e-4, []
    for count in (16, 32):
        ends = np.cumsum(np.tile([1.0, 1.0, 0.5, 2.0], count // 4))
        run = Transient(lifted(), TransientSettings(end, 0, spectral_radius=spectral_radius))
        for time in end * ends / ends[-1]:
            (moment,) = run.run_until(float(time), sine)
        assert moment.time == pytest.approx(end, rel=1e-12)
        rate = LOAD / DENSITY / DRIVE
        way = rate * (end - np.sin(DRIVE * end) / DRIVE)
        speed = rate * (1.0 - np.cos(DRIVE * end))
        errors.append([moment.solution.motions[0][0] - way, moment.velocities[0][0] - speed])
    coarse, fine = np.array(errors)
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.25)


@pytest.mark.parametrize("spectral_radius", [0.0, 0.5, 0.8, 1.0])
def test_the_estimate_is_the_error_of_a_step(spectral_radius: float) -> None:
    """z̈ = −z from the exact state at t = 1, with a = z̈(t + αh) as the scheme has it after many steps: its end is off
    cos(t + h) by c h² (a_{n+1} − a_n), within 2 % at h = 0.01."""
    scheme, t, h = TimeScheme(spectral_radius), 1.0, 0.01
    system = LinearSystem(np.eye(1), np.zeros(1), np.ones(1))
    at = KinematicState(*(np.array([x]) for x in (np.cos(t), -np.sin(t), -np.cos(t + scheme.alpha * h))))
    step = TimeStep(system, scheme, at, h)
    after = step.after(np.linalg.solve(step.matrix, step.known))
    estimate = scheme.error_constant * h**2 * (after.acceleration - at.acceleration)
    assert estimate == pytest.approx(after.position - np.cos(t + h), rel=0.02)


def test_the_error_of_a_moment() -> None:
    """The rigid block in equal steps from rest: its only error is that of its rigid motion, c h Δa over the largest
    √(2E/m) so far, with a from F sin ωt = m ((1 − α) a_{n+1} + α a_n)."""
    h, mass = 5e-6, DENSITY
    scheme = TimeScheme(0.8)
    moments = list(Transient(lifted(), TransientSettings(h, 0)).run_until(20 * h, sine))
    accelerations, largest = [0.0], 0.0
    for moment in moments:
        driven = LOAD / mass * np.sin(DRIVE * moment.time)
        accelerations.append((driven - scheme.alpha * accelerations[-1]) / (1.0 - scheme.alpha))
        largest = max(largest, moment.energy.total)
        change = accelerations[-1] - accelerations[-2]
        wanted = scheme.error_constant * h * abs(change) / np.sqrt(2.0 * largest / mass)
        assert moment.error == pytest.approx(wanted, rel=1e-6)


def test_steps_are_short_where_it_hits() -> None:
    """The thrown bar with five modes and a tolerance of 0.5 %: no step has a larger error; flight takes the longest
    steps, the blow at least twenty of a tenth and less. Rejected ones counted, there are less than a third as many as
    equal ones of the shortest length; and the bar bounces back as fast as with a tolerance of 0.1 %, within 1.5 %."""
    problem, start = thrown_bar()
    end, longest, attempts, solved = 1.6e-5, 2e-6, [], solver.solve_step

    def counted(*each: Any) -> SolvedStep:
        attempts.append(each)
        return solved(*each)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(solver, "solve_step", counted)
        moments = list(Transient(problem, TransientSettings(longest, 5, tolerance=0.005), start).run_until(end))
    forces = np.array([abs(moment.solution.contacts[0].force[1]) for moment in moments])
    hit = forces > 1e-6 * forces.max()  # the last step of flight ends with a gap of nothing but rounding
    pressed = [moment.length for moment, touches in zip(moments, hit) if touches]
    assert all(moment.error <= 0.005 for moment in moments)
    assert moments[0].length == longest > 10.0 * max(pressed)
    assert len(pressed) >= 20
    assert len(moments) < len(attempts) < end / min(pressed) / 3.0
    *_, last = Transient(problem, TransientSettings(longest, 5, tolerance=1e-3), start).run_until(end)
    assert moments[-1].velocities[0][0] == pytest.approx(last.velocities[0][0], rel=0.015)


def test_loads_are_those_of_the_end_of_a_step() -> None:
    """A function of time is asked for the start first, and last, before a moment comes, for the time of that moment."""
    asked: list[float] = []

    def loads(time: float) -> Step:
        asked.append(time)
        return sine(time)

    run = Transient(lifted(), TransientSettings(5e-5, 0, tolerance=1e-3))
    for moment in run.run_until(2e-4, loads):
        assert asked[-1] == moment.time == run.time
        assert moment.solution.step == sine(moment.time)
    assert asked[0] == 0.0


def test_a_step_that_cannot_be_solved_is_halved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps of more than 3 µs fail: from 10 µs on they are halved to 2.5 µs. Where all fail, the error of the shortest
    one is raised, and the transient stays where it was."""
    solved, longest, tried = solver.solve_step, 3e-6, []

    def picky(*each: Any) -> SolvedStep:
        tried.append(each[-1])
        if each[-1] > longest:
            raise NotConverged("too long")
        return solved(*each)

    monkeypatch.setattr(solver, "solve_step", picky)
    run = Transient(lifted(), TransientSettings(1e-5, 0, tolerance=0.1, shortest_step=1e-6))
    assert run.solve(Step()).length == 2.5e-6
    assert tried == [1e-5, 5e-6, 2.5e-6]
    longest = 0.0
    with pytest.raises(NotConverged, match="too long"):
        run.solve(Step())
    assert tried[-1] == 1e-6 and run.time == 2.5e-6
    longest = 1.0
    assert run.solve(Step()).time == 5e-6


def test_what_the_shortest_step_does_not_resolve_is_said() -> None:
    """Steps of 0.5 µs and more are too long for the bar's blow: a warning with error, tolerance and length. With a
    shorter one there is none."""
    problem, start = thrown_bar()
    with pytest.warns(CoarseTimeStepWarning, match=r"at most 0\.01 .* found 0\.\d+ with the shortest step of 5e-07 s"):
        list(Transient(problem, TransientSettings(2e-6, 5, 0.0, 0.8, 0.01, 5e-7), start).run_until(1.4e-5))
    with warnings.catch_warnings():
        warnings.simplefilter("error", CoarseTimeStepWarning)
        list(Transient(problem, TransientSettings(2e-6, 5, 0.0, 0.8, 0.01, 1e-9), start).run_until(1.05e-5))


@pytest.mark.parametrize(
    ("end", "lengths"), [(4.0, [1, 1, 1, 1]), (3.5, [1, 1, 0.75, 0.75]), (0.25, [0.25]), (0.0, [])]
)
def test_a_run_ends_where_it_is_to(end: float, lengths: list[float]) -> None:
    """Equal steps to a time: the last two are shorter where it is no multiple. No step follows for a time that has been
    reached."""
    h = 1e-6
    run = Transient(lifted(), TransientSettings(h, 0))

    def moments() -> Iterator[MotionState]:
        return run.run_until(end * h)

    assert [moment.length / h for moment in moments()] == pytest.approx(lengths, rel=1e-9)
    assert run.time == pytest.approx(end * h, rel=1e-12)
    assert list(moments()) == []


def test_lengths() -> None:
    """Rules with a tolerance of 0.01, from 1e-3 to 1 s: an error of 0.04 shortens to 0.9·√¼; one of 1000 to a tenth;
    one below a quarter of the tolerance lengthens by 1.5, one above does not; after a step that was shortened for its
    end only the next one is as planned; after one that had to be tried again it does not grow."""
    lengths = StepLengths(1.0, 1e-3, 0.01)
    assert lengths.shorter(0.1, 0.04) == pytest.approx(0.045)
    assert lengths.shorter(0.1, 1e3) == pytest.approx(0.01)
    assert lengths.shorter(0.1, float("nan")) == pytest.approx(0.01)
    assert lengths.shorter(0.002, 1e3) == 1e-3
    assert lengths.shorter(0.1, None) == 0.05
    assert lengths.after(0.1, 0.0024, 0.1) == pytest.approx(0.15)
    assert lengths.after(0.1, 0.0026, 0.1) == 0.1
    assert lengths.after(0.01, 0.009, 0.1) == 0.1
    assert lengths.after(0.1, 0.0, None) == 0.1
    assert lengths.after(0.9, 0.0, 0.9) == 1.0
    assert lengths.after(1e-3, 0.1, 1e-3) == 1e-3


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"tolerance": 0.0}, "tolerance"),
        ({"tolerance": 1.0}, "tolerance"),
        ({"tolerance": 1e-3, "shortest_step": 0.0}, "shortest_step"),
        ({"tolerance": 1e-3, "shortest_step": 2e-6}, "shortest_step"),
        ({"shortest_step": 1e-8}, "shortest_step: wanted none without a tolerance"),
    ],
)
def test_settings_out_of_range(values: dict[str, float], named: str) -> None:
    """Each by its name; a shortest step means nothing where all are equal."""
    with pytest.raises(InputError, match=named):
        TransientSettings(1e-6, **values)  # type: ignore[arg-type]


def test_times_and_loads_that_are_none() -> None:
    """A time that is infinite or negative; a function whose values are no Step."""
    run = Transient(lifted(), TransientSettings(1e-6, 0))
    for time in (float("inf"), -1.0):
        with pytest.raises(InputError, match="time"):
            list(run.run_until(time))
    with pytest.raises(InputError, match="wanted a Step"):
        list(run.run_until(1e-6, lambda time: time))  # type: ignore[arg-type, return-value]
