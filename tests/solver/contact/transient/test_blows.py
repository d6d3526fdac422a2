"""Blows with a closed solution."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent import (
    Body,
    Contact,
    EnergyGrowth,
    Fixed,
    Freedom,
    InitialState,
    Material,
    MotionState,
    Problem,
    Rigid,
    Step,
    Transient,
    TransientSettings,
)
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle

BAR = Material(210e3, 0.0)
LENGTH, SPEED = 20.0, 1000.0  # mm, mm/s
WAVE = float(np.sqrt(210e3 / 7.85e-9))  # of sound in the bar [mm/s]
PASSAGE = 2.0 * LENGTH / WAVE  # s, in which the wave runs to the free end and back
MASS = 7.85e-9 * LENGTH


def thrown_bar(modes: int, steps: int) -> tuple[list[MotionState], float]:
    """A bar of 20 × 1 mm with ν = 0 that flies against a rigid wall 0.1 µm away; the moments, and the time step."""
    mesh = rectangle(1.0, LENGTH, 1, 20, origin=(0.0, 1e-4))
    bar = Body(mesh, BAR, supports=(Fixed("left", "x"),), name="bar")
    wall = Body(rectangle(1.0, 1.0, 1, 1, origin=(0.0, -1.0)), BAR, supports=(Fixed("top"), Fixed("bottom")))
    problem = Problem((bar, wall), (Contact((0, "bottom"), (1, "top"), reach=1.0),))
    h = PASSAGE / steps
    flying = InitialState(velocities={0: (0.0, -SPEED)})
    return list(Transient(problem, TransientSettings(h, modes), flying).run(int(1.3 * steps))), h


def forces(moments: list[MotionState]) -> Floats:
    return np.array([-moment.solution.contacts[0].force[1] for moment in moments])


def test_bar_on_a_wall() -> None:
    """One-dimensional waves: a bar that hits a rigid wall at speed v presses with ϱcv for 2L/c, and leaves with v
    (Saint-Venant): time within 1 %, impulse 2mv within 0.5 %, mean force within 1 %; with 20 modes and 200 steps."""
    moments, h = thrown_bar(modes=20, steps=200)
    force = forces(moments)
    pressed = force > 1e-6 * force.max()
    assert np.count_nonzero(np.diff(pressed.astype(int)) > 0) == 1  # one blow
    assert h * pressed.sum() == pytest.approx(PASSAGE, rel=0.01)
    assert h * force.sum() == pytest.approx(2.0 * MASS * SPEED, rel=0.005)
    assert force[pressed].mean() == pytest.approx(7.85e-9 * WAVE * SPEED, rel=0.01)
    assert -moments[-1].velocities[0][0] == pytest.approx(SPEED, rel=0.005)


def test_momentum_is_the_impulse_of_the_contact() -> None:
    """The same bar: its momentum changes by h Σ f in every step but for what the scheme shifts to the next one, and so
    does the sum over the blow, to 1e-9."""
    moments, h = thrown_bar(modes=5, steps=100)
    flying = [moment for moment in moments if moment.solution.contacts[0].force[1] == 0.0]
    change = MASS * (flying[-1].velocities[0][0] - flying[0].velocities[0][0])
    assert abs(change) == pytest.approx(h * forces(moments).sum(), rel=1e-9)


def test_energy_that_grows_is_an_error() -> None:
    """A bar between two walls with four steps a blow and ρ_∞ = 1, which takes nothing out: its energy grows, and the
    transient says so. With ρ_∞ = 0.8 it never exceeds that of the start, and nearly all of it is lost."""
    gap, h = 1e-3, 4e-7
    bar = Body(rectangle(1.0, 4.0, 1, 4, origin=(0.0, gap)), BAR, supports=(Fixed("left", "x"),), name="bar")
    walls = [
        Body(rectangle(1.0, 1.0, 1, 1, origin=(0.0, y)), BAR, supports=(Fixed("top"), Fixed("bottom")))
        for y in (-1.0, 4.0 + 2.0 * gap)
    ]
    contacts = Contact((0, "bottom"), (1, "top"), reach=1.0), Contact((0, "top"), (2, "bottom"), reach=1.0)
    problem, flying = Problem((bar, *walls), contacts), InitialState(velocities={0: (0.0, -SPEED)})
    with pytest.raises(EnergyGrowth, match="shorter time steps"):
        list(Transient(problem, TransientSettings(h, 8, spectral_radius=1.0), flying).run(300))
    energies = [m.energy.total for m in Transient(problem, TransientSettings(h, 8), flying).run(100)]
    assert max(energies) <= energies[0] * (1.0 + 1e-9)
    assert energies[-1] < 0.5 * energies[0]


def test_energy_never_grows() -> None:
    """The same bar: kinetic, elastic and contact energy together never exceed ½mv² by more than 1e-6, and at most 1 %
    of them is lost."""
    moments, _ = thrown_bar(modes=20, steps=200)
    energy = np.array([moment.energy.total for moment in moments]) / (0.5 * MASS * SPEED**2)
    assert energy.max() < 1.0 + 1e-6
    assert energy[-1] > 0.99


@pytest.mark.parametrize("sudden", [False, True])
def test_work_of_prescribed_motions(sudden: bool) -> None:
    """A ram whose lid is moved by 5 µm in 20 µs, smoothly or at a speed that it has at once, hits a bar that flies off:
    energy is never more than the work of the motion by 1e-3 of the largest. Moved smoothly, it is that work at the end,
    within 1 %; most of it is the bar's. The energy is checked, as it is without: a wrong sign of the work is an
    EnergyGrowth."""
    way, duration = 5e-3, 2e-5
    lid = Rigid("bottom", (Freedom("y", displacement=0.0),))
    ram = Body(rectangle(1.0, 2.0, 1, 2, origin=(0.0, -2.0)), BAR, rigid=lid, name="ram")
    bar = Body(rectangle(1.0, 4.0, 1, 4, origin=(0.0, 1e-4)), BAR, (Fixed("left", "x"),), name="bar")
    problem = Problem((ram, bar), (Contact((0, "top"), (1, "bottom"), reach=1.0),))

    def moved(time: float) -> Step:
        share = time / duration
        smooth = share - np.sin(2.0 * np.pi * share) / (2.0 * np.pi) if share < 1.0 else 1.0
        return Step(freedoms=((0, Freedom("y", displacement=float(way * (share if sudden else smooth)))),))

    moments = list(Transient(problem, TransientSettings(3e-7, 8)).run_until(1.5 * duration, moved))
    left = np.array([moment.work - moment.energy.total for moment in moments])
    largest = max(moment.energy.total for moment in moments)
    assert largest > 0.0 and moments[-1].solution.contacts[0].force[1] == 0.0
    if sudden:
        assert left.min() > -0.02 * largest
    else:
        assert left.min() > -1e-3 * largest
        assert moments[-1].energy.total == pytest.approx(moments[-1].work, rel=0.01)
        assert abs(moments[-1].velocities[1][0]) > way / duration
