"""The public API: bodies, contacts, solve, sweep. The verification problems use nothing else.

block = Body(read_msh("block.msh"), supports=(Fixed("bottom"),))
punch = Body(read_msh("punch.msh"), rigid=Rigid("top", (Freedom("y", load=-1000.0),)))
solution = solve(Problem((punch, block), (Contact((0, "face"), (1, "top"), friction=0.2),)))

docs/own_problem.md has every name with its units.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator
from functools import cached_property, partial

from evolvent.contact.problem.condensed_body import PreparedBody, prepare
from evolvent.contact.problem.definition import Problem, Side, Step, check_step
from evolvent.contact.problem.poisson_limit import warn_if_incompressible
from evolvent.contact.step.contact_width import warn_if_coarse
from evolvent.contact.step.displaced_search import settled
from evolvent.contact.step.peak_scatter import warn_if_scattered
from evolvent.contact.step.step_system import History, Position, Solution, Where
from evolvent_meshes.errors import InputError
from evolvent_meshes.input_checks import refuse

LOG = logging.getLogger("evolvent")


class Sweep:
    """Steps of a problem, one after another; friction remembers the last one that was solved.

    A step that fails leaves the sweep where it was: the caller can try a smaller one. The bodies are condensed once,
    with the first step. Every solved step writes one line to the logger "evolvent" at level INFO.
    """

    def __init__(self, problem: Problem) -> None:
        if not isinstance(problem, Problem):
            refuse("sweep", "a Problem", problem, "write Problem(bodies, contacts)")
        warn_if_incompressible(problem)
        self.problem = problem
        self.solved = 0
        self._before: History | None = None

    @cached_property
    def prepared(self) -> tuple[PreparedBody, ...]:
        """The bodies, condensed to their contact surfaces."""
        return prepare(self.problem)

    def solve(self, step: Step) -> Solution:
        """The next step. Raises InputError, NotConverged, SearchError."""
        check_step(self.problem, step)
        at = partial(_position, self.prepared, step)
        _, solution, before = settled(at, self.problem, self._before)
        _refuse_rigid_carrier(solution)
        self._before = before
        self.solved += 1
        for contact, result in zip(self.problem.contacts, solution.contacts):
            name = f"contact of {self._named(contact.first)} with {self._named(contact.second)}"
            warn_if_coarse(name, result.width)
            warn_if_scattered(name, result.peak_scatter)
        LOG.info("step %d: %s", self.solved, _line(solution))
        return solution

    def _named(self, side: Side) -> str:
        index, group = side
        return f"{group!r} (body {index}, {self.problem.bodies[index].name!r})"


def solve(problem: Problem, step: Step | None = None) -> Solution:
    """One step from rest, by default the full load. Raises InputError, NotConverged, SearchError."""
    return Sweep(problem).solve(Step() if step is None else step)


def sweep(problem: Problem, steps: Iterable[Step]) -> Iterator[Solution]:
    """Solves step after step; friction remembers the step before. Raises InputError, NotConverged, SearchError; `Sweep`
    can go on from the last step that was solved."""
    if isinstance(steps, str) or not isinstance(steps, Iterable):
        refuse("sweep", "a list of steps", steps, "write sweep(problem, [Step(0.5), Step(1.0)])")
    run = Sweep(problem)
    return (run.solve(step) for step in steps)


def _position(prepared: tuple[PreparedBody, ...], step: Step, problem: Problem, where: Where) -> Position:
    return Position(problem, prepared, step, where)


def _refuse_rigid_carrier(solution: Solution) -> None:
    """Nitsche's method takes the traction from the deformation of the surface that carries the pressure; where all of a
    facet is held there is none, and what remains is a penalty that lets the other body through. Raises InputError."""
    for contact in solution.contacts:
        index, group = contact.carrier
        body = solution.prepared[index]
        surface, held = body.surfaces[group], body.assembled.held.reshape(-1, body.assembled.d).all(axis=1)
        pressed = contact.meeting.pairing.facet1[contact.pressure > 0.0]
        if held[surface.nodes[surface.facets[pressed]]].all(axis=1).any():
            raise InputError(
                f"contact on {group!r} of body {index}: wanted a first surface that deforms where it is pressed on, "
                "found facets there that a support or a rigid coupling holds; name the other surface first"
            )


def _line(solution: Solution) -> str:
    contacts = (
        f"{(sum(x * x for x in c.force) ** 0.5):.6g} {'N/mm' if len(c.force) == 2 else 'N'} at up to "
        f"{c.pressure.max(initial=0.0):.6g} MPa"
        for c in solution.contacts
    )
    return f"load factor {solution.step.load:g}, {solution.iterations} iterations, contact {', '.join(contacts)}"
