"""Initial state of a transient, and the settings of its method."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from evolvent.contact.problem.body_names import body_number, is_body
from evolvent.contact.problem.definition import Problem, Step, numbered_step
from evolvent.fem.body import Body
from evolvent_meshes.input_checks import Words, instance, is_index, number, refuse, vector

MODES = 20
"""Default number of natural modes of each body."""
DAMPED = 0.8
"""Default spectral radius ρ_∞: motions too fast for the step lose a fifth of their amplitude in each."""

SHORTEST = 1e-3
"""Default shortest time step, over the longest one."""


@dataclass(frozen=True)
class TransientSettings:
    """The method of a transient.

    time_step: [s]; with a tolerance the first and the longest one.
    modes: natural modes of each body that have inertia; the others respond statically.
    damping_ratio: of each mode, over the critical one.
    spectral_radius: ρ_∞ of the method, from 0 (motions too fast for the step are gone in one) to 1 (they stay for ever,
        and blows may add energy).
    tolerance: estimated error of the speeds in a time step, over the largest speed (adaptive_steps.py), up to which it
        is accepted; None: all steps are equal.
    shortest_step: [s], accepted with any error, with a warning; by default a thousandth of time_step.
    conserving: keep the energy in each step, but for loads and damping (conserving_step.py). For contact without
        friction; steps are equal, there is no spectral_radius, and each takes two contact systems or more.
    Raises InputError.

    >>> TransientSettings(time_step=1e-5, tolerance=1e-3).least_step
    1e-08
    """

    time_step: float
    modes: int = MODES
    damping_ratio: float = 0.0
    spectral_radius: float = DAMPED
    tolerance: float | None = None
    shortest_step: float | None = None
    conserving: bool = False

    def __post_init__(self) -> None:
        number("transient, time_step", self.time_step, "a finite number > 0 [s]", "give one in s", lambda h: h > 0.0)
        if not (is_index(self.modes) and self.modes >= 0):
            refuse("transient, modes", "a whole number from 0 on", self.modes, f"{MODES} are the default")
        number(
            "transient, damping_ratio", self.damping_ratio, "a number from 0 to 1", "0.01 is one per cent",
            lambda ζ: 0.0 <= ζ <= 1.0,
        )
        number(
            "transient, spectral_radius", self.spectral_radius, "a number from 0 to 1", f"{DAMPED:g} is the default",
            lambda ρ: 0.0 <= ρ <= 1.0,
        )
        self._check_adaptive()
        self._check_conserving()

    @property
    def least_step(self) -> float:
        """Shortest time step [s]."""
        return SHORTEST * self.time_step if self.shortest_step is None else self.shortest_step

    def _check_adaptive(self) -> None:
        if self.tolerance is not None:
            wanted, remedy = "a number between 0 and 1", "1e-3 is usual; leave it out for equal steps"
            number("transient, tolerance", self.tolerance, wanted, remedy, lambda ε: 0.0 < ε < 1.0)
        if self.shortest_step is None:
            return
        if self.tolerance is None:
            refuse("transient, shortest_step", "none without a tolerance", self.shortest_step, "give a tolerance, too")
        number(
            "transient, shortest_step", self.shortest_step, f"a number above 0 and up to time_step, {self.time_step:g}",
            f"leave it out for {SHORTEST:g} of time_step", lambda h: 0.0 < h <= self.time_step,
        )

    def _check_conserving(self) -> None:
        instance("transient, conserving", self.conserving, bool, "write conserving=True, or leave it out")
        if not self.conserving:
            return
        if self.spectral_radius != DAMPED:
            found = f"spectral_radius = {self.spectral_radius:g}"
            refuse("transient, conserving", "no spectral_radius", Words(found), "leave out one of both")
        if self.tolerance is not None:
            remedy = "leave out tolerance, or conserving"
            refuse("transient, conserving", "equal steps", Words(f"tolerance = {self.tolerance:g}"), remedy)


@dataclass(frozen=True)
class InitialState:
    """The state at time 0.

    step: its static equilibrium, from which the transient begins; None: undeformed as placed, nothing in contact.
    velocities: a body or its index -> velocity (d,) [mm/s] with which it moves, without turning. The others are at
        rest.
    Raises InputError.

    >>> InitialState(velocities={1: (0.0, -1000.0)}).velocities[1]
    (0.0, -1000.0)
    """

    step: Step | None = None
    velocities: Mapping[Any, tuple[float, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.step is not None:
            instance("initial state, step", self.step, Step, "write InitialState(Step()), or leave it out")
        if not isinstance(self.velocities, Mapping) or not all(map(is_body, self.velocities)):
            wanted = "bodies, or their indices, with velocities"
            refuse("initial state, velocities", wanted, self.velocities, "write {1: (0.0, -1000.0)}")
        wanted = "two finite components [mm/s] in 2D, three in 3D"
        given = {
            body: vector(f"velocity of body {_name(body)}", v, (2, 3), wanted, "give one number a direction")
            for body, v in self.velocities.items()
        }
        object.__setattr__(self, "velocities", given)

    def numbered(self, problem: Problem) -> InitialState:
        """The state with indices in place of bodies. Raises InputError for a body that is not in the problem."""
        numbers = [body_number(problem.bodies, body, "initial state, velocities") for body in self.velocities]
        if len(set(numbers)) < len(numbers):
            refuse("initial state, velocities", "each body once", Words(numbers), "leave out one of the two")
        step = None if self.step is None else numbered_step(problem, self.step)
        return replace(self, step=step, velocities=dict(zip(numbers, self.velocities.values())))


def _name(body: int | Body) -> str:
    return repr(body.name) if isinstance(body, Body) else str(body)
