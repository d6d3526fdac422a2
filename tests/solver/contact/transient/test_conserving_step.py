"""Time steps that keep the energy of contact without friction."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evolvent import (
    Body,
    Contact,
    EnergyNotKept,
    Fixed,
    Freedom,
    InitialState,
    InputError,
    Material,
    MotionState,
    Problem,
    Rigid,
    Step,
    Traction,
    Transient,
    TransientSettings,
)
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle

BAR = Material(210e3, 0.0)
LENGTH, SPEED, GAP = 20.0, 1000.0, 1e-4  # mm, mm/s, mm
PASSAGE = 2.0 * LENGTH / float(np.sqrt(210e3 / 7.85e-9))  # s, of a wave to the free end and back


def thrown_bar(gap: float = GAP) -> Problem:
    """A bar of 20 × 1 mm with ν = 0 above a rigid wall."""
    bar = Body(rectangle(1.0, LENGTH, 1, 20, origin=(0.0, gap)), BAR, supports=(Fixed("left", "x"),), name="bar")
    wall = Body(rectangle(1.0, 1.0, 1, 1, origin=(0.0, -1.0)), BAR, supports=(Fixed("top"), Fixed("bottom")))
    return Problem((bar, wall), (Contact((0, "bottom"), (1, "top"), reach=1.0),))


def rebound(modes: int, conserving: bool, gap: float = GAP, damping: float = 0.0) -> list[MotionState]:
    """It flies down; ten time steps in 2L/c."""
    settings = TransientSettings(PASSAGE / 10, modes, damping, conserving=conserving)
    return list(Transient(thrown_bar(gap), settings, InitialState(velocities={0: (0.0, -SPEED)})).run(18))


def energies(moments: list[MotionState]) -> Floats:
    """Over ½mv²."""
    return np.array([moment.energy.total for moment in moments]) / (0.5 * BAR.density * LENGTH * SPEED**2)


@pytest.mark.parametrize("modes", [0, 4])
@pytest.mark.parametrize("gap", [1e-4, 3e-4, 6e-4])
def test_a_blow_keeps_the_energy(modes: int, gap: float) -> None:
    """Ten steps in 2L/c, begun at three places in a time step: ½mv² at every step to 1e-10, where the method of Wood,
    Bossak and Zienkiewicz is off by more than 1e-4. There is a blow, and without modes the bar leaves as it came."""
    moments = rebound(modes, True, gap)
    assert np.abs(energies(moments) - 1.0).max() < 1e-10
    assert np.abs(energies(rebound(modes, False, gap)) - 1.0).max() > 1e-4
    pressed = np.array([moment.solution.contacts[0].force[1] != 0.0 for moment in moments])
    assert pressed.any() and not pressed[-1]
    if not modes:
        assert abs(moments[-1].velocities[0][0]) == pytest.approx(SPEED, rel=1e-10)


def test_few_steps_take_more_than_two_contact_systems() -> None:
    """While nothing touches, and while the contact stays closed, the midpoint rule keeps the energy by itself: two
    systems. Steps in which contact opens or closes take more."""
    moments = rebound(0, True)
    pressed = [False, *(moment.solution.contacts[0].force[1] != 0.0 for moment in moments)]
    for before, after, moment in zip(pressed, pressed[1:], moments):
        assert moment.systems > 2 if before != after else moment.systems == 2


def test_a_blow_is_that_of_saint_venant() -> None:
    """20 modes, 200 steps in 2L/c: a bar that hits a wall at speed v presses for 2L/c, and leaves with v: time within
    1 %, impulse 2mv within 0.5 %."""
    h = PASSAGE / 200
    run = Transient(
        thrown_bar(), TransientSettings(h, 20, conserving=True), InitialState(velocities={0: (0.0, -SPEED)})
    )
    force = np.array([-moment.solution.contacts[0].force[1] for moment in run.run(260)])
    assert h * np.count_nonzero(force) == pytest.approx(PASSAGE, rel=0.01)
    assert h * force.sum() == pytest.approx(2.0 * BAR.density * LENGTH * SPEED, rel=0.005)


def test_two_free_bodies_keep_their_momentum() -> None:
    """A block flies obliquely against the corner of a heavier one, both free, four modes each: they turn and part, the
    sum of their linear momenta stays to 1e-11 of what one gives the other, and the energy to 1e-10. Nothing but the
    part of the correction along free motions keeps it: the test fails without."""
    small = Body(rectangle(2.0, 2.0, 2, 2, origin=(1.0, 1.001)), name="small")
    large = Body(rectangle(4.0, 1.0, 4, 1, origin=(-1.5, 0.0)), name="large")
    problem = Problem((small, large), (Contact((0, "bottom"), (1, "top"), reach=0.5),))
    start = InitialState(velocities={0: (50.0, -1000.0)})
    run = Transient(problem, TransientSettings(2e-7, 4, conserving=True), start)
    moments = list(run.run(40))
    given = np.array([
        [body.axes.rigid_mass[:2] @ velocity for body, velocity in zip(run.bodies, moment.velocities)]
        for moment in moments
    ])  # (steps, bodies, directions)
    total = given.sum(axis=1)
    exchanged = np.ptp(given[:, 1, 1])
    assert exchanged > 0.5 * abs(total[0, 1])
    assert np.abs(total - total[0]).max() < 1e-11 * exchanged
    assert any(moment.systems > 2 for moment in moments)
    energy = np.array([moment.energy.total for moment in moments])
    assert np.abs(energy - energy[0]).max() < 1e-10 * energy[0]
    assert moments[-1].solution.contacts[0].force[1] == 0.0


def slider(friction: float = 0.0) -> Problem:
    """A block, pressed by its lid, which also draws it to the side, on one that is held."""
    lid = Rigid("top", (Freedom("y", load=-300.0), Freedom("x", load=60.0)))
    load = (Traction("left", (5.0, 0.0)),)
    upper = Body(rectangle(2.0, 2.0, 2, 2, origin=(0.5, 1.0)), loads=load, rigid=lid, name="slider")
    base = Body(rectangle(4.0, 1.0, 5, 1), supports=(Fixed("bottom"),), name="base")
    return Problem((upper, base), (Contact((0, "bottom"), (1, "top"), friction=friction),))


def shaken(time: float) -> Step:
    """Presses and lifts in turn, while it draws."""
    load = -300.0 * float(np.cos(2e6 * time))
    return Step(1.0, freedoms=((0, Freedom("y", load=load)), (0, Freedom("x", load=150.0))))


def figures(moment: MotionState) -> Floats:
    """All that a moment says, in one array."""
    contact = moment.solution.contacts[0]
    scalars = [moment.time, moment.error, moment.work, moment.energy.total, moment.systems]
    fields = [contact.traction, contact.slip, *(moment.solution.displacement(i) for i in range(2))]
    return np.concatenate([scalars, *moment.velocities, *moment.solution.motions, *(each.ravel() for each in fields)])


SHAKEN = TransientSettings(2e-7, 3, conserving=True)


def test_energy_under_loads_that_vary_is_their_work() -> None:
    """Thrown off its base and pressed on again: energy less work stays to 1e-10 of the largest energy, with three modes
    each and an initial speed along the base. Surfaces are searched anew where it comes to lie."""
    start = InitialState(velocities={0: (2e4, 0.0)})
    moments = list(Transient(slider(), SHAKEN, start).run_until(2e-5, shaken))
    left = np.array([moment.energy.total - moment.work for moment in moments])
    largest = max(moment.energy.total for moment in moments)
    assert np.ptp([moment.energy.total for moment in moments]) > 0.1 * largest
    assert np.ptp(left) < 1e-10 * largest
    assert len({moment.solution.contacts[0].force[1] != 0.0 for moment in moments}) == 2
    assert any(moment.solution.searches > 1 for moment in moments)


def test_what_is_at_rest_stays() -> None:
    """From static equilibrium under constant loads, along with a lid that does not move: nothing moves, and there is
    nothing to correct."""
    lid = Rigid("top", (Freedom("y", load=-300.0), Freedom("x", displacement=0.0)))
    upper = Body(rectangle(2.0, 2.0, 2, 2, origin=(0.5, 1.0)), rigid=lid)
    base = Body(rectangle(3.0, 1.0, 3, 1), supports=(Fixed("bottom"),))
    problem = Problem((upper, base), (Contact((0, "bottom"), (1, "top")),))
    moments = list(Transient(problem, SHAKEN, InitialState(Step())).run(3))
    force = [moment.solution.contacts[0].force[1] for moment in moments]
    assert force == pytest.approx([-300.0] * 3, rel=1e-9)
    assert all(moment.systems == 2 for moment in moments)


def test_damping_takes_energy() -> None:
    """The bar with 5 % damping: the energy falls in every step after the blow, in which its modes vibrate, and what is
    kept is checked against what damping took: without that the steps would be errors."""
    energy = energies(rebound(4, True, damping=0.05))
    assert energy[-1] < 0.995
    assert (np.diff(energy) < 1e-12).all()


def test_second_order_while_the_contact_stays_closed() -> None:
    """A block pressed on another one by a traction that rises and falls smoothly within 40 µs, three modes each, from
    statics: velocity, force and displacements at the end, against 128 steps. The error of 16 steps is four times that
    of 32."""

    def at_the_end(count: int) -> Floats:
        steel = Material(210e3, 0.3)
        load = (Traction("top", (0.0, -100.0)),)
        upper = Body(rectangle(10.0, 10.0, 3, 3, origin=(0.0, 10.0)), steel, (Fixed("left", "x"),), load)
        lower = Body(rectangle(10.0, 10.0, 2, 2), steel, (Fixed("left", "x"), Fixed("bottom")))
        problem = Problem((upper, lower), (Contact((0, "bottom"), (1, "top")),))
        run = Transient(problem, TransientSettings(4e-5 / count, 3, 0.02, conserving=True), InitialState(Step()))
        shares = 1.0 + 0.3 * np.sin(np.pi * np.arange(1, count + 1) / count) ** 4
        last = list(run.run([Step(float(share)) for share in shares]))[-1]
        contact = last.solution.contacts[0]
        assert (contact.pressure > 0.0).all()
        return np.concatenate(
            [last.velocities[0] / 100.0, contact.force / 1e3, 1e3 * last.solution.displacement(0).ravel()]
        )

    exact = at_the_end(128)
    coarse, fine = (np.linalg.norm(at_the_end(count) - exact) for count in (16, 32))
    assert coarse < 0.1 * np.linalg.norm(exact)
    assert np.log2(coarse / fine) == pytest.approx(2.05, abs=0.15)  # 2.07 for the error of the reference itself


def test_a_run_goes_on_bit_for_bit(tmp_path: Path) -> None:
    """Saved after six steps and taken up by a new `Transient`: every figure of every moment that follows is that of the
    run that went on, exactly. A state of the other method is refused."""
    run = Transient(slider(), SHAKEN)
    list(run.run_until(1.2e-6, shaken))
    path = run.save(tmp_path / "state.npz")
    going_on = [figures(moment) for moment in run.run_until(3e-6, shaken)]
    again = Transient.resume(path, slider(), SHAKEN)
    taken_up = [figures(moment) for moment in again.run_until(3e-6, shaken)]
    assert len(going_on) == len(taken_up) == 9
    assert all(np.array_equal(a, b) for a, b in zip(going_on, taken_up))
    with pytest.raises(InputError, match="another setting conserving"):
        Transient.resume(path, slider(), TransientSettings(2e-7, 3))


def test_friction_and_driven_motions_are_refused() -> None:
    """By name, with what to do."""
    with pytest.raises(InputError, match=r"contacts without friction, found friction = 0.2; leave out conserving"):
        Transient(slider(0.2), SHAKEN)
    lid = Rigid("top", (Freedom("y", displacement=0.0),))
    upper = Body(rectangle(1.0, 1.0, 1, 1, origin=(0.0, 1.01)), rigid=lid)
    lower = Body(rectangle(1.0, 1.0, 1, 1), supports=(Fixed("bottom"),))
    run = Transient(Problem((upper, lower), (Contact((0, "bottom"), (1, "top"), reach=0.5),)), SHAKEN)
    run.solve()
    with pytest.raises(InputError, match=r"prescribed motions of body 0.*move the body by a load"):
        run.solve(Step(freedoms=((0, Freedom("y", displacement=-1e-3)),)))


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"conserving": 1}, "conserving"),
        ({"conserving": True, "spectral_radius": 0.5}, "no spectral_radius, found spectral_radius = 0.5"),
        ({"conserving": True, "tolerance": 1e-3}, "equal steps, found tolerance"),
    ],
)
def test_settings_that_do_not_go_with_it(values: dict[str, Any], named: str) -> None:
    """No number for a truth value, no spectral radius, no adaptive steps."""
    with pytest.raises(InputError, match=named):
        TransientSettings(1e-6, **values)


def test_a_step_that_cannot_keep_the_energy_is_an_error() -> None:
    """A bar amid two walls, with time steps longer than a blow: both walls hold it within one step, and no motion has
    all the energy. The step says so, and the transient stays where it was."""
    gap, h = 1e-3, 3e-6
    bar = Body(rectangle(1.0, 4.0, 1, 4, origin=(0.0, gap)), BAR, supports=(Fixed("left", "x"),), name="bar")
    walls = [
        Body(rectangle(1.0, 1.0, 1, 1, origin=(0.0, y)), BAR, supports=(Fixed("top"), Fixed("bottom")))
        for y in (-1.0, 4.0 + 2.0 * gap)
    ]
    contacts = Contact((0, "bottom"), (1, "top"), reach=1.0), Contact((0, "top"), (2, "bottom"), reach=1.0)
    run = Transient(Problem((bar, *walls), contacts), TransientSettings(h, 8, conserving=True),
                    InitialState(velocities={0: (0.0, -SPEED)}))
    with pytest.raises(EnergyNotKept, match="shorter time step"):
        list(run.run(100))
    reached = run.time
    with pytest.raises(EnergyNotKept):
        run.solve()
    assert run.time == reached
