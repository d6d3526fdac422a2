"""The contact system of one step of a sweep, and what it finds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.equilibrium import (
    CondensedSystem,
    Equilibrium,
    frictional,
    frictionless,
    normal_part,
    stuck,
)
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.nitsche.contact_operator import ContactOperator, stacked
from evolvent.contact.problem.condensed_body import PreparedBody
from evolvent.contact.problem.definition import Placement, Problem, Side, Step, check_step
from evolvent.contact.problem.pressure_carrier import carrying
from evolvent.contact.problem.step_pairing import Meeting, Places, Supports, met, reach_of
from evolvent.contact.step.contact_result import ContactResult
from evolvent.fem.body import Assembled, RigidMotions
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import is_index, refuse


@dataclass(frozen=True)
class Solution:
    """Equilibrium of a problem at one step.

    motions: per body (r,) rigid motions in the order of its freedoms [mm, rad]. iterations: Newton's, of the start and
    of the friction law, in all searches. imbalance: largest residual force over the largest force. nodal_forces: per
    body, on what is seen of it. searches: how often pairs were searched: once, or again on the displaced surfaces.
    """

    contacts: tuple[ContactResult, ...]
    motions: tuple[Floats, ...]
    iterations: int
    imbalance: float
    nodal_forces: tuple[Floats, ...]
    prepared: tuple[PreparedBody, ...]
    step: Step
    searches: int = 1

    def body(self, index: int) -> PreparedBody:
        """A body as it was prepared. Raises InputError for one that is not there."""
        if not (is_index(index) and 0 <= index < len(self.prepared)):
            refuse("solution", f"a body index below {len(self.prepared)}", index, "bodies are counted from 0")
        return self.prepared[index]

    def displacement(self, body: int) -> Floats:
        """Displacement (N, d) of a body's mesh nodes in its frame [mm], rigid motion included. Raises InputError."""
        return self.body(body).displacement(self.nodal_forces[body], self.step.load, self.motions[body])


@dataclass(frozen=True)
class History:
    """Deformed positions of the surfaces of each contact at the last step, the one that carries the pressure first."""

    points: tuple[Places, ...]


Where = tuple[Places | None, ...] | None
"""Of each contact, where its surfaces are searched; by default where `Position` says."""
MOVED = 0.5  # of a facet: prescribed motions beyond this are gone along with before pairs are searched


class Position:
    """The condensed contact system of one step.

    where: where the surfaces of each contact are searched; by default as the bodies are placed, moved by what is
    prescribed if that is far.
    as_placed: search as the bodies are placed even if the prescribed motions are far.

    No solution is stored: one system can be solved any number of times.

    Raises InputError for a step of another problem, SearchError.
    """

    def __init__(
        self, problem: Problem, prepared: tuple[PreparedBody, ...], step: Step, where: Where = None,
        as_placed: bool = False,
    ) -> None:  # fmt: skip
        self.problem, self.prepared, self.step = problem, prepared, step
        self.d = prepared[0].assembled.d
        check_step(problem, step)
        self.as_placed = as_placed
        self.placements = step.placements or tuple(Placement.at_rest(self.d) for _ in prepared)
        self.sides = [carrying(problem.bodies, contact) for contact in problem.contacts]
        self.reaches = [reach_of(contact, self._surface(contact.first)) for contact in problem.contacts]
        self.motions = [_motions_at(step, b, body.assembled) for b, body in enumerate(prepared)]
        self.meetings = [self._meeting(i, where[i] if where else None) for i in range(len(problem.contacts))]
        self.operators = [meeting.operator for meeting in self.meetings]
        self.maps = [self._map(b) for b in range(len(prepared))]

    def _surface(self, side: Side) -> Surface:
        where = self.placements[side[0]]
        return self.prepared[side[0]].surfaces[side[1]].moved(where.rotation, where.translation)

    def _meeting(self, index: int, where: Places | None) -> Meeting:
        contact, (carrier, other) = self.problem.contacts[index], self.sides[index]
        traction = self.prepared[carrier[0]].tractions[carrier[1]]
        frames = traction.frames @ self.placements[carrier[0]].rotation.T
        placed = self._surface(carrier), self._surface(other)
        where = where or self._prescribed((carrier, other), placed)
        supports = self._supports(carrier), self._supports(other)
        return met(contact, self.reaches[index], placed, traction.stabiliser, frames, supports, where)

    def _supports(self, side: Side) -> Supports:
        body = self.prepared[side[0]]
        return Supports.of(body.assembled.body, body.surfaces[side[1]], self.placements[side[0]].rotation)

    def _prescribed(self, sides: tuple[Side, Side], placed: tuple[Surface, Surface]) -> Places | None:
        """Where the prescribed motions take the surfaces, if that is further than MOVED."""
        first, second = (self._held(side) for side in sides)
        far = [np.linalg.norm(u, axis=1).max() / surface.size for u, surface in zip((first, second), placed)]
        moved = max(far) > MOVED and not self.as_placed
        return (placed[0].points + first, placed[1].points + second) if moved else None

    def _held(self, side: Side) -> Floats:
        """Displacements (n, d) of a surface by the prescribed motions alone."""
        body, motions = self.prepared[side[0]], self.motions[side[0]]
        nodes, held = body.surfaces[side[1]].nodes, np.flatnonzero(~np.isnan(motions.value))
        u: Floats = motions.shapes[nodes][:, :, held] @ motions.value[held]
        return u @ self.placements[side[0]].rotation.T

    def _map(self, body: int) -> sp.csr_matrix:
        """E_b (Σn·d, m_b): functionals of a body to the local jumps of all contacts."""
        d, prepared = self.d, self.prepared[body]
        rows = []
        for sides, op in zip(self.sides, self.operators):
            block = sp.csr_matrix((len(op.nodes) * d, prepared.functionals.shape[0]))
            for number, side in zip((1, 2), sides):
                if side[0] == body:
                    local = op.local_map(number, self.placements[body].rotation)
                    columns = local.indices + prepared.offsets[side[1]]
                    block = block + sp.csr_matrix((local.data, columns, local.indptr), block.shape)
            rows.append(block)
        return sp.vstack(rows).tocsr()

    @property
    def friction(self) -> Floats:
        """μ of each point, (Σq,)."""
        return np.concatenate(
            [np.full(len(op.weights), c.friction) for c, op in zip(self.problem.contacts, self.operators)]
        )

    def load_jump(self) -> Floats:
        """Local jumps (Σn·d,) that the external loads alone would make."""
        return self.step.load * sum(E @ b.load_response for E, b in zip(self.maps, self.prepared))

    def system(self, operators: Sequence[ContactOperator] | None = None) -> CondensedSystem:
        """Compliance, motions and loads of all bodies in local jumps.

        operators: one a contact, instead of `self.operators`, with other gaps or stabilisers on the same pairs.
        """
        operator = stacked(self.operators if operators is None else list(operators))
        n = len(operator.nodes) * self.d
        A, jump, H, F = np.zeros((n, n)), self.load_jump(), [], []
        for E, body, motions in zip(self.maps, self.prepared, self.motions):
            A += E @ (E @ body.compliance.T).T
            held = np.flatnonzero(~np.isnan(motions.value))
            moved = E @ body.motion_shapes
            jump = jump + moved[:, held] @ motions.value[held]
            H.append(moved[:, motions.free])
            F.append(motions.load[motions.free])
        motion, load = np.hstack(H), np.concatenate(F)
        lever = np.abs(motion).max(axis=0, initial=0.0)
        return CondensedSystem(operator, A, motion, jump, load, np.where(lever > 0.0, lever, 1.0))

    def solve(
        self, before: History | None, operators: Sequence[ContactOperator] | None = None
    ) -> tuple[Solution, History]:
        """Equilibrium, with the slip since `before`. operators: see `system`."""
        system = self.system(operators)
        μ, slip = self.friction, self.slip(before)
        found = self._with_friction(system, μ, slip) if μ.any() else frictionless(normal_part(system))
        return self._solution(system, found, slip), self._history(found)

    def _with_friction(self, system: CondensedSystem, μ: Floats, slip: Floats) -> Equilibrium:
        """From the frictionless state; where there is none (only friction carries the load) or Newton's method fails
        from there, from the state in which all contact sticks."""
        unknown = np.zeros((len(μ), self.d - 1))
        try:
            start = frictionless(normal_part(system))
            found = frictional(system, μ, slip, unknown, start)
        except NotConverged:
            start = stuck(system, slip)
            found = self._held_by_friction(system, μ, slip, start)
        return replace(found, iterations=start.iterations + found.iterations)

    def _held_by_friction(self, system: CondensedSystem, μ: Floats, slip: Floats, start: Equilibrium) -> Equilibrium:
        try:
            return frictional(system, μ, slip, np.zeros((len(μ), self.d - 1)), start)
        except NotConverged as failure:
            if not system.load.any():
                raise
            raise NotConverged(
                f"{failure}. Or there is no equilibrium: where friction alone holds a load, bodies slide once it is "
                "more than μ times the force between them; prescribe that motion instead (Freedom with a displacement)"
            ) from failure

    def _forces(self, found: Equilibrium) -> Floats:
        force = np.zeros((len(found.force), self.d))
        force[:, : found.force.shape[1]] = found.force
        return force

    def _tractions(self, found: Equilibrium) -> list[Floats]:
        """Local tractions (q, d) at the points of each contact."""
        traction = np.zeros((len(found.traction), self.d))
        traction[:, : found.traction.shape[1]] = found.traction
        return self._split(traction)

    def _split(self, values: Floats) -> list[Floats]:
        """Values (Σq, ...) at the points of each contact."""
        return np.split(values, np.cumsum([len(op.weights) for op in self.operators])[:-1])

    def _slid(self, system: CondensedSystem, found: Equilibrium, slip: Floats) -> Floats:
        """(Σq, d−1) slip of the first body over the second in this step: (q − τ)/γ_t of the trial traction q."""
        jump = system.jumps(self._forces(found), found.motion)[:, 1:] + slip
        yielding = system.operator.stabiliser[:, 1:]
        τ = found.traction[:, 1:] if found.traction.shape[1] > 1 else 0.0
        return np.asarray(system.operator.shape @ jump - τ / yielding)

    def _body_motions(self, found: Equilibrium) -> list[Floats]:
        result, at = [], 0
        for motions in self.motions:
            value = motions.value.copy()
            value[motions.free] = found.motion[at : at + len(motions.free)]
            at += len(motions.free)
            result.append(value)
        return result

    def _solution(self, system: CondensedSystem, found: Equilibrium, slip: Floats) -> Solution:
        force = self._forces(found)
        slid = self._split(self._slid(system, found, slip))
        on_bodies = tuple(-(E.T @ force.ravel()) for E in self.maps)
        contacts = tuple(
            ContactResult.of(*own)
            for own in zip(self.problem.contacts, self.sides, self.meetings, self._tractions(found), slid)
        )
        largest = max(system.scale, float(np.abs(force).sum()))
        imbalance = found.residual / largest if largest else 0.0
        motions = tuple(self._body_motions(found))
        return Solution(contacts, motions, found.iterations, imbalance, on_bodies, self.prepared, self.step)

    def _history(self, found: Equilibrium) -> History:
        force = self._forces(found).ravel()
        motions = self._body_motions(found)
        seen = [
            self.step.load * b.load_response - b.compliance @ (E.T @ force) + b.motion_shapes @ δ
            for b, E, δ in zip(self.prepared, self.maps, motions)
        ]
        contacts = zip(self.sides, self.meetings, self._tractions(found))
        return History(tuple(self._deformed(seen, *contact) for contact in contacts))

    def _deformed(self, seen: list[Floats], sides: tuple[Side, Side], meeting: Meeting, traction: Floats) -> Places:
        """Deformed positions of both surfaces of a contact, from what is seen of the bodies."""
        result = []
        for side, surface in zip(sides, meeting.placed):
            start = self.prepared[side[0]].offsets[side[1]]
            u = seen[side[0]][start : start + surface.points.size].reshape(-1, self.d)
            result.append(surface.points + u @ self.placements[side[0]].rotation.T)
        result[0][meeting.operator.nodes] += meeting.operator.flux(traction)
        return result[0], result[1]

    def slip(self, before: History | None) -> Floats:
        """(Σn, d−1): tangential change of [x] at the present pairs of points, but for the present displacement."""
        result = []
        for i, (op, pair) in enumerate((meeting.operator, meeting.placed) for meeting in self.meetings):
            now = then = op.jump1 @ pair[0].points - op.jump2 @ pair[1].points
            if before is not None:
                then = op.jump1 @ before.points[i][0] - op.jump2 @ before.points[i][1]
            result.append(np.einsum("jta,ja->jt", op.frames[:, 1:], now - then))
        return np.concatenate(result)


def _motions_at(step: Step, index: int, assembled: Assembled) -> RigidMotions:
    """The rigid motions of body `index` with their loads and prescribed values in a step."""
    own, rigid = assembled.motions, assembled.body.rigid
    names = [f.direction for f in rigid.freedoms] if rigid else []
    load, value = step.load * own.load, step.load * own.value
    for freedom in (f for i, f in step.freedoms if i == index):
        k = names.index(freedom.direction)
        carried = step.load * float(own.shapes[:, :, k].ravel() @ assembled.load)
        load[k] = np.nan if freedom.load is None else freedom.load + carried
        value[k] = np.nan if freedom.displacement is None else freedom.displacement
    return RigidMotions(own.shapes, load, value)
