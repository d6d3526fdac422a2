"""The contact system of one step of a sweep, and what it finds."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from meshes.data import Floats, Ints
from meshes.inputs import is_index, refuse
from solver.body import Assembled, RigidMotions
from solver.equilibrium import CondensedSystem, Equilibrium, frictional, frictionless, normal_part, stuck
from solver.newton import NotConverged
from solver.nitsche import ContactOperator, contact_operator, stacked
from solver.prepared import PreparedBody
from solver.search import Pairing, SearchError, pair_surfaces
from solver.statement import Contact, Placement, Problem, Side, Step, check_step
from solver.surface import Surface


@dataclass(frozen=True)
class ContactResult:
    """One contact of a solution, at the q quadrature points of the first surface that face the second one.

    points: (q, d) their positions. normals: (q, d). weights: (q,) [mm²; mm in 2D]. pressure: (q,) λ [MPa]. traction:
    (q, d) λn + τ in the common frame [MPa], what the first body presses on the second with. slip: (q, d) [mm] of the
    first body over the second since the step before, in the first step since rest; zero where the points stick.
    carrier: the surface that carries the pressure, (body, group). facets: (q,) of it. local: (q, d-1) reference points
    on them.
    """

    points: Floats
    normals: Floats
    weights: Floats
    pressure: Floats
    traction: Floats
    slip: Floats
    carrier: Side
    facets: Ints
    local: Floats

    @property
    def force(self) -> Floats:
        """Resultant (d,) on the second body [N; N/mm in 2D]."""
        return self.weights @ self.traction


@dataclass(frozen=True)
class Solution:
    """Equilibrium of a problem at one step.

    motions: per body (r,) rigid motions in the order of its freedoms [mm, rad]. iterations: Newton's, of the start and
    of the friction law. imbalance: largest residual force over the largest force. nodal_forces: per body, on what is
    seen of it.
    """

    contacts: tuple[ContactResult, ...]
    motions: tuple[Floats, ...]
    iterations: int
    imbalance: float
    nodal_forces: tuple[Floats, ...]
    prepared: tuple[PreparedBody, ...]
    step: Step

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
    """Deformed positions of the surfaces of each contact at the last step: (n1, d) and (n2, d) in the common frame."""

    points: tuple[tuple[Floats, Floats], ...]


def reach_of(contact: Contact, first: Surface) -> float:
    """The gap [mm] up to which a contact whose first surface is given is looked for."""
    return contact.reach or 0.1 * float(np.ptp(first.points, axis=0).max())


class Position:
    """The condensed contact system of one step. Raises InputError for a step of another problem, SearchError."""

    def __init__(self, problem: Problem, prepared: tuple[PreparedBody, ...], step: Step) -> None:
        self.problem, self.prepared, self.step = problem, prepared, step
        self.d = prepared[0].assembled.d
        check_step(problem, step)
        self.placements = step.placements or tuple(Placement.at_rest(self.d) for _ in prepared)
        self.placed = [(self._surface(c.first), self._surface(c.second)) for c in problem.contacts]
        self.pairings = [self._pairing(c, *pair) for c, pair in zip(problem.contacts, self.placed)]
        self.operators = [
            self._operator(c, p, *pair) for c, p, pair in zip(problem.contacts, self.pairings, self.placed)
        ]
        self.maps = [self._map(b) for b in range(len(prepared))]
        self.motions = [_motions_at(step, b, body.assembled) for b, body in enumerate(prepared)]

    def _surface(self, side: Side) -> Surface:
        where = self.placements[side[0]]
        return self.prepared[side[0]].surfaces[side[1]].moved(where.rotation, where.translation)

    def _pairing(self, contact: Contact, first: Surface, second: Surface) -> Pairing:
        reach = reach_of(contact, first)
        found = pair_surfaces(first, second, reach, reach)
        if not len(found.facet1):
            raise SearchError(
                f"contact between {contact.first[1]!r} of body {contact.first[0]} and {contact.second[1]!r} of body "
                f"{contact.second[0]}: wanted surfaces within {reach:.3g} mm of each other, found none; place the "
                "bodies closer together, or give the contact a larger reach"
            )
        return found

    def _operator(self, contact: Contact, pairing: Pairing, first: Surface, second: Surface) -> ContactOperator:
        traction = self.prepared[contact.first[0]].tractions[contact.first[1]]
        frames = traction.frames @ self.placements[contact.first[0]].rotation.T
        return contact_operator(pairing, first, second, traction.stabiliser, frames)

    def _map(self, body: int) -> sp.csr_matrix:
        """E_b (Σn·d, m_b): functionals of a body to the local jumps of all contacts."""
        d, prepared = self.d, self.prepared[body]
        rows = []
        for contact, op in zip(self.problem.contacts, self.operators):
            block = sp.csr_matrix((len(op.nodes) * d, prepared.functionals.shape[0]))
            for number, side in ((1, contact.first), (2, contact.second)):
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

    def as_seen(self, contact: int) -> ContactOperator:
        """A contact's operator as the contact law sees it."""
        return self.operators[contact]

    def load_jump(self) -> Floats:
        """Local jumps (Σn·d,) that the external loads alone would make."""
        return self.step.load * sum(E @ b.load_response for E, b in zip(self.maps, self.prepared))

    def system(self) -> CondensedSystem:
        """Compliance, motions and loads of all bodies in local jumps."""
        operator = stacked([self.as_seen(i) for i in range(len(self.operators))])
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

    def solve(self, before: History | None) -> tuple[Solution, History]:
        """Equilibrium, with the slip since `before`."""
        system = self.system()
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
            found = frictional(system, μ, slip, unknown, start)
        return replace(found, iterations=start.iterations + found.iterations)

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
        sides = [contact.first for contact in self.problem.contacts]
        each = zip(sides, self.pairings, self.operators, self._tractions(found), slid)
        contacts = tuple(_contact_result(*own) for own in each)
        largest = max(system.scale, float(np.abs(force).sum()))
        imbalance = found.residual / largest if largest else 0.0
        return Solution(
            contacts, tuple(self._body_motions(found)), found.iterations, imbalance, on_bodies, self.prepared, self.step
        )

    def _history(self, found: Equilibrium) -> History:
        force = self._forces(found).ravel()
        motions = self._body_motions(found)
        seen = [
            self.step.load * b.load_response - b.compliance @ (E.T @ force) + b.motion_shapes @ δ
            for b, E, δ in zip(self.prepared, self.maps, motions)
        ]
        contacts = zip(self.problem.contacts, self.operators, self.placed, self._tractions(found))
        return History(tuple(self._deformed(seen, *contact) for contact in contacts))

    def _deformed(
        self, seen: list[Floats], contact: Contact, op: ContactOperator, pair: tuple[Surface, Surface], traction: Floats
    ) -> tuple[Floats, Floats]:
        """Deformed positions of both surfaces of a contact, from what is seen of the bodies."""
        result = []
        for side, surface in zip((contact.first, contact.second), pair):
            start = self.prepared[side[0]].offsets[side[1]]
            u = seen[side[0]][start : start + surface.points.size].reshape(-1, self.d)
            result.append(surface.points + u @ self.placements[side[0]].rotation.T)
        result[0][op.nodes] += op.flux(traction)
        return result[0], result[1]

    def slip(self, before: History | None) -> Floats:
        """(Σn, d−1): tangential change of [x] at the present pairs of points, but for the present displacement."""
        result = []
        for i, (op, pair) in enumerate(zip(self.operators, self.placed)):
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


def _contact_result(
    carrier: Side, pairing: Pairing, op: ContactOperator, local: Floats, slid: Floats
) -> ContactResult:
    normals = op.common(np.eye(op.d)[:1].repeat(len(local), axis=0))
    slip = op.common(np.hstack([np.zeros((len(slid), 1)), slid]))
    traction = op.common(local)
    return ContactResult(
        op.points, normals, op.weights, local[:, 0], traction, slip, carrier, pairing.facet1, pairing.xi1
    )
