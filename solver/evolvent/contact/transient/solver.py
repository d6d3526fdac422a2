"""Contact of bodies with inertia over time: `Transient`, step by step.

docs/transient.md has the method.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.problem.condensed_body import condense_bodies
from evolvent.contact.problem.definition import Problem, Step, check_step
from evolvent.contact.step.displaced_search import solve_with_displaced_search
from evolvent.contact.step.step_solution import DeformedSurfaces, Solution
from evolvent.contact.step.step_system import SearchPositions, StepSystem, motions_at
from evolvent.contact.transient.energy import Energy, contact_energy, load_work, motion_energy, rest_energy
from evolvent.contact.transient.moving_body import MovingBody
from evolvent.contact.transient.moving_response import MovingResponse
from evolvent.contact.transient.settings import InitialState, TransientSettings
from evolvent.contact.transient.time_scheme import MotionState, TimeScheme, TimeStep
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError, ResultError
from evolvent_meshes.input_checks import instance, refuse

GROWTH = 0.02
"""Of the largest energy so far: by how much it may seem to grow. Within a blow the sum of energies at the ends of time
steps swings by 0.4 % with 20 steps a blow of a ball, 0.05 % with 40."""


@dataclass(frozen=True)
class Moment:
    """The state at the end of a time step.

    time: [s].
    solution: contacts, forces and motions, as of a static step; its rigid motions are those of the bodies' mean axes.
    velocities: per body, of its rigid motions (r,) [mm/s, rad/s].
    energy: of all bodies.
    work: of all loads since the start [N·mm; N in 2D].
    """

    time: float
    solution: Solution
    velocities: tuple[Floats, ...]
    energy: Energy
    work: float


@dataclass(frozen=True)
class _Reached:
    """What the next step begins with."""

    time: float
    states: tuple[MotionState, ...]
    responses: tuple[MovingResponse, ...]
    forces: tuple[Floats, ...]
    deformed: DeformedSurfaces | None
    energy: Energy
    work: float
    first: float
    largest: float


class EnergyGrowth(ResultError):
    """The bodies have more energy than they had at the start and were given by loads."""


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
        self.problem, self.settings, self.start = problem, settings, InitialState() if start is None else start
        instance("transient, start", self.start, InitialState, "write InitialState(velocities={1: (0.0, -1000.0)})")
        _check(problem, self.start)
        self._scheme = TimeScheme(settings.spectral_radius)
        self._reached: _Reached | None = None

    @cached_property
    def bodies(self) -> tuple[MovingBody, ...]:
        """The bodies with their modes."""
        settings = self.settings
        condensed = condense_bodies(self.problem)
        return tuple(MovingBody.of(body, settings.modes, settings.damping_ratio) for body in condensed)

    @property
    def time(self) -> float:
        """[s] that have been solved."""
        return 0.0 if self._reached is None else self._reached.time

    def solve(self, step: Step | None = None) -> Moment:
        """The end of the next time step, under the loads and prescribed motions of `step` (by default the full load).

        Raises InputError, NotConverged, SearchError, PairingNotSettled, SmallStrainExceeded, NotPositiveDefinite,
        EnergyGrowth.
        """
        step = Step() if step is None else step
        check_step(self.problem, step)
        reached = self._reached or self._started(step)
        responses = tuple(
            self._response(index, step, TimeStep(body.system, self._scheme, state, self.settings.time_step))
            for index, (body, state) in enumerate(zip(self.bodies, reached.states))
        )
        solution, deformed = self._solved(step, reached.deformed, responses)
        after = self._after(reached, responses, solution, deformed)
        _refuse_energy_growth(after)
        self._reached = after
        velocities = tuple(state.velocity[body.count :] for body, state in zip(self.bodies, after.states))
        return Moment(after.time, solution, velocities, after.energy, after.work)

    def run(self, steps: Sequence[Step] | int) -> Iterator[Moment]:
        """One time step after another: under each of these loads, or so many under the full load. Raises as `solve`."""
        for step in [None] * steps if isinstance(steps, int) else steps:
            yield self.solve(step)

    def _solved(
        self, step: Step, previous: DeformedSurfaces | None, responses: tuple[MovingResponse, ...]
    ) -> tuple[Solution, DeformedSurfaces]:
        condensed = tuple(body.condensed for body in self.bodies)

        def system_of(problem: Problem, search_at: SearchPositions) -> StepSystem:
            return StepSystem(problem, condensed, step, search_at, responses=responses)

        _, solution, deformed = solve_with_displaced_search(system_of, self.problem, previous)
        return solution, deformed

    def _response(self, index: int, step: Step, time_step: TimeStep) -> MovingResponse:
        body = self.bodies[index]
        motions = motions_at(step, index, body.condensed.assembled)
        if not np.array_equal(motions.free, body.free):
            raise InputError(
                f"transient, step: wanted the same motions of body {index} prescribed as in its Rigid, found others; "
                "give a loaded freedom another load, a prescribed one another displacement"
            )
        return MovingResponse(body, time_step, step.load, motions.load[body.free], motions.value)

    def _after(
        self, before: _Reached, responses: tuple[MovingResponse, ...], solution: Solution, deformed: DeformedSurfaces
    ) -> _Reached:
        forces = solution.nodal_forces
        states = tuple(r.state(f, δ) for r, f, δ in zip(responses, forces, solution.motions))
        work = before.work + sum(
            load_work(then, now, (a, b), (f, g))
            for then, now, a, b, f, g in zip(before.responses, responses, before.states, states, before.forces, forces)
        )
        energy = self._energy(states, responses, solution)
        time = before.time + self.settings.time_step
        largest = max(before.largest, energy.total)
        return _Reached(time, states, responses, forces, deformed, energy, work, before.first, largest)

    def _energy(
        self, states: tuple[MotionState, ...], responses: tuple[MovingResponse, ...], solution: Solution | None
    ) -> Energy:
        parts = [motion_energy(body.system, state) for body, state in zip(self.bodies, states)]
        kinetic, elastic = (sum(each) for each in zip(*parts))
        if solution is None:
            return Energy(kinetic, elastic + sum(rest_energy(r, np.zeros(len(r.body.rest))) for r in responses), 0.0)
        elastic += sum(rest_energy(r, f) for r, f in zip(responses, solution.nodal_forces))
        return Energy(kinetic, elastic, contact_energy(solution.contacts))

    def _started(self, first: Step) -> _Reached:
        """The state at time 0. first: of the first time step, whose loads act from the start where there is no static
        state."""
        step = self.start.step or first
        solution, deformed = None, None
        forces = tuple(np.zeros(len(body.condensed.compliance)) for body in self.bodies)
        positions = [np.zeros(len(body.system.stiffness)) for body in self.bodies]
        if self.start.step is not None:
            condensed = tuple(body.condensed for body in self.bodies)
            system = StepSystem(self.problem, condensed, step)
            solution, deformed = system.solve(None)
            forces = solution.nodal_forces
        states, responses = [], []
        for index, body in enumerate(self.bodies):
            nothing = MotionState(positions[index], positions[index], positions[index])
            response = self._response(index, step, TimeStep(body.system, self._scheme, nothing, 1.0))
            if solution is not None:
                positions[index] = body.at_rest(forces[index], step.load, response.resultant, solution.motions[index])
            states.append(_initial(response, positions[index], self._velocity(index), forces[index]))
            responses.append(response)
        energy = self._energy(tuple(states), tuple(responses), solution)
        total = energy.total
        return _Reached(0.0, tuple(states), tuple(responses), forces, deformed, energy, 0.0, total, total)

    def _velocity(self, index: int) -> Floats:
        """Of modes and rigid motions (m + r). Raises InputError for one that the body's supports do not allow."""
        body = self.bodies[index]
        velocity = np.zeros(len(body.system.stiffness))
        if index not in self.start.velocities:
            return velocity
        wanted = np.array(self.start.velocities[index])
        shapes = body.condensed.assembled.motions.shapes[:, :, body.free]
        whole = np.broadcast_to(wanted, shapes.shape[:2]).ravel()
        flat = shapes.reshape(len(whole), -1)
        rates = np.linalg.lstsq(flat, whole, rcond=None)[0]
        if np.abs(flat @ rates - whole).max() > 1e-9 * np.abs(wanted).max():
            refuse(
                f"initial state, velocity of body {index}", "one along its free rigid motions",
                self.start.velocities[index],
                "free the motion by a Freedom of its Rigid, or leave out the support that stops it",
            )  # fmt: skip
        velocity[body.count + body.free] = rates
        return velocity


def _refuse_energy_growth(at: _Reached) -> None:
    """Raises EnergyGrowth. Prescribed motions do work that is not counted: with them nothing is checked."""
    if any(len(response.body.free) < len(response.prescribed) for response in at.responses):
        return
    gained = at.energy.total - at.first - at.work
    if gained > GROWTH * at.largest:
        raise EnergyGrowth(
            f"transient at {at.time:.4g} s: wanted at most the energy of the start and the work of the loads, found "
            f"{gained / at.largest:.1%} more; take shorter time steps, or a smaller spectral_radius"
        )


def _contact_force(response: MovingResponse, forces: Floats) -> Floats:
    """Of the contact on modes and rigid motions (m + r) of a body."""
    body = response.body
    return np.concatenate([body.functionals.T @ forces, body.condensed.motion_shapes.T @ forces])


def _initial(response: MovingResponse, position: Floats, velocity: Floats, forces: Floats) -> MotionState:
    """The state at the start, with the acceleration of its equation of motion; prescribed motions are at rest."""
    body, system = response.body, response.body.system
    m, free = body.count, body.count + body.free
    force = _contact_force(response, forces)
    force[:m] += body.modal_load(response.factor, response.resultant)
    force[free] += response.resultant
    moving = np.concatenate([np.arange(m), free])
    rest = (force - system.damping * velocity - system.stiffness * position)[moving]
    acceleration = np.zeros(len(position))
    acceleration[moving] = np.linalg.solve(system.mass[np.ix_(moving, moving)], rest)
    return MotionState(position, velocity, acceleration)


def _check(problem: Problem, start: InitialState) -> None:
    """Raises InputError for what a transient cannot have."""
    if problem.nitsche.theta != 1.0:
        found = f"theta = {problem.nitsche.theta:g}"
        refuse("transient", "the symmetric variant, theta = 1", found, "leave out theta: other variants have no energy")
    if any(support.displacement for body in problem.bodies for support in body.supports):
        refuse(
            "transient", "supports at rest", "a Fixed with a displacement",
            "move the face by Rigid with Freedom(direction, displacement=...)",
        )  # fmt: skip
    for index, v in start.velocities.items():
        if not 0 <= index < len(problem.bodies):
            wanted = f"body indices below {len(problem.bodies)}"
            refuse("initial state, velocities", wanted, index, "bodies are counted from 0")
        if len(v) != (d := problem.bodies[index].mesh.dimension):
            refuse(f"velocity of body {index}", f"{d} components, as the body is {d}D", v, "give as many")
