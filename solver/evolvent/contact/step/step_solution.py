"""Results of a step of a contact problem: its solution, and the deformed surfaces that the next step needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from evolvent.contact.problem.body_names import body_number, is_body
from evolvent.contact.problem.body_response import BodyResponse
from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent.contact.problem.definition import Step
from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.step.paired_surfaces import SurfacePositions
from evolvent.fem.body import Body
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import refuse


@dataclass(frozen=True)
class Solution:
    """Equilibrium of a problem at one step.

    contacts: one result a contact.
    motions: per body, amplitudes (r,) of its rigid motions in the order of its freedoms [mm, rad].
    iterations: Newton iterations of all solves of the step, over all searches.
    imbalance: largest residual force over the largest force.
    nodal_forces: per body, forces (m,) on the functionals of its contact surfaces [N].
    condensed: the condensed bodies; `condensed[i].assembled.body` is the body itself.
    step: the step that was solved.
    responses: response of each body to contact forces in this step.
    searches: number of searches for pairs: 1, or more if they were repeated on displaced surfaces.
    """

    contacts: tuple[ContactResult, ...]
    motions: tuple[Floats, ...]
    iterations: int
    imbalance: float
    nodal_forces: tuple[Floats, ...]
    condensed: tuple[CondensedBody, ...]
    step: Step
    responses: tuple[BodyResponse, ...]
    searches: int = 1

    def number(self, body: int | Body) -> int:
        """Index of a body of the problem; an index stays as it is. Raises InputError where there is no such body."""
        count, known = len(self.condensed), [each.assembled.body for each in self.condensed]
        index = body_number(known, body, "solution") if is_body(body) else -1
        if not 0 <= index < count:
            wanted = f"a body of the problem, or its number from 0 to {count - 1}"
            refuse("solution", wanted, body, "names are not searched: give the Body itself")
        return index

    def body(self, body: int | Body) -> CondensedBody:
        """A body of the problem, or that with an index, condensed. Raises InputError where there is none."""
        return self.condensed[self.number(body)]

    def displacement(self, body: int | Body) -> Floats:
        """Displacement of a body's mesh nodes in its frame, rigid motion included, (N, d) [mm]. Raises InputError."""
        index = self.number(body)
        return self.responses[index].field(self.nodal_forces[index], self.motions[index])

    def function(self, body: int | Body) -> Any:
        """Displacement of a body as a dolfinx.fem.Function, vector Lagrange of the mesh's order [mm].

        It is defined on the caller's mesh, in its numbering, if the body's mesh is from `mesh_from_dolfinx`, otherwise
        on a dolfinx mesh of the body's own, which all solutions of a sweep share. Raises InputError, CompileError,
        CacheError.
        """
        return self.body(body).nodal_space.function(self.displacement(body), "displacement")


@dataclass(frozen=True)
class DeformedSurfaces:
    """The contact surfaces at the end of a step, from which the slip of the next step is measured.

    positions: per contact, deformed positions of the nodes of both surfaces, the one that carries the pressure first.
    """

    positions: tuple[SurfacePositions, ...]
