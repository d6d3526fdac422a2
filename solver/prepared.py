"""A body of a problem, assembled and condensed once for all steps to what its contact surfaces feel of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from meshes.data import Floats
from solver.body import Assembled, Body, assemble
from solver.carrier import carrying
from solver.condense import Factor, compliance, compliance_by_columns
from solver.statement import Nitsche, Problem
from solver.surface import Surface, surface_of
from solver.traction import NitscheTraction, nitsche_traction, trace_functionals


@dataclass(frozen=True)
class PreparedBody:
    """A body condensed to the functionals of its contact surfaces.

    surfaces: one per side it takes part in. tractions: of those that carry the pressure. offsets: row at which each
    surface's functionals start. functionals: (m, N·d) what contact sees of the body, forces: (m, N·d) what it is
    pushed by, the same for θ = 1. stiffness: K' on the free degrees of freedom. compliance: C = P K'⁻¹ Pᵀ (m, m)
    [mm/N].
    """

    assembled: Assembled
    surfaces: dict[str, Surface]
    tractions: dict[str, NitscheTraction]
    offsets: dict[str, int]
    functionals: sp.csr_matrix
    forces: sp.csr_matrix
    stiffness: sp.csr_matrix
    compliance: Floats

    @cached_property
    def factor(self) -> Factor:
        """The factored stiffness, for loads and fields."""
        return Factor(self.stiffness)

    @cached_property
    def load_response(self) -> Floats:
        """P K'⁻¹ f of the external loads, (m,)."""
        load = self.assembled.load[self.assembled.free]
        if not load.any():
            return np.zeros(self.functionals.shape[0])
        return self.functionals[:, self.assembled.free] @ self.factor.solve(load)

    @cached_property
    def motion_shapes(self) -> Floats:
        """The rigid motions at the functionals, (m, r): they carry no stress, so e = u."""
        shapes = self.assembled.motions.shapes
        nodes = [self.surfaces[group].nodes for group in self.offsets]
        return np.concatenate([shapes[n].reshape(len(n) * shapes.shape[1], shapes.shape[2]) for n in nodes])

    def displacement(self, functional_forces: Floats, load: float, motion: Floats) -> Floats:
        """(N, d) from forces on the functionals (m,)."""
        a = self.assembled
        u = np.zeros(a.stiffness.shape[0])
        u[a.free] = self.factor.solve((load * a.load + self.forces.T @ functional_forces)[a.free])
        return u.reshape(-1, a.d) + a.motions.shapes @ motion


def prepare(problem: Problem) -> tuple[PreparedBody, ...]:
    """Assembles and condenses every body once. Raises NotPositiveDefinite where a body is not held, OutOfMemory."""
    return tuple(
        _prepared(body, _groups(problem, i, first=True), _groups(problem, i, first=False), problem.nitsche)
        for i, body in enumerate(problem.bodies)
    )


def _groups(problem: Problem, body: int, first: bool) -> set[str]:
    """The facet groups of a body that carry the pressure of a contact, or are the other side of one."""
    sides = [carrying(problem.bodies, contact)[0 if first else 1] for contact in problem.contacts]
    return {group for index, group in sides if index == body}


def _prepared(body: Body, first: set[str], second: set[str], nitsche: Nitsche) -> PreparedBody:
    assembled, groups, θ = assemble(body), sorted(first | second), nitsche.theta
    surfaces = {g: surface_of(body.mesh, g) for g in groups}
    tractions = {g: nitsche_traction(body.mesh, body.material, surfaces[g], nitsche.safety) for g in sorted(first)}
    K = assembled.stiffness
    trace = {g: trace_functionals(surfaces[g], K.shape[0]) for g in groups}
    flux = {g: t.flux() for g, t in tractions.items()}
    seen = sp.vstack([trace[g] - flux[g] if g in flux else trace[g] for g in groups]).tocsr()
    pushed = sp.vstack([trace[g] - θ * flux[g] if g in flux else trace[g] for g in groups]).tocsr()
    for traction in tractions.values() if θ else ():
        K = K - θ * traction.constant_term()
    free = assembled.free
    K = K[free][:, free].tocsr()
    if θ == 1.0 or not tractions:
        C = compliance(K, seen[:, free], graph=assembled.stiffness[free][:, free])
    else:
        C = compliance_by_columns(Factor(K), seen[:, free], pushed[:, free])
    offsets = dict(zip(groups, np.cumsum([0] + [trace[g].shape[0] for g in groups])))
    return PreparedBody(assembled, surfaces, tractions, offsets, seen, pushed, K, C)
