"""Contact of bodies with inertia over time: `Transient`, step by step.

docs/transient_method.md has the method.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from evolvent.contact.problem.condensed_body import condense_bodies
from evolvent.contact.problem.definition import Problem, Step, numbered_step
from evolvent.contact.problem.user_warnings import warn_user
from evolvent.contact.step.step_solution import Solution
from evolvent.contact.transient.adaptive_steps import StepLengths
from evolvent.contact.transient.beginning import Reached, begun, check
from evolvent.contact.transient.conserving_step import PlacedPairs, solve_conserving_step
from evolvent.contact.transient.energy import Energy
from evolvent.contact.transient.moving_body import MovingBody
from evolvent.contact.transient.one_step import SolvedStep, solve_step
from evolvent.contact.transient.saved_state import read_state, write_state
from evolvent.contact.transient.settings import InitialState, TransientSettings
from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError
from evolvent_meshes.input_checks import instance, number, refuse

Loading = Step | Callable[[float], Step] | None
"""Loads and prescribed motions as a function of time [s], or constant; None: the full load."""


class CoarseTimeStepWarning(UserWarning):
    """The shortest time step is too long for the tolerance."""


@dataclass(frozen=True)
class MotionState:
    """The state at the end of a time step.

    time: [s].
    solution: contacts, forces and motions, as of a static step; its rigid motions are those of the bodies' mean axes.
    velocities: per body, of its rigid motions (r,) [mm/s, rad/s].
    energy: of all bodies.
    work: of all loads and prescribed motions since the start [N·mm; N in 2D].
    length: of the time step [s].
    error: estimated error of the speeds in the step, over the largest speed so far (adaptive_steps.py).
    systems: contact systems that were solved for it.
    """

    time: float
    solution: Solution
    velocities: tuple[Floats, ...]
    energy: Energy
    work: float
    length: float
    error: float
    systems: int


Moment = MotionState
"""Earlier name of `MotionState`."""


class Transient:
    """Moves a problem on in time, step by step.

    problem: its bodies are condensed and their modes computed once, at the first step. Symmetric Nitsche's method only.
    settings: of the method.
    start: the state at time 0.

    A step that fails leaves the transient as it was. Raises InputError.
    """

    def __init__(self, problem: Problem, settings: TransientSettings, start: InitialState | None = None) -> None:
        instance("transient, problem", problem, Problem, "write Problem(bodies, contacts)")
        instance("transient, settings", settings, TransientSettings, "write TransientSettings(time_step=1e-6)")
        start = InitialState() if start is None else start
        instance("transient, start", start, InitialState, "write InitialState(velocities={1: (0.0, -1000.0)})")
        self.problem, self.settings, self.start = problem, settings, start.numbered(problem)
        check(problem, settings, self.start)
        self._scheme, self._lengths = TimeScheme(settings.spectral_radius), StepLengths.of(settings)
        self._reached: Reached | None = None
        self._pairs = PlacedPairs()
        self._warned = 0.0

    @cached_property
    def bodies(self) -> tuple[MovingBody, ...]:
        """The bodies with their modes."""
        settings = self.settings
        condensed = condense_bodies(self.problem)
        return tuple(MovingBody.of(body, settings.modes, settings.damping_ratio) for body in condensed)

    @property
    def time(self) -> float:
        """Time until which the transient has been solved [s]."""
        return 0.0 if self._reached is None else self._reached.time

    def solve(self, step: Loading = None) -> MotionState:
        """The end of the next time step, under the loads and prescribed motions of `step` there.

        With a tolerance a step that has a larger error, or cannot be solved, is tried again with a shorter one. Warns
        of larger errors of the shortest step by a CoarseTimeStepWarning.

        Raises InputError, NotConverged, SearchError, PairingNotSettled, SmallStrainExceeded, NotPositiveDefinite,
        EnergyGrowth, EnergyNotKept.
        """
        return self._solve(step, np.inf)

    def run(self, steps: Sequence[Step] | int) -> Iterator[MotionState]:
        """One time step after another: under each of these loads, or so many under the full load. Raises as `solve`."""
        for step in [None] * steps if isinstance(steps, int) else steps:
            yield self.solve(step)

    def run_until(self, time: float, step: Loading = None) -> Iterator[MotionState]:
        """One time step after another to this time [s], as `solve`; the last two are as short as it takes to end there.

        step: with a function of time, at the end of each step. Raises as `solve`.
        """
        number("transient, time", time, "a finite time >= 0 [s]", "give one in s", lambda t: t >= 0.0)
        while (left := self._lengths.left(self.time, time)) > 0.0:
            yield self._solve(step, left)

    def save(self, path: Path | str) -> Path:
        """Saves the state of the transient in a file, from which `resume` continues; returns its path.

        Replaces an earlier state of this transient, and no other file. Raises InputError, WriteError.
        """
        if self._reached is None:
            refuse("transient, save", "at least one step solved", 0, "call solve, run or run_until first")
        return write_state(Path(path), self.problem, self.settings, self.bodies, self._reached)

    @staticmethod
    def resume(path: Path | str, problem: Problem, settings: TransientSettings) -> Transient:
        """A transient that goes on from where one of the same problem was saved, bit for bit as that would have.

        settings: the same modes, damping ratio, spectral radius and conserving; lengths of time steps may differ.
        Raises InputError for a file that is no such state.
        """
        run = Transient(problem, settings)
        run._reached = read_state(Path(path), problem, settings, run.bodies)
        return run

    def _solve(self, loading: Loading, left: float) -> MotionState:
        """The next time step, of at most `left` [s]."""
        bodies = self.bodies
        before = self._reached or begun(
            self.problem, bodies, self._scheme, self.start, self._step_at(loading, 0.0), self.settings.time_step
        )
        planned = self._lengths.planned(before.next_length)
        tried = self._lengths.first(planned, left)
        solved = self._accepted(before, loading, tried)
        length = solved.reached.length
        following = self._lengths.after(length, solved.error, planned if length == tried else None)
        self._reached = replace(solved.reached, next_length=following)
        self._warn_if_coarse(solved)
        velocities = tuple(
            motion.state.velocity[body.count :] for body, motion in zip(bodies, self._reached.motions)
        )
        return MotionState(
            self.time, solved.solution, velocities, solved.energy, self._reached.balance.work, length, solved.error,
            solved.systems,
        )

    def _accepted(self, before: Reached, loading: Loading, length: float) -> SolvedStep:
        """The first step that is accepted, from this length on downwards."""
        while True:
            step = self._step_at(loading, before.time + length)
            try:
                solved = self._solve_step(before, step, length)
            except ResultError:
                if not self._lengths.can_shrink(length):
                    raise
                length = self._lengths.shorter(length, None)
                continue
            if solved.error <= self._lengths.tolerance or not self._lengths.can_shrink(length):
                return solved
            length = self._lengths.shorter(length, solved.error)
            before = replace(before, balance=before.balance.seen(solved.energy.total))

    def _solve_step(self, before: Reached, step: Step, length: float) -> SolvedStep:
        if self.settings.conserving:
            return solve_conserving_step(self.problem, self.bodies, before, step, length, self._pairs)
        return solve_step(self.problem, self.bodies, self._scheme, before, step, length)

    def _step_at(self, loading: Loading, time: float) -> Step:
        step = loading(time) if callable(loading) else loading
        return numbered_step(self.problem, Step() if step is None else step)

    def _warn_if_coarse(self, solved: SolvedStep) -> None:
        """Warns of the first error beyond the tolerance, and of errors that are twice as large as the last one warned
        of."""
        if solved.error > max(self._lengths.tolerance, 2.0 * self._warned):
            self._warned = solved.error
            warn_user(
                f"transient at {solved.reached.time:.4g} s: wanted an error of a step of at most "
                f"{self._lengths.tolerance:.2g} of the largest speed, found {solved.error:.2g} with the shortest step "
                f"of {solved.reached.length:.3g} s. Give a smaller shortest_step, a larger tolerance, or fewer modes; "
                "no step resolves loads and motions that jump",
                CoarseTimeStepWarning,
            )
