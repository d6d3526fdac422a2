"""Solution of contact problems: `solve` for one step, `sweep` and `Sweep` for several.

docs/own_problem.md has all public names with their units.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator
from functools import cached_property

from evolvent.contact.problem.condensed_body import CondensedBody, condense_bodies
from evolvent.contact.problem.definition import Problem, Side, Step, numbered_step
from evolvent.contact.problem.poisson_limit import warn_if_incompressible
from evolvent.contact.step.contact_width import warn_if_coarse
from evolvent.contact.step.displaced_search import solve_with_displaced_search
from evolvent.contact.step.peak_scatter import warn_if_scattered
from evolvent.contact.step.step_solution import DeformedSurfaces, Solution
from evolvent.contact.step.step_system import SearchPositions, StepSystem
from evolvent_meshes.errors import InputError
from evolvent_meshes.input_checks import refuse

LOG = logging.getLogger("evolvent")


class Sweep:
    """Solves the steps of a problem one after another; slip is measured from the last step that was solved.

    problem: its bodies are condensed once, at the first step.
    solved: number of steps solved so far.

    A step that fails leaves the sweep as it was, so that a smaller step can be tried. Every solved step writes one line
    to the logger "evolvent" at level INFO. Raises InputError for what is no Problem.
    """

    def __init__(self, problem: Problem) -> None:
        if not isinstance(problem, Problem):
            refuse("sweep", "a Problem", problem, "write Problem(bodies, contacts)")
        warn_if_incompressible(problem)
        self.problem = problem
        self.solved = 0
        self._previous: DeformedSurfaces | None = None

    @cached_property
    def condensed(self) -> tuple[CondensedBody, ...]:
        """The bodies, condensed to their contact surfaces."""
        return condense_bodies(self.problem)

    def solve(self, step: Step) -> Solution:
        """The equilibrium of the next step.

        Raises InputError, NotConverged, SearchError, PairingNotSettled, SmallStrainExceeded, NotPositiveDefinite.
        """
        step = numbered_step(self.problem, step)

        def system_of(problem: Problem, search_at: SearchPositions) -> StepSystem:
            return StepSystem(problem, self.condensed, step, search_at)

        _, solution, deformed = solve_with_displaced_search(system_of, self.problem, self._previous)
        _refuse_rigid_carrier(solution)
        self._previous = deformed
        self.solved += 1
        for contact, result in zip(self.problem.contacts, solution.contacts):
            name = f"contact of {self._name(contact.first)} with {self._name(contact.second)}"
            warn_if_coarse(name, result.width)
            warn_if_scattered(name, result.peak_scatter)
        LOG.info("step %d: %s", self.solved, _summary(solution))
        return solution

    def _name(self, side: Side) -> str:
        index, group = side
        return f"{group!r} (body {index}, {self.problem.bodies[index].name!r})"


def solve(problem: Problem, step: Step | None = None) -> Solution:
    """The equilibrium of one step from rest, by default under the full load. Raises as `Sweep.solve`.

    A steel roller of 50 mm radius is pressed with 1000 N/mm on a steel block; Hertz' peak is 857 MPa:

    >>> from evolvent import Body, Contact, Fixed, Freedom, Problem, Rigid, solve
    >>> from evolvent_meshes.shapes.blocks import cylinder_2d, graded_rectangle
    >>> block = Body(graded_rectangle(width=40.0, height=20.0, size=0.1, fine=1.5), supports=(Fixed("bottom"),))
    >>> pressed = Rigid("top", (Freedom("y", load=-1000.0),))
    >>> roller = Body(cylinder_2d(radius=50.0, size=0.1, fine=1.5), rigid=pressed)
    >>> solution = solve(Problem((block, roller), (Contact((0, "top"), (1, "arc"), reach=0.2),)))
    >>> contact = solution.contacts[0]
    >>> print(f"peak {contact.pressure.max():.0f} MPa, force on the roller {contact.force[1]:.1f} N/mm")
    peak 857 MPa, force on the roller 1000.0 N/mm
    """
    return Sweep(problem).solve(Step() if step is None else step)


def sweep(problem: Problem, steps: Iterable[Step]) -> Iterator[Solution]:
    """Equilibria of one step after another, each with the slip since the one before. Raises as `Sweep.solve`; a `Sweep`
    can go on from the last step that was solved.

    A block on another one under half and under all of its load; the contact is closed, so that the pressure doubles:

    >>> from evolvent import Body, Contact, Fixed, Problem, Step, Traction, sweep
    >>> from evolvent_meshes.shapes.blocks import rectangle
    >>> punch = Body(rectangle(1.0, 1.0, 4, 4, origin=(0.0, 1.0)), supports=(Fixed("left", "x"),),
    ...              loads=(Traction("top", (0.0, -50.0)),))
    >>> base = Body(rectangle(1.0, 1.0, 3, 3), supports=(Fixed("left", "x"), Fixed("bottom", "y")))
    >>> problem = Problem((base, punch), (Contact((0, "top"), (1, "bottom")),))
    >>> for solution in sweep(problem, (Step(load=0.5), Step())):
    ...     print(f"{solution.contacts[0].pressure.mean():.3f} MPa")
    25.000 MPa
    50.000 MPa
    """
    if isinstance(steps, str) or not isinstance(steps, Iterable):
        refuse("sweep", "a list of steps", steps, "write sweep(problem, [Step(0.5), Step(1.0)])")
    run = Sweep(problem)
    return (run.solve(step) for step in steps)


def _refuse_rigid_carrier(solution: Solution) -> None:
    """Raises InputError where the surface that carries the pressure cannot deform.

    Nitsche's method takes the traction from the deformation of that surface. A facet whose nodes are all held has none;
    what remains there is a penalty, which lets the other body penetrate.
    """
    for contact in solution.contacts:
        index, group = contact.carrier
        body = solution.condensed[index]
        surface, held = body.surfaces[group], body.assembled.held.reshape(-1, body.assembled.d).all(axis=1)
        pressed = contact.facets[contact.pressure > 0.0]
        if held[surface.nodes[surface.facets[pressed]]].all(axis=1).any():
            raise InputError(
                f"contact on {group!r} of body {index}: wanted a first surface that deforms where it is pressed on, "
                "found facets there that a support or a rigid coupling holds; name the other surface first"
            )


def _summary(solution: Solution) -> str:
    contacts = (
        f"{(sum(x * x for x in c.force) ** 0.5):.6g} {'N/mm' if len(c.force) == 2 else 'N'} at up to "
        f"{c.pressure.max(initial=0.0):.6g} MPa"
        for c in solution.contacts
    )
    return f"load factor {solution.step.load:g}, {solution.iterations} iterations, contact {', '.join(contacts)}"
