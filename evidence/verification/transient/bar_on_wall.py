"""A bar is thrown against a rigid wall: one-dimensional waves (Saint-Venant)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence.claims import Verification, analytical
from evidence.fits import order_of
from evolvent import Body, Contact, Fixed, InitialState, Material, Problem, Transient, TransientSettings
from evolvent.results.drawing.style import INK, PINION, WHEEL
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle

STEEL = Material(poissons_ratio=0.0)
LENGTH, SPEED = 20.0, 1000.0  # mm, mm/s
GAP = 1e-4  # mm
WAVE = float(np.sqrt(STEEL.youngs_modulus / STEEL.density))  # c of sound in the bar [mm/s]
PASSAGE = 2.0 * LENGTH / WAVE  # s
FORCE = STEEL.density * WAVE * SPEED  # N/mm²
IMPULSE = 2.0 * STEEL.density * LENGTH * SPEED  # N·s/mm²
MODES, RADIUS = 20, 0.8
STEPS = (50, 100, 200, 400)  # time steps a passage
SHOWN = 200
PROBLEM = f"""
A steel bar of {LENGTH:g} × 1 mm, ν = 0, flies against a rigid wall with {SPEED / 1000.0:g} m/s, {1e3 * GAP:g} µm
away. A wave runs to the free end and back: for 2L/c = {1e6 * PASSAGE:.2f} µs the bar presses with ϱcv, then it leaves
with the speed that it had, and without vibrations. {MODES} natural modes, ρ_∞ = {RADIUS:g}, and {STEPS[0]} to
{STEPS[-1]} time steps in 2L/c; where no number is said, {SHOWN}. So few modes make no step of the force: it swings
about ϱcv. Mean and impulse are those of the contact, h Σ f. Through an impact the method is of first order, since
contact opens and closes somewhere within a step; errors therefore scatter about a slope.
"""


@dataclass(frozen=True)
class Blow:
    """The force on the wall over time.

    step:   h [s].
    force:  (n,), at the end of each time step [N/mm, that is N on 1 mm of the bar's depth].
    speed:  of the bar at the end, away from the wall [mm/s].
    energy: (n,), over that at the start.
    """

    step: float
    force: Floats
    speed: float
    energy: Floats

    @property
    def duration(self) -> float:
        """[s] in contact."""
        return self.step * float(np.count_nonzero(self.force))

    @property
    def impulse(self) -> float:
        """[N·s/mm]."""
        return self.step * float(self.force.sum())

    @property
    def mean(self) -> float:
        """Of the force in contact [N/mm]."""
        return self.impulse / self.duration

    @property
    def time(self) -> Floats:
        """(n,) since the bar would have touched without a time step [s]."""
        return self.step * np.arange(1, len(self.force) + 1) - GAP / SPEED


def problem(gap: float = GAP) -> Problem:
    """The bar above the wall; both are 1 mm wide."""
    bar = rectangle(1.0, LENGTH, 1, 20, origin=(0.0, gap))
    wall = rectangle(1.0, 1.0, 1, 1, origin=(0.0, -1.0))
    bodies = (
        Body(bar, STEEL, supports=(Fixed("left", "x"),), name="bar"),
        Body(wall, STEEL, supports=(Fixed("top"), Fixed("bottom")), name="wall"),
    )
    return Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=1.0),))


def thrown(steps: int, modes: int = MODES, radius: float = RADIUS, gap: float = GAP) -> Blow:
    """steps: time steps a passage of the wave; radius: ρ_∞; gap: over which the bar flies before [mm]."""
    settings = TransientSettings(PASSAGE / steps, modes, spectral_radius=radius)
    run = Transient(problem(gap), settings, InitialState(velocities={0: (0.0, -SPEED)}))
    moments = list(run.run(int(1.3 * steps + gap / (SPEED * settings.time_step))))
    force = np.array([-moment.solution.contacts[0].force[1] for moment in moments])
    energy = np.array([moment.energy.total for moment in moments])
    return Blow(settings.time_step, force, -moments[-1].velocities[0][0], energy / (0.25 * IMPULSE * SPEED))


def verify() -> Verification:
    """Solves it with each number of time steps."""
    blows = {steps: thrown(steps) for steps in STEPS}
    blow, waves = blows[SHOWN], analytical("one-dimensional waves (Saint-Venant)")
    errors = np.array([abs(each.impulse / IMPULSE - 1.0) for each in blows.values()])
    return Verification(
        "bar_on_wall",
        "Bar on a rigid wall",
        PROBLEM,
        (
            waves.relative("time of contact 2L/c [µs]", 1e6 * blow.duration, 1e6 * PASSAGE, 0.01),
            waves.relative("mean force ϱcv [N/mm]", blow.mean, FORCE, 0.01),
            waves.relative("impulse 2mv [N·s/m]", 1e3 * blow.impulse, 1e3 * IMPULSE, 0.005),
            waves.relative("speed after the blow [m/s]", 1e-3 * blow.speed, 1e-3 * SPEED, 0.005),
            analytical("first order through impacts").at_least(
                "order of convergence of the impulse in the time step", order_of(STEPS, errors), 1.0, 0.15
            ),
            analytical("nothing drives the bar").bound(
                "growth of the energy over that of the start", max(0.0, float(blow.energy.max()) - 1.0), 1e-6
            ),
        ),
        lambda figure: draw(figure, blows, errors),
        f"{MODES} modes let the force swing about ϱcv; the impulse is right, and its error falls with the time step",
    )


def draw(figure: Figure, blows: dict[int, Blow], errors: Floats) -> None:
    """Force and impulse over time, and the error of the impulse over the time step."""
    grid = figure.add_gridspec(2, 2, width_ratios=(1.5, 1.0))
    upper = figure.add_subplot(grid[0, 0])
    _over_time(upper, figure.add_subplot(grid[1, 0], sharex=upper), blows[SHOWN])
    right, steps = figure.add_subplot(grid[:, 1]), np.array(STEPS)
    middle = np.exp(np.mean(np.log(errors * steps)))
    right.loglog(steps, 100.0 * errors, "o", color=WHEEL, ms=6, label="found")
    right.loglog(steps, 100.0 * middle / steps, color=INK, lw=1.0, label="slope 1")
    right.set_xticks(steps, [str(each) for each in steps])
    right.set_xticks([], minor=True)
    right.set(xlabel="time steps in 2L/c", ylabel="error of the impulse [%]")
    right.yaxis.set_major_formatter("{x:g}")
    right.legend()


def _over_time(upper: Axes, lower: Axes, blow: Blow) -> None:
    t, name = blow.time / PASSAGE, f"{MODES} modes, {SHOWN} steps in 2L/c"
    upper.fill_between([0.0, 1.0], 1.0, color="#e3e6ea")
    upper.plot([-0.1, 0.0, 0.0, 1.0, 1.0, 1.2], [0.0, 0.0, 1.0, 1.0, 0.0, 0.0], color=INK, lw=1.0, label="exact")
    upper.plot(t, blow.force / FORCE, color=PINION, lw=1.2, label=name)
    upper.set(ylabel="force / ϱcv", xlim=(-0.1, 1.2), ylim=(0.0, 2.7))
    upper.legend(loc="upper left", ncols=2)
    lower.plot([-0.1, 0.0, 1.0, 1.2], [0.0, 0.0, 1.0, 1.0], color=INK, lw=3.0, alpha=0.3)
    lower.plot(t, blow.step * np.cumsum(blow.force) / IMPULSE, color=PINION, lw=1.2)
    lower.set(xlabel="time / (2L/c)", ylabel="impulse so far / 2mv", ylim=(0.0, 1.1))
