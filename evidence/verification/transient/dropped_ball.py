"""A ball that is dropped on a block: Hertz' impact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

from evidence.claims import Verification, analytical, regression
from evolvent import (
    Body,
    Contact,
    Fixed,
    Freedom,
    InitialState,
    Material,
    Problem,
    Rigid,
    Transient,
    TransientSettings,
)
from evolvent.fem.material import STEEL, contact_modulus
from evolvent.results.drawing.style import INK, PINION, WHEEL
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.rings import ring_block, ring_sphere
from evolvent_meshes.shapes.variants import with_part

RADIUS, CONTACT = 100.0, 1.0  # mm; a at the largest force
SIDE, CELLS, GROWTH = 40.0, 3, 1.8
MASS = 1e-3  # t
STEPS = 40  # in Hertz' time of contact
MODULUS = contact_modulus(STEEL, STEEL)
APPROACH = CONTACT**2 / RADIUS  # mm
SPEED = float(np.sqrt(16.0 * MODULUS * np.sqrt(RADIUS) * APPROACH**2.5 / (15.0 * MASS)))  # mm/s
LAST = 1.2  # of Hertz' time of contact
PROBLEM = f"""
A steel body of {1e3 * MASS:g} kg with a spherical underside, R = {RADIUS:g} mm, meets a steel block with {SPEED /
1000.0:.3f} m/s. Elastic half-spaces and a rigid ball between them (Hertz) say: an approach of δ =
(15mv²/16E*√R)^(2/5) = {1e3 * APPROACH:g} µm, contact for 2.9433 δ/v, and the largest force 4/3 E*√R δ^(3/2), with a
radius of contact a = {CONTACT:g} mm. A quarter of each body is modelled, {SIDE / CONTACT:g} a wide and high, of
second-order hexahedra of a/{CELLS} in rings; the ball has its mass in this part, whose top stays plane; the block is
held below. No natural modes: waves run through the bodies and back {{waves:.0f}} times in a blow, so that they answer
as in statics. {STEPS} time steps, ρ_∞ = 0.8.

What the finite size changes: at the largest force the approach, taken to the middle of the ball's mass, is
{{short:.1f}} % less than Hertz' of that force, which is the approach of points at infinity. The shortfall grows like
the force, and is about inverse to the size. The blow of a rigid mass on that very relation of force and approach,
with a fitted shortfall, is what the last claims are held against: what is left is the error of the time steps.
"""


@dataclass(frozen=True)
class Fall:
    """The blow over time.

    time:     (n,), of the ends of the time steps [s].
    force:    (n,), on the whole contact [N].
    approach: (n,), of the middle of the ball's mass [mm].
    mass:     of the whole ball [t].
    energy:   (n,), of a quarter, over that at the start.
    speed:    after the blow, over that before.
    """

    time: Floats
    force: Floats
    approach: Floats
    mass: float
    energy: Floats
    speed: float

    @property
    def duration(self) -> float:
        """[s] from where the ball touches; the end of the last step is interpolated: F^⅔ falls like the approach."""
        root, last = self.force ** (2.0 / 3.0), int(np.flatnonzero(self.force)[-1])
        step = self.time[1] - self.time[0]
        return float(self.time[last] + step * root[last] / (root[last - 1] - root[last]))

    @property
    def shortfall(self) -> float:
        """By how much the approach is less than Hertz', over the force [mm/N]: least squares."""
        return float(self.force @ (hertz_approach(self.force) - self.approach) / (self.force @ self.force))


def hertz_approach(force: Floats) -> Floats:
    """δ [mm] of forces [N]: F = 4/3 E*√R δ^(3/2)."""
    return np.asarray((0.75 * np.asarray(force) / (MODULUS * np.sqrt(RADIUS))) ** (2.0 / 3.0))


def problem() -> Problem:
    """Quarters of both bodies; facets within 1.5 a may touch."""
    size, fine, near = CONTACT / CELLS, 1.1 * CONTACT, 1.5 * CONTACT
    ball = ring_sphere(RADIUS, SIDE, SIDE, CONTACT, size, fine, growth=GROWTH, fine_depth=CONTACT)
    block = ring_block(SIDE, SIDE, CONTACT, size / 1.25, fine, growth=GROWTH, fine_depth=CONTACT)
    symmetry, falls = (Fixed("symmetry_x", "x"), Fixed("symmetry_y", "y")), Rigid("top", (Freedom("z", load=0.0),))
    heavy = Material(density=0.25 * MASS / volume())
    bodies = (
        Body(with_part(ball, "arc", "near", near), heavy, supports=symmetry, rigid=falls, name="ball"),
        Body(with_part(block, "top", "near", near), heavy, supports=(*symmetry, Fixed("bottom")), name="block"),
    )
    return Problem(bodies, (Contact((0, "near"), (1, "near"), reach=CONTACT),))


def volume() -> float:
    """Of a quarter of a cylinder above a sphere [mm³]."""
    cap = 2.0 / 3.0 * (RADIUS**3 - (RADIUS**2 - SIDE**2) ** 1.5)  # ∫ √(R² − r²) r dr from 0 to SIDE, twice
    below = np.pi * (RADIUS * SIDE**2 - cap)
    return 0.25 * float(np.pi * SIDE**3 - below)


def dropped() -> Fall:
    """Solves the blow."""
    step = 2.9433 * APPROACH / SPEED / STEPS
    run = Transient(problem(), TransientSettings(step, modes=0), InitialState(velocities={0: (0.0, 0.0, -SPEED)}))
    moments = list(run.run(int(LAST * STEPS)))
    energy = np.array([moment.energy.total for moment in moments])
    mass = 4.0 * float(run.bodies[0].axes.rigid_mass[0, 0])
    return Fall(
        np.array([moment.time for moment in moments]),
        np.array([4.0 * abs(moment.solution.contacts[0].force[2]) for moment in moments]),
        np.array([-moment.solution.motions[0][0] for moment in moments]),
        mass,
        energy / (0.125 * mass * SPEED**2),
        moments[-1].velocities[0][0] / SPEED,
    )


@dataclass(frozen=True)
class RigidBlow:
    """The blow of a rigid mass whose force F makes the approach δ(F) − shortfall F, δ being Hertz'.

    mass:      [t].
    shortfall: [mm/N].
    """

    mass: float
    shortfall: float = 0.0

    @property
    def largest(self) -> float:
        """The largest force [N], at which all energy is elastic."""
        above = 2.0 * self.mass * SPEED**2 / APPROACH
        return float(brentq(lambda force: self.work(force) - 0.5 * self.mass * SPEED**2, 0.0, above))

    def work(self, force: Floats) -> Floats:
        """∫ F dδ up to a force [N·mm]."""
        return np.asarray(0.4 * hertz_approach(force) * force - 0.5 * self.shortfall * force**2)

    @property
    def rise(self) -> tuple[Floats, Floats]:
        """Times [s] and forces [N], (n,), up to the largest force; afterwards the same backwards."""
        force = self.largest * np.sin(np.linspace(0.0, 0.5 * np.pi, 8001)) ** 3  # as smooth as the motion at both ends
        approach = hertz_approach(force) - self.shortfall * force
        speed = np.sqrt(SPEED**2 - 2.0 * self.work(force[1::2]) / self.mass)
        return np.append(0.0, np.cumsum(np.diff(approach[::2]) / speed)), force[::2]

    @property
    def duration(self) -> float:
        """[s]."""
        return 2.0 * float(self.rise[0][-1])


def verify() -> Verification:
    """Solves it once."""
    fall = dropped()
    hertz, rigid = RigidBlow(fall.mass), RigidBlow(fall.mass, fall.shortfall)
    short = fall.shortfall * rigid.largest / float(hertz_approach(np.array(rigid.largest)))
    waves = rigid.duration * float(np.sqrt(STEEL.youngs_modulus / STEEL.density)) / (2.0 * SIDE)
    impact = analytical("Hertz' impact; Johnson 1985, section 11.4")
    finite = regression("rigid mass on the relation of force and approach of bodies of this size")
    return Verification(
        "dropped_ball",
        "Ball dropped on a block",
        PROBLEM.format(waves=waves, short=100.0 * short),
        (
            impact.relative("time of contact 2.9433 δ/v [µs]", 1e6 * fall.duration, 1e6 * hertz.duration, 0.02),
            impact.relative("largest force [N]", fall.force.max(), hertz.largest, 0.02),
            analytical("an elastic blow").relative("speed after the blow over that before", fall.speed, 1.0, 0.005),
            finite.relative("time of contact, without the size [µs]", 1e6 * fall.duration, 1e6 * rigid.duration, 0.005),
            finite.relative("largest force, without the size [N]", fall.force.max(), rigid.largest, 0.005),
        ),
        lambda figure: draw(figure, fall, hertz, rigid),
        "Time of contact and largest force are Hertz'; bodies of finite size are a little stiffer than half-spaces",
    )


def draw(figure: Figure, fall: Fall, hertz: RigidBlow, rigid: RigidBlow) -> None:
    """Force over time, and force over approach."""
    left, right = figure.subplots(1, 2, width_ratios=(1.3, 1.0))
    for blow, colour, style, name in ((hertz, INK, "-", "Hertz"), (rigid, WHEEL, "--", "Hertz, less the size")):
        time, force = blow.rise
        mirrored = np.concatenate([time, blow.duration - time[::-1]]), np.concatenate([force, force[::-1]])
        left.plot(1e6 * mirrored[0], 1e-3 * mirrored[1], style, color=colour, lw=1.2, label=name)
        approach = hertz_approach(force) - blow.shortfall * force
        right.plot(1e3 * approach, 1e-3 * force, style, color=colour, lw=1.2, label=name)
    left.plot(1e6 * fall.time, 1e-3 * fall.force, "o", color=PINION, ms=4, label=f"found, {STEPS} time steps")
    pressed = fall.force > 0.0
    right.plot(1e3 * fall.approach[pressed], 1e-3 * fall.force[pressed], "o", color=PINION, ms=4, label="found")
    left.set(xlabel="time [µs]", ylabel="contact force [kN]", ylim=(0.0, None))
    right.set(xlabel="approach [µm]", ylabel="contact force [kN]", xlim=(0.0, None), ylim=(0.0, None))
    left.legend(loc="lower center")
    right.legend(loc="upper left")
