"""Results of a step of a contact problem: its solution, and the deformed surfaces that the next step needs."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.contact.problem.body_response import BodyResponse
from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent.contact.problem.definition import Step
from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.step.paired_surfaces import SurfacePositions
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import is_index, refuse


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

    def body(self, index: int) -> CondensedBody:
        """The condensed body with this index. Raises InputError where there is none."""
        if not (is_index(index) and 0 <= index < len(self.condensed)):
            refuse("solution", f"a body index below {len(self.condensed)}", index, "bodies are counted from 0")
        return self.condensed[index]

    def displacement(self, body: int) -> Floats:
        """Displacement of a body's mesh nodes in its frame, rigid motion included, (N, d) [mm]. Raises InputError."""
        self.body(body)
        return self.responses[body].field(self.nodal_forces[body], self.motions[body])


@dataclass(frozen=True)
class DeformedSurfaces:
    """The contact surfaces at the end of a step, from which the slip of the next step is measured.

    positions: per contact, deformed positions of the nodes of both surfaces, the one that carries the pressure first.
    """

    positions: tuple[SurfacePositions, ...]
