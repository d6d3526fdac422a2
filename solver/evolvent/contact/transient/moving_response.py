"""Response of a moving body to contact forces in one time step."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.contact.problem.definition import Step
from evolvent.contact.problem.rigid_motions import motions_at
from evolvent.contact.transient.moving_body import MovingBody
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, StepEquations
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError


@dataclass(frozen=True)
class MovingResponse:
    """Response to contact forces in a time step of a body with m modes and r rigid motions, s of them free."""

    body: MovingBody
    """Moving body."""
    step: StepEquations
    """Equations of the time step of modes and rigid motions (m + r), from the state at its beginning."""
    factor: float
    """Factor on the loads of the body at the end."""
    resultant: Floats
    """Resultant (s,) of all loads on the free rigid motions at the end [N, N·mm]."""
    prescribed: Floats
    """Amplitudes (r,) of the rigid motions at the end, NaN where they are free [mm, rad]."""

    @staticmethod
    def of(body: MovingBody, index: int, step: Step, time_step: StepEquations) -> MovingResponse:
        """Response of body `index` under the loads and prescribed motions of a step.

        Raises InputError for a step that prescribes what is loaded, or loads what is prescribed.
        """
        motions = motions_at(step, index, body.condensed.assembled)
        if not np.array_equal(motions.free, body.free):
            raise InputError(
                f"transient, step: wanted the same motions of body {index} prescribed as in its Rigid, found others; "
                "give a loaded freedom another load, a prescribed one another displacement"
            )
        return MovingResponse(body, time_step, step.load, motions.load[body.free], motions.value)

    @cached_property
    def compliance(self) -> Floats:
        """Compliance (k, k) of the functionals in the time step [mm/N]."""
        Φ = self.body.functionals
        return self.body.rest + (Φ / self._modal) @ Φ.T

    @cached_property
    def displacement(self) -> Floats:
        """Values (k,) of the functionals without contact forces and rigid motions [mm]."""
        rest = self.body.load_response(self.factor, self.resultant)
        return rest + self.body.functionals @ (self._pushed / self._modal)

    @property
    def resistance(self) -> Floats:
        """Force (s, s) on the free rigid motions by unit amplitudes of them, from inertia and damping [N/mm, N,
        N·mm]."""
        return self.step.matrix[np.ix_(self._free, self._free)]

    @property
    def load(self) -> Floats:
        """Force (s,) on the free rigid motions beside the loads of the step, from inertia and damping [N, N·mm]."""
        return self.step.known[self._free] - self.step.matrix[np.ix_(self._free, self.held)] @ self._held_at

    def state(self, forces: Floats, motion: Floats) -> KinematicState:
        """State of the body at the end, under forces on the functionals (k,) at rigid motions (r,)."""
        return self.step.after(np.concatenate([self.modes(forces), motion]))

    def modes(self, forces: Floats) -> Floats:
        """Amplitudes q (m,) of the modes at the end, under forces on the functionals (k,)."""
        return (self._pushed + self.body.functionals.T @ forces) / self._modal

    def field(self, forces: Floats, motion: Floats) -> Floats:
        """Displacement of the nodes (N, d) [mm] under forces on the functionals (k,) [N] at rigid motions (r,): static
        under all forces and the inertia forces of the modes and rigid motions."""
        return self.body.field(self.factor, self.resultant, forces, self.modes(forces), motion)

    @property
    def _modal(self) -> Floats:
        """Diagonal of the step's matrix for the modes (m,)."""
        return np.diag(self.step.matrix)[: self.body.count]

    @cached_property
    def _pushed(self) -> Floats:
        """Forces (m,) on the modes without those of the contact."""
        m = self.body.count
        inertia = self.step.known[:m] - self.step.matrix[:m, self.held] @ self._held_at
        return self.body.modal_load(self.factor, self.resultant) + inertia

    @property
    def _free(self) -> Ints:
        return self.body.count + self.body.free

    @property
    def held(self) -> Ints:
        """Indices of the prescribed coordinates among modes and rigid motions."""
        return self.body.count + np.flatnonzero(~np.isnan(self.prescribed))

    @property
    def _held_at(self) -> Floats:
        return self.prescribed[~np.isnan(self.prescribed)]
