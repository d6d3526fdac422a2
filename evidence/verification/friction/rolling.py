"""A driven cylinder rolls over a block of the same steel until its traction is steady (Carter 1926)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from demos.hertz_cylinder import Profile
from evidence.claims import Claim, Verification, analytical
from evolvent import Contact, Placement, Problem, Solution, Step, sweep
from evolvent.contact import hertz
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import STEEL
from evolvent.results.drawing.style import INK, PINION, TEETH, WHEEL, friction_colours
from evolvent_meshes.arrays import Floats
from evolvent_meshes.rotation import turn
from evolvent_meshes.shapes.blocks import cylinder_2d, graded_rectangle
from evolvent_meshes.shapes.variants import with_part

RADIUS, HALF_WIDTH, FRICTION, SHARE = 50.0, 0.05, 0.3, 0.5  # R, b [mm], μ, Q/μP
CELLS = 8  # on the half-width
DISTANCE = 4.0  # rolled, in half-widths
STEPS = (4, 8, 16)  # a half-width
MODULUS = 0.5 * STEEL.plane_modulus  # E* of two alike bodies
LOAD = np.pi * MODULUS * HALF_WIDTH**2 / (4.0 * RADIUS)  # P [N/mm]
PEAK = hertz.line_peak_pressure(LOAD, RADIUS, MODULUS)
CARTER = hertz.carter(HALF_WIDTH, RADIUS, FRICTION, SHARE)
GRID = np.linspace(-1.5, 1.5, 6001) * HALF_WIDTH
SOURCE = "Carter; Johnson 1985, section 8.3"


@dataclass(frozen=True)
class Rolled:
    """A cylinder that rolled to the right.

    steps:     a half-width.
    rolled:    (k,), distances since Q was put on [mm].
    solutions: at each distance.
    """

    steps: int
    rolled: Floats
    solutions: list[Solution]

    @cached_property
    def profiles(self) -> list[Profile]:
        """Pressure and traction at each distance; x from the middle of the contact, positive ahead."""
        return [Profile.of(solution.contacts[0], HALF_WIDTH) for solution in self.solutions]

    @cached_property
    def errors(self) -> Floats:
        """Relative L2 distance of the traction from Carter's at each distance."""
        return np.array([p.error(carter_profile(GRID), "shear") for p in self.profiles])

    @cached_property
    def creep(self) -> Floats:
        """(k − 1,) motion of the cylinder's centre beyond rolling without slip, per distance rolled [-]."""
        shift = np.array([self._shift(k) for k in range(len(self.rolled))])
        return np.asarray(np.diff(shift) / np.diff(self.rolled))

    def _shift(self, k: int) -> float:
        """Motion of the centre [mm] along the block beyond rolling; the freedoms are those of the turned cylinder."""
        placement = self.solutions[k].step.placements
        assert placement is not None
        return float((placement[0].rotation @ self.solutions[k].motions[0])[0])

    @property
    def steady_error(self) -> float:
        """The error's mean over the last half-width rolled: it changes as nodes enter the contact."""
        return float(np.mean(self.errors[-self.steps :]))

    @property
    def steady_creep(self) -> float:
        """The mean over the last half-width rolled."""
        return float(np.mean(self.creep[-self.steps :]))

    @property
    def stick(self) -> tuple[float, float]:
        """Rear and front end of the stick zone over b, at the end."""
        p = self.profiles[-1]
        x = p.x[np.abs(p.shear) < FRICTION * p.pressure * (1.0 - 1e-9)] / HALF_WIDTH
        return float(x.min()), float(x.max())

    @property
    def front(self) -> float:
        """Front end of the contact over b, at the end."""
        p = self.profiles[-1]
        return float(p.x[p.pressure > 0.0].max() / HALF_WIDTH)


def carter_profile(x: Floats) -> Profile:
    """Hertz' pressure and Carter's traction, whose stick zone touches the front."""
    b, c = HALF_WIDTH, CARTER.stick_half_width
    p = hertz.line_pressure(x, b, PEAK)
    q = FRICTION * (p - c / b * hertz.line_pressure(x - CARTER.stick_centre, c, PEAK))
    return Profile(x, p, q, b)


def problem() -> Problem:
    """The coarser surface, the cylinder's, carries the pressure; both are fine wherever they meet."""
    size, fine = HALF_WIDTH / CELLS, (0.5 * DISTANCE + 1.5) * HALF_WIDTH
    freedoms = (Freedom("x", displacement=0.0), Freedom("y", load=-LOAD))
    cylinder = Body(cylinder_2d(RADIUS, size, fine, contact=fine), STEEL, rigid=Rigid("top", freedoms), name="cylinder")
    mesh = graded_rectangle(2.0 * RADIUS, 2.0 * RADIUS, size / 1.37, fine, fine_depth=0.75 * HALF_WIDTH)
    block = Body(with_part(mesh, "top", "met", fine), STEEL, (Fixed("bottom"),), name="block")
    return Problem((cylinder, block), (Contact((0, "arc"), (1, "met"), FRICTION, reach=0.25 * HALF_WIDTH),))


def placements(distance: float) -> tuple[Placement, Placement]:
    """Rolled by this distance [mm] to the right, seen from the cylinder's centre: it turns, the block moves left."""
    rotation, centre = turn(-distance / RADIUS, 2), np.array([0.0, RADIUS])
    return Placement(rotation, centre - rotation @ centre), Placement(np.eye(2), np.array([-distance, 0.0]))


def roll(steps: int) -> Rolled:
    """Presses, pushes without rolling (Cattaneo), then rolls at constant P and Q."""
    count = round(DISTANCE * steps)
    travel = np.linspace(-0.5, 0.5, count + 1) * DISTANCE * HALF_WIDTH
    press = Step(placements=placements(travel[0]))
    solutions = list(sweep(problem(), [press, *(_loaded(distance) for distance in travel)]))
    return Rolled(steps, travel - travel[0], solutions[1:])


def _loaded(distance: float) -> Step:
    """P down and Q to the right, in the frame of the turned cylinder."""
    stand = placements(distance)
    force = stand[0].rotation.T @ np.array([SHARE * FRICTION * LOAD, -LOAD])
    return Step(placements=stand, freedoms=tuple((0, Freedom(d, load=f)) for d, f in zip("xy", force.tolist())))


def verify() -> Verification:
    """The same way rolled with three lengths of step."""
    cases = [roll(steps) for steps in STEPS]
    return Verification(
        "rolling",
        "Tractive rolling of a line contact (Carter)",
        "A steel cylinder (R = 50 mm, b = 0.05 mm, plane strain) is pressed on a steel block with P, pushed with "
        "Q = μP/2, μ = 0.3, and rolls four half-widths at constant P and Q. Cattaneo's traction, which sticks in the "
        "middle, turns into Carter's, whose stick zone of width 2c, c = b√(1 − Q/μP), touches the leading edge, and "
        "the cylinder creeps by μ(b − c)/R. Slip is what the surfaces have moved over each other since the last step: "
        "its error falls with the length of the step. b/R is small because the geometry's own second order, (b/R)², "
        "counts against a creep of order μb/R.",
        tuple(_claims(cases[-1], cases[0])),
        lambda figure: _draw(figure, cases),
        "Within three half-widths Cattaneo's traction turns into Carter's: stick at the front, slip at the rear",
    )


def _claims(case: Rolled, coarse: Rolled) -> list[Claim]:
    exact, node, b = carter_profile(GRID), 0.5 / CELLS, HALF_WIDTH
    carter, end = analytical(SOURCE), analytical(f"the end of the contact: {SOURCE}; ± a node")
    rear, front = case.stick
    force, improved = case.solutions[-1].contacts[0].force, case.steady_error / coarse.steady_error
    steps = f"traction error with steps of b/{case.steps} over that with b/{coarse.steps}"
    wanted = 1.0 - 2.0 * CARTER.stick_half_width / b
    return [
        analytical(f"{SOURCE}; ± a node").absolute("rear end of the stick zone, x/b", rear, wanted, node),
        end.absolute("front end of the stick zone, x/b", front, case.front, node),
        carter.bound("traction, relative L2 error, mean over the last b rolled", case.steady_error, 0.05),
        analytical("Hertz").bound("pressure, relative L2 error", case.profiles[-1].error(exact), 0.025),
        carter.relative("creep", case.steady_creep, CARTER.creep, 0.02),
        analytical("order ½ or better in the step").bound(steps, improved, 0.5),
        analytical("equilibrium").relative(
            "tangential force Q [N/mm]", abs(float(force[0])), SHARE * FRICTION * LOAD, 1e-8
        ),
    ]


def _draw(figure: Figure, cases: list[Rolled]) -> None:
    grid = figure.add_gridspec(2, 2, width_ratios=(1.35, 1))
    _traction(figure.add_subplot(grid[:, 0]), cases[-1])
    _creep(figure.add_subplot(grid[0, 1]), cases)
    _errors(figure.add_subplot(grid[1, 1]), cases)


def _traction(axes: Axes, case: Rolled) -> None:
    scale = FRICTION * PEAK
    x = np.linspace(-1.0, 1.0, 801) * HALF_WIDTH
    exact = carter_profile(x)
    axes.fill_between(x / HALF_WIDTH, exact.pressure / PEAK, color="#eef0f2", label="limit μp (Hertz)")
    start = hertz.cattaneo_traction(x, HALF_WIDTH, FRICTION, PEAK, SHARE)
    axes.plot(x / HALF_WIDTH, start / scale, "--", color=INK, lw=1.2, label="before rolling: Cattaneo")
    axes.plot(x / HALF_WIDTH, exact.shear / scale, color=INK, lw=1.6, label="steady rolling: Carter")
    shown = (0.0, 0.5, 1.0, DISTANCE)
    for rolled, colour in zip(shown, friction_colours(shown), strict=True):
        p = case.profiles[round(rolled * case.steps)]
        axes.plot(p.x / HALF_WIDTH, p.shear / scale, "o-", ms=2.4, lw=0.7, color=colour, label=f"rolled {rolled:g} b")
    axes.annotate("", (1.12, 0.96), (0.74, 0.96), arrowprops={"arrowstyle": "->", "color": INK})
    axes.text(0.93, 1.0, "rolls this way", ha="center", color=INK, fontsize=9)
    axes.set(xlim=(-1.15, 1.15), ylim=(0.0, 1.45), xlabel="x / b", ylabel="traction / μp0")
    axes.legend(loc="upper center", ncols=2)


def _creep(axes: Axes, cases: list[Rolled]) -> None:
    axes.axhline(1e6 * CARTER.creep, color=INK, lw=1.2, label="Carter μ(b − c)/R")
    for case, colour in zip(cases, (TEETH[2], WHEEL, PINION), strict=True):
        middle = 0.5 * (case.rolled[1:] + case.rolled[:-1]) / HALF_WIDTH
        axes.plot(middle, 1e6 * case.creep, color=colour, lw=1.2, label=f"steps of b/{case.steps}")
    axes.set(xlim=(0.0, DISTANCE), ylim=(0.0, None), xlabel="rolled / b", ylabel="creep [10⁻⁶]")
    axes.legend(loc="lower right", fontsize=8)


def _errors(axes: Axes, cases: list[Rolled]) -> None:
    for case, colour in zip(cases, (TEETH[2], WHEEL, PINION), strict=True):
        axes.semilogy(case.rolled / HALF_WIDTH, 100.0 * case.errors, color=colour, lw=1.2, label=f"b/{case.steps}")
    axes.set_yticks((3, 10, 30), ("3", "10", "30"))
    axes.set_yticks((), minor=True)
    axes.set(xlim=(0.0, DISTANCE), ylim=(2, 70), xlabel="rolled / b", ylabel="traction off Carter's [%]")
