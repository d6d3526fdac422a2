"""State from which a time step starts, at time 0 and later, and checks of problems and initial states."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.problem.definition import Problem, Step
from evolvent.contact.step.step_solution import DeformedSurfaces
from evolvent.contact.step.step_system import StepSystem
from evolvent.contact.transient.body_motion import BodyMotion
from evolvent.contact.transient.energy import Energy, EnergyBalance, contact_energy
from evolvent.contact.transient.moving_body import MovingBody
from evolvent.contact.transient.moving_response import MovingResponse
from evolvent.contact.transient.settings import InitialState, TransientSettings
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, TimeScheme, TimeStep
from evolvent.fem.body import Body
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import Words, refuse


@dataclass(frozen=True)
class Reached:
    """State at the end of a time step, or at time 0."""

    time: float
    """Time [s]."""
    length: float
    """Length of the step that ended here [s]; 0 at the start."""
    next_length: float
    """Planned length of the next step [s]."""
    motions: tuple[BodyMotion, ...]
    """Motion of each body."""
    deformed: DeformedSurfaces | None
    """Deformed surfaces from which slip is measured; None: as placed."""
    balance: EnergyBalance
    """Energy balance since the start."""


def begun(
    problem: Problem, bodies: tuple[MovingBody, ...], scheme: TimeScheme, start: InitialState, first: Step,
    length: float,
) -> Reached:
    """The state at time 0. first: the loads, unless the start is a static equilibrium; length: of the first step [s].

    Raises NotConverged, SearchError.
    """
    step = start.step or first
    solution, deformed = None, None
    if start.step is not None:
        solution, deformed = StepSystem(problem, tuple(body.condensed for body in bodies), step).solve(None)
    motions = []
    for index, body in enumerate(bodies):
        position = np.zeros(len(body.system.stiffness))
        forces = np.zeros(len(body.condensed.compliance))
        response = MovingResponse.of(body, index, step, TimeStep.unused(body.system, scheme))
        if solution is not None:
            forces = solution.nodal_forces[index]
            position = body.at_rest(forces, step.load, response.resultant, solution.motions[index])
        velocity = _velocity(body, index, start)
        still = KinematicState(position, velocity, np.zeros_like(position))
        motions.append(_accelerated(BodyMotion(still, position * 0.0, response, forces)))
    total = Energy.of(motions, contact_energy(solution.contacts if solution else ())).total
    return Reached(0.0, 0.0, length, tuple(motions), deformed, EnergyBalance(total, total))


def _velocity(body: MovingBody, index: int, start: InitialState) -> Floats:
    """Initial velocity of modes and rigid motions (m + r) of a body. `check` ensures that free rigid motions alone give
    it."""
    velocity = np.zeros(len(body.system.stiffness))
    if index in start.velocities:
        shapes = body.condensed.assembled.motions.shapes[:, :, body.free]
        whole = np.broadcast_to(start.velocities[index], shapes.shape[:2]).ravel()
        velocity[body.count + body.free] = np.linalg.lstsq(shapes.reshape(len(whole), -1), whole, rcond=None)[0]
    return velocity


def _accelerated(still: BodyMotion) -> BodyMotion:
    """Motion at time 0 with the acceleration from the equation of motion. Prescribed motions are at rest."""
    response, state = still.response, still.state
    body, system = response.body, response.body.system
    m, free = body.count, body.count + body.free
    force = still.contact_force
    force[:m] += body.modal_load(response.factor, response.resultant)
    force[free] += response.resultant
    moving = np.concatenate([np.arange(m), free])
    rest = (force - system.damping * state.velocity - system.stiffness * state.position)[moving]
    acceleration = np.zeros(len(state.position))
    acceleration[moving] = np.linalg.solve(system.mass[np.ix_(moving, moving)], rest)
    return BodyMotion(KinematicState(state.position, state.velocity, acceleration), still.lag, response, still.forces)


def check(problem: Problem, settings: TransientSettings, start: InitialState) -> None:
    """Checks a problem, settings and an initial state. Raises InputError for combinations that a transient does not
    have."""
    if settings.conserving and (friction := [c.friction for c in problem.contacts if c.friction]):
        refuse(
            "transient, conserving", "contacts without friction", Words(f"friction = {friction[0]:g}"),
            "leave out conserving: friction takes energy",
        )
    if problem.nitsche.theta != 1.0:
        found = f"theta = {problem.nitsche.theta:g}"
        refuse("transient", "the symmetric variant, theta = 1", found, "leave out theta: other variants have no energy")
    if any(support.displacement for body in problem.bodies for support in body.supports):
        refuse(
            "transient", "supports at rest", "a Fixed with a displacement",
            "move the face by Rigid with Freedom(direction, displacement=...)",
        )
    for index, v in start.velocities.items():
        if not 0 <= index < len(problem.bodies):
            wanted = f"body indices below {len(problem.bodies)}"
            refuse("initial state, velocities", wanted, index, "bodies are counted from 0")
        if len(v) != (d := problem.bodies[index].mesh.dimension):
            refuse(f"velocity of body {index}", f"{d} components, as the body is {d}D", v, "give as many")
        _check_free(problem.bodies[index], index, v)


def _check_free(body: Body, index: int, velocity: tuple[float, ...]) -> None:
    """Raises InputError for a velocity that supports, the rigid coupling or a prescribed motion do not allow."""
    axes = "xyz"[: len(velocity)]
    if body.rigid:
        free = {freedom.direction for freedom in body.rigid.freedoms if freedom.load is not None}
    else:
        free = set(axes).difference(*(support.directions for support in body.supports))
    if any(v and axis not in free for v, axis in zip(velocity, axes)):
        along = ", ".join(axis for axis in axes if axis in free)
        refuse(
            f"initial state, velocity of body {index}",
            f"one along its free rigid motions, {along}" if along else "none, as the body is held",
            velocity,
            "give its Rigid a Freedom with a load, which may be 0, or leave out the support that stops it",
        )
