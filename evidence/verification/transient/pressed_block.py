"""A block on another one under a force that rises and falls: contact that stays closed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence.claims import Verification, analytical
from evidence.fits import order_of
from evolvent import (
    Body,
    Contact,
    Fixed,
    InitialState,
    Problem,
    Step,
    Traction,
    Transient,
    TransientSettings,
)
from evolvent.fem.material import STEEL
from evolvent.results.drawing.style import INK, PINION, TEETH, WHEEL
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle

SIDE, PRESSURE = 10.0, 100.0  # mm, MPa
DURATION, RISE = 4e-5, 0.3  # s; share of the pressure
MODES, DAMPING = 3, 0.02
STEPS, REFERENCE = (32, 64, 128), 512
QUANTITIES = ("contact force", "approach of the block", "speed of the block")
PROBLEM = f"""
A steel block of {SIDE:g} × {SIDE:g} mm lies on another one, plane strain, pressed by {PRESSURE:g} MPa; within
{1e6 * DURATION:g} µs the pressure rises by {100 * RISE:g} % and falls again, like sin⁴. The upper block has
{MODES} natural modes, of {100 * DAMPING:g} % damping, and moves as a whole; the contact stays closed everywhere, so the
motion is that of a linear system, and the method of Wood, Bossak and Zienkiewicz is of second order (ρ_∞ = 0.8). So is
the one that conserves energy (`conserving`), and both have the same limit. Root mean squares over {STEPS[0]} times,
over the largest change, against {REFERENCE} time steps of the former.
"""


@dataclass(frozen=True)
class Course:
    """The motion at the ends of STEPS[0] equal parts of the duration.

    force:     (n,), of the contact [N/mm].
    approach:  (n,), of the upper block, down [mm].
    speed:     (n,), of the upper block, down [mm/s].
    closed:    least share of the points of contact that press.
    """

    force: Floats
    approach: Floats
    speed: Floats
    closed: float

    def errors(self, exact: Course) -> Floats:
        """(3,), in the order of QUANTITIES."""
        pairs = (self.force, exact.force), (self.approach, exact.approach), (self.speed, exact.speed)
        return np.array([np.sqrt(np.mean((f - e) ** 2)) / np.ptp(e) for f, e in pairs])


def load(share: Floats) -> Floats:
    """Factor of the pressure at shares of the duration (n,)."""
    return 1.0 + RISE * np.sin(np.pi * share) ** 4


def problem() -> Problem:
    """Both blocks; their cells do not match."""
    press = Traction("top", (0.0, -PRESSURE))
    upper = rectangle(SIDE, SIDE, 4, 4, origin=(0.0, SIDE))
    bodies = (
        Body(upper, STEEL, supports=(Fixed("left", "x"),), loads=(press,), name="upper"),
        Body(rectangle(SIDE, SIDE, 3, 3), STEEL, supports=(Fixed("left", "x"), Fixed("bottom")), name="lower"),
    )
    return Problem(bodies, (Contact((0, "bottom"), (1, "top")),))


def course(steps: int, conserving: bool = False) -> Course:
    """steps: time steps of the duration, a multiple of STEPS[0]."""
    settings = TransientSettings(DURATION / steps, MODES, DAMPING, conserving=conserving)
    run = Transient(problem(), settings, InitialState(Step()))
    moments = list(run.run([Step(float(factor)) for factor in load(np.arange(1, steps + 1) / steps)]))
    every = moments[steps // STEPS[0] - 1 :: steps // STEPS[0]]
    return Course(
        np.array([-moment.solution.contacts[0].force[1] for moment in every]),
        np.array([-moment.solution.motions[0][0] for moment in every]),
        np.array([-moment.velocities[0][0] for moment in every]),
        min(float(np.mean(moment.solution.contacts[0].pressure > 0.0)) for moment in moments),
    )


def verify() -> Verification:
    """Solves it with each number of time steps."""
    courses = {steps: course(steps) for steps in (*STEPS, REFERENCE)}
    exact = courses[REFERENCE]
    errors = np.array([courses[steps].errors(exact) for steps in STEPS])
    conserving = np.array([course(steps, conserving=True).errors(exact) for steps in STEPS])
    method = analytical("Wood, Bossak and Zienkiewicz 1980: second order")
    return Verification(
        "pressed_block",
        "Pressed block under a varying force: order in time",
        PROBLEM,
        (
            *(
                method.at_least(f"order of convergence of the {name} in the time step", order_of(STEPS, each), 2.0, 0.1)
                for name, each in zip(QUANTITIES, errors.T)
            ),
            *(
                analytical("Gonzalez 1996: second order").at_least(
                    f"order of convergence of the {name} in the time step, conserving", order_of(STEPS, each), 2.0, 0.1
                )
                for name, each in zip(QUANTITIES, conserving.T)
            ),
            analytical("pressed everywhere").absolute(
                "least share of the points of contact that press", min(each.closed for each in courses.values()), 1.0,
                0.0,
            ),
        ),
        lambda figure: draw(figure, courses, errors),
        "As long as the contact stays closed, halving the time step quarters the error",
    )


def draw(figure: Figure, courses: dict[int, Course], errors: Floats) -> None:
    """The contact force over time, and errors over the number of time steps."""
    left, right = figure.subplots(1, 2, width_ratios=(1.3, 1.0))
    _force(left, courses)
    steps = np.array(STEPS)
    for name, each, colour, marker in zip(QUANTITIES, errors.T, (PINION, WHEEL, TEETH[0]), "os^"):
        right.loglog(steps, 100.0 * each, marker, color=colour, ms=6, label=name)
        right.loglog(steps, 100.0 * each[-1] * (steps[-1] / steps) ** 2, color=colour, lw=1.0)
    right.plot([], [], color=INK, lw=1.0, label="slope 2")
    right.set_xticks(steps, [str(each) for each in steps])
    right.set_xticks([], minor=True)
    right.yaxis.set_major_formatter("{x:g}")
    right.set(xlabel="time steps", ylabel="error over the largest change [%]")
    right.legend()


def _force(axes: Axes, courses: dict[int, Course]) -> None:
    share = np.arange(1, STEPS[0] + 1) / STEPS[0]
    static, fine = PRESSURE * SIDE, np.linspace(0.0, 1.0, 200)
    axes.plot(1e6 * DURATION * fine, load(fine), color=INK, lw=1.0, ls="--", label="the load")
    axes.plot(1e6 * DURATION * share, courses[REFERENCE].force / static, color=PINION, label=f"{REFERENCE} time steps")
    axes.plot(1e6 * DURATION * share, courses[STEPS[0]].force / static, "o", color=WHEEL, ms=4,
              label=f"{STEPS[0]} time steps")
    axes.set(xlabel="time [µs]", ylabel="contact force / static force", ylim=(0.0, None))
    axes.legend(loc="lower center")
