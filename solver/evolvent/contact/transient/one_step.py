"""Solution of one time step of a given length."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.contact.problem.definition import Problem, Step
from evolvent.contact.step.displaced_search import solve_with_displaced_search
from evolvent.contact.step.step_solution import Solution
from evolvent.contact.step.step_system import SearchPositions, StepSystem
from evolvent.contact.transient.adaptive_steps import step_error
from evolvent.contact.transient.beginning import Reached
from evolvent.contact.transient.body_motion import BodyMotion
from evolvent.contact.transient.energy import Energy, contact_energy, driving_work, lag_work, load_work
from evolvent.contact.transient.moving_body import MovingBody
from evolvent.contact.transient.moving_response import MovingResponse
from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme, TimeStep
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class SolvedStep:
    """Solution of a time step."""

    reached: Reached
    """State at the end of the step."""
    solution: Solution
    """Contacts, forces and motions at the end."""
    energy: Energy
    """Energy of all bodies at the end."""
    error: float
    """Estimated error, see adaptive_steps.py."""
    systems: int
    """Number of contact systems that were solved."""


def solve_step(
    problem: Problem, bodies: tuple[MovingBody, ...], scheme: TimeScheme, before: Reached, step: Step, length: float
) -> SolvedStep:
    """The step of `length` [s] from `before`, with the loads and prescribed motions of `step` at its end.

    Raises InputError, NotConverged, SearchError, PairingNotSettled, SmallStrainExceeded, EnergyGrowth.
    """
    stretch = length / before.length if before.length else 1.0
    responses = tuple(
        MovingResponse.of(body, index, step, TimeStep(body.system, scheme, motion.state_for(stretch), length))
        for index, (body, motion) in enumerate(zip(bodies, before.motions))
    )
    condensed = tuple(body.condensed for body in bodies)

    def system_of(problem: Problem, search_at: SearchPositions) -> StepSystem:
        return StepSystem(problem, condensed, step, search_at, responses=responses)

    _, solution, deformed = solve_with_displaced_search(system_of, problem, before.deformed)
    motions = tuple(_moved(scheme, *each) for each in zip(responses, solution.nodal_forces, solution.motions))
    energy, time = Energy.of(motions, contact_energy(solution.contacts)), before.time + length
    ends = list(zip(before.motions, motions))
    work = sum(load_work(*each) + driving_work(*each) for each in ends)
    balance = before.balance.after(energy.total, work, sum(lag_work(*each) for each in ends))
    balance.refuse_growth(energy.total, time)
    error = step_error(scheme, motions, balance.largest)
    reached = Reached(time, length, length, motions, deformed, balance)
    return SolvedStep(reached, solution, energy, error, solution.searches)


def _moved(scheme: TimeScheme, response: MovingResponse, forces: Floats, motion: Floats) -> BodyMotion:
    """A body at the end of a step, under forces on its functionals (k,) at rigid motions (r,)."""
    state = response.state(forces, motion)
    lag = scheme.alpha * (state.acceleration - response.step.state.acceleration)
    return BodyMotion(state, lag, response, forces)
