"""The contact system of one step: pairs of points, jumps, compliance and loads of all bodies, and its equilibrium."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg import block_diag

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.equilibrium import (
    Equilibrium,
    frictional,
    frictionless,
    normal_part,
    stuck,
    with_components,
)
from evolvent.contact.newton.jump_compliance import DenseCompliance, JumpCompliance
from evolvent.contact.newton.reduced_tangent import FreeMotion
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.nitsche.contact_operator import ContactOperator, stacked
from evolvent.contact.problem.body_response import BodyResponse, StaticResponse
from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent.contact.problem.definition import Placement, Problem, Side, Step, numbered_step
from evolvent.contact.problem.pressure_carrier import pressure_sides
from evolvent.contact.problem.rigid_motions import motions_at
from evolvent.contact.step.bodies_compliance import BodiesCompliance
from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.step.free_motion import free_motion
from evolvent.contact.step.paired_surfaces import (
    PairedSurfaces,
    SurfacePair,
    SurfacePositions,
    SurfaceSupports,
    pair_contact,
    reach_of,
)
from evolvent.contact.step.step_solution import DeformedSurfaces, Solution
from evolvent.fem.body import RigidMotions
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats

SearchPositions = tuple[SurfacePositions | None, ...] | None
"""Per contact, where the nodes of its surfaces lie for the search; None: where `StepSystem` puts them by default."""
FAR = 0.5
"""Fraction of a facet: pairs are searched after prescribed motions if these are longer."""


class StepSystem:
    """The condensed contact system of one step.

    problem, condensed, step: the problem, its bodies condensed, and one of its steps.
    search_at: where the surfaces are searched for pairs; by default as the bodies are placed, moved by the prescribed
        motions if these are long.
    as_placed: search as the bodies are placed even if the prescribed motions are long.
    responses: responses of the bodies to contact forces; by default as without inertia.

    No solution is stored: one system can be solved any number of times. Raises InputError for a step that does not fit
    the problem, SearchError.
    """

    def __init__(
        self, problem: Problem, condensed: tuple[CondensedBody, ...], step: Step, search_at: SearchPositions = None,
        as_placed: bool = False, responses: Sequence[BodyResponse] | None = None,
    ) -> None:
        self.problem, self.condensed = problem, condensed
        self.step = step = numbered_step(problem, step)
        self.d = condensed[0].assembled.d
        self.as_placed = as_placed
        self.placements = step.placements or tuple(Placement.at_rest(self.d) for _ in condensed)
        self.sides = [pressure_sides(problem.bodies, contact) for contact in problem.contacts]
        self.reaches = [reach_of(contact, self._surface(contact.first)) for contact in problem.contacts]
        self.motions = [motions_at(step, b, body.assembled) for b, body in enumerate(condensed)]
        self.responses = responses or [
            StaticResponse(body, step.load, len(motions.free)) for body, motions in zip(condensed, self.motions)
        ]
        self.paired = [self._pair(i, search_at[i] if search_at else None) for i in range(len(problem.contacts))]
        self.operators = [paired.operator for paired in self.paired]
        self.maps = [self._map(b) for b in range(len(condensed))]
        self.least_scale = 0.0

    def _surface(self, side: Side) -> Surface:
        placement = self.placements[side[0]]
        return self.condensed[side[0]].surfaces[side[1]].moved(placement.rotation, placement.translation)

    def _pair(self, index: int, positions: SurfacePositions | None) -> PairedSurfaces:
        contact, (carrier, other) = self.problem.contacts[index], self.sides[index]
        traction = self.condensed[carrier[0]].tractions[carrier[1]]
        frames = traction.frames @ self.placements[carrier[0]].rotation.T
        placed = self._surface(carrier), self._surface(other)
        positions = positions or self._after_prescribed_motions((carrier, other), placed)
        supports = self._supports(carrier), self._supports(other)
        return pair_contact(contact, self.reaches[index], placed, traction.stabiliser, frames, supports, positions)

    def _supports(self, side: Side) -> SurfaceSupports:
        body = self.condensed[side[0]]
        return SurfaceSupports.of(body.assembled.body, body.surfaces[side[1]], self.placements[side[0]].rotation)

    def _after_prescribed_motions(self, sides: tuple[Side, Side], placed: SurfacePair) -> SurfacePositions | None:
        """Positions of the surfaces after the prescribed motions alone, if these are longer than FAR; else None."""
        first, second = (self._prescribed_displacement(side) for side in sides)
        lengths = [np.linalg.norm(u, axis=1).max() / surface.size for u, surface in zip((first, second), placed)]
        far = max(lengths) > FAR and not self.as_placed
        return (placed[0].points + first, placed[1].points + second) if far else None

    def _prescribed_displacement(self, side: Side) -> Floats:
        """Displacements of a surface's nodes by the prescribed motions alone, (n, d) [mm]."""
        body, motions = self.condensed[side[0]], self.motions[side[0]]
        nodes, held = body.surfaces[side[1]].nodes, np.flatnonzero(~np.isnan(motions.value))
        u: Floats = motions.shapes[nodes][:, :, held] @ motions.value[held]
        return u @ self.placements[side[0]].rotation.T

    def _map(self, body: int) -> sp.csr_matrix:
        """E_b (Σn·d, m_b): from a body's functionals to the local jumps of all contacts."""
        d, condensed = self.d, self.condensed[body]
        rows = []
        for sides, op in zip(self.sides, self.operators):
            block = sp.csr_matrix((len(op.nodes) * d, condensed.functionals.shape[0]))
            for number, side in zip((1, 2), sides):
                if side[0] == body:
                    local = op.local_map(number, self.placements[body].rotation)
                    columns = local.indices + condensed.offsets[side[1]]
                    block = block + sp.csr_matrix((local.data, columns, local.indptr), block.shape)
            rows.append(block)
        return sp.vstack(rows).tocsr()

    @property
    def friction(self) -> Floats:
        """Coefficient of friction μ at each point, (Σq,)."""
        return np.concatenate(
            [np.full(len(op.weights), c.friction) for c, op in zip(self.problem.contacts, self.operators)]
        )

    @cached_property
    def compliance(self) -> JumpCompliance:
        """Compliance of all bodies in local jumps. Gaps and stabilisers do not change it."""
        whole = BodiesCompliance(self.maps, [response.compliance for response in self.responses], self.d)
        return DenseCompliance(whole.matrix, self.d) if self.friction.any() else whole

    def answering(
        self, step: Step, responses: Sequence[BodyResponse], motions: Sequence[RigidMotions], least_scale: float
    ) -> StepSystem:
        """Contact system with the same pairs in another step, whose placements must be the same. least_scale: force [N]
        with which residuals are compared at least."""
        other = copy(self)
        other.step, other.responses, other.motions, other.least_scale = step, responses, list(motions), least_scale
        other.__dict__.pop("compliance", None)  # cached
        return other

    def load_jump(self) -> Floats:
        """Local jumps without contact forces and rigid motions, (Σn·d,) [mm]."""
        return np.sum([E @ response.displacement for E, response in zip(self.maps, self.responses)], axis=0)

    def system(self, operators: Sequence[ContactOperator] | None = None) -> CondensedSystem:
        """Compliance, motions and loads of all bodies in local jumps.

        operators: one a contact, instead of `self.operators`, with other gaps or stabilisers on the same pairs.
        """
        operator = stacked(self.operators if operators is None else list(operators))
        jump, H, F = self.load_jump(), [], []
        for E, body, motions, response in zip(self.maps, self.condensed, self.motions, self.responses):
            held = np.flatnonzero(~np.isnan(motions.value))
            moved = E @ body.motion_shapes
            jump = jump + moved[:, held] @ motions.value[held]
            H.append(moved[:, motions.free])
            F.append(motions.load[motions.free] + response.load)
        motion, load, resistance = np.hstack(H), np.concatenate(F), [each.resistance for each in self.responses]
        lever = np.abs(motion).max(axis=0, initial=0.0)
        return CondensedSystem(
            operator, self.compliance, motion, jump, load, block_diag(*resistance), np.where(lever > 0.0, lever, 1.0),
            self.least_scale,
        )

    def solve(
        self, previous: DeformedSurfaces | None, operators: Sequence[ContactOperator] | None = None
    ) -> tuple[Solution, DeformedSurfaces]:
        """The equilibrium of the step, and the deformed surfaces for the next one.

        previous: the deformed surfaces from which the slip is measured; None: as placed. operators: see `system`.
        Raises NotConverged.
        """
        system, μ, slip = self.system(operators), self.friction, self.slip(previous)
        at_points = system.operator.shape @ slip
        try:
            state = self._frictional(system, μ, at_points) if μ.any() else frictionless(normal_part(system))
        except FreeMotion as failure:
            which = free_motion(self.problem.bodies, self.motions, normal_part(system).motion)
            raise FreeMotion(f"{failure}; {which}" if which else str(failure)) from failure
        return self.result(system, state, slip)

    def result(self, system: CondensedSystem, state: Equilibrium, slip: Floats) -> tuple[Solution, DeformedSurfaces]:
        """Solution and deformed surfaces at an equilibrium of `system`. slip: (Σn, d−1) [mm], as of `slip`."""
        return self._solution(system, state, slip), self._deformed_surfaces(state)

    def slip(self, previous: DeformedSurfaces | None) -> Floats:
        """Tangential change of the jump of positions at the current pairs since the previous step, without the
        current displacement, (Σn, d−1) [mm]."""
        result = []
        for i, (op, surfaces) in enumerate((paired.operator, paired.placed) for paired in self.paired):
            now = then = op.jump1 @ surfaces[0].points - op.jump2 @ surfaces[1].points
            if previous is not None:
                then = op.jump1 @ previous.positions[i][0] - op.jump2 @ previous.positions[i][1]
            result.append(np.einsum("jta,ja->jt", op.frames[:, 1:], now - then))
        return np.concatenate(result)

    def _frictional(self, system: CondensedSystem, μ: Floats, slip: Floats) -> Equilibrium:
        """Equilibrium with friction, from the frictionless one. If there is none (only friction carries the load), or
        Newton's method fails from there, it starts from the state in which all contact sticks."""
        unknown = np.zeros((len(μ), self.d - 1))
        try:
            start = frictionless(normal_part(system))
            state = frictional(system, μ, slip, unknown, start)
        except NotConverged:
            start = stuck(system, slip)
            state = self._from_stuck(system, μ, slip, start)
        return replace(state, iterations=start.iterations + state.iterations)

    def _from_stuck(self, system: CondensedSystem, μ: Floats, slip: Floats, start: Equilibrium) -> Equilibrium:
        try:
            return frictional(system, μ, slip, np.zeros((len(μ), self.d - 1)), start)
        except NotConverged as failure:
            if not system.load.any():
                raise
            raise NotConverged(
                f"{failure}. Or there is no equilibrium: where friction alone holds a load, bodies slide once it is "
                "more than μ times the force between them; prescribe that motion instead (Freedom with a displacement)"
            ) from failure

    def nodal_forces(self, state: Equilibrium) -> Floats:
        """Nodal contact forces (Σn, d) [N] in local frames. Tangential forces are zero where there is no friction."""
        return with_components(state.force, self.d)

    def _tractions(self, state: Equilibrium) -> list[Floats]:
        """Local tractions (q, d) [MPa] at the points of each contact."""
        return self._split(with_components(state.traction, self.d))

    def _split(self, values: Floats) -> list[Floats]:
        """Values (Σq, ...) at all points, contact by contact."""
        return np.split(values, np.cumsum([len(op.weights) for op in self.operators])[:-1])

    def _point_slip(self, system: CondensedSystem, state: Equilibrium, slip: Floats) -> Floats:
        """Slip at the points in this step, (Σq, d−1) [mm]: (q − τ)/γ_t with the trial traction q."""
        jump = system.jumps(self.nodal_forces(state), state.motion)[:, 1:] + slip
        τ = state.traction[:, 1:] if state.traction.shape[1] > 1 else 0.0
        return np.asarray(system.operator.shape @ jump - τ / system.operator.stabiliser[:, 1:])

    def body_motions(self, state: Equilibrium) -> list[Floats]:
        """Per body, amplitudes (r,) of all rigid motions, prescribed ones included."""
        result, at = [], 0
        for motions in self.motions:
            value = motions.value.copy()
            value[motions.free] = state.motion[at : at + len(motions.free)]
            at += len(motions.free)
            result.append(value)
        return result

    def _solution(self, system: CondensedSystem, state: Equilibrium, slip: Floats) -> Solution:
        force = self.nodal_forces(state)
        point_slip = self._split(self._point_slip(system, state, slip))
        contacts = tuple(
            ContactResult.of(*each)
            for each in zip(self.problem.contacts, self.sides, self.paired, self._tractions(state), point_slip)
        )
        largest = max(system.scale, float(np.abs(force).sum()))
        return Solution(
            contacts=contacts,
            motions=tuple(self.body_motions(state)),
            iterations=state.iterations,
            imbalance=state.residual / largest if largest else 0.0,
            nodal_forces=tuple(-(E.T @ force.ravel()) for E in self.maps),
            condensed=self.condensed,
            step=self.step,
            responses=tuple(self.responses),
        )

    def _deformed_surfaces(self, state: Equilibrium) -> DeformedSurfaces:
        force = self.nodal_forces(state).ravel()
        functionals = [
            r.displacement - r.compliance @ (E.T @ force) + b.motion_shapes @ δ
            for b, r, E, δ in zip(self.condensed, self.responses, self.maps, self.body_motions(state))
        ]
        contacts = zip(self.sides, self.paired, self._tractions(state))
        return DeformedSurfaces(tuple(self._deformed(functionals, *contact) for contact in contacts))

    def _deformed(
        self, functionals: list[Floats], sides: tuple[Side, Side], paired: PairedSurfaces, traction: Floats
    ) -> SurfacePositions:
        """Deformed positions of both surfaces of a contact, from the values P u (m,) of all bodies' functionals."""
        result = []
        for side, surface in zip(sides, paired.placed):
            start = self.condensed[side[0]].offsets[side[1]]
            u = functionals[side[0]][start : start + surface.points.size].reshape(-1, self.d)
            result.append(surface.points + u @ self.placements[side[0]].rotation.T)
        result[0][paired.operator.nodes] += paired.operator.flux(traction)
        return result[0], result[1]
