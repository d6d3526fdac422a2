"""A body of a problem, assembled and condensed once for all steps to what its contact surfaces feel of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.contact.nitsche.flux_recovery import NitscheTraction, nitsche_traction, trace_functionals
from evolvent.contact.problem.definition import Nitsche, Problem
from evolvent.contact.problem.pressure_carrier import carrying
from evolvent.fem.body import Assembled, Body, assemble
from evolvent.fem.condensation.schur_complement import Factor, NotPositiveDefinite, compliance, compliance_by_columns
from evolvent.fem.surface import Surface, check_smooth, surface_of
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class PreparedBody:
    """A body condensed to the functionals of its contact surfaces.

    surfaces: one per side it takes part in. tractions: of those that carry the pressure. offsets: row at which each
    surface's functionals start. functionals: (m, N·d) what contact sees of the body, forces: (m, N·d) what it is
    pushed by, the same for θ = 1. stiffness: K' on the free degrees of freedom. load: (free,) what the external loads
    and the prescribed displacements press on them with [N]. theta: θ. compliance: C = P K'⁻¹ Pᵀ (m, m) [mm/N].
    """

    assembled: Assembled
    surfaces: dict[str, Surface]
    tractions: dict[str, NitscheTraction]
    offsets: dict[str, int]
    functionals: sp.csr_matrix
    forces: sp.csr_matrix
    stiffness: sp.csr_matrix
    load: Floats
    theta: float
    compliance: Floats

    @cached_property
    def factor(self) -> Factor:
        """The factored stiffness, for loads and fields."""
        return Factor(self.stiffness)

    @cached_property
    def load_response(self) -> Floats:
        """P u of the external loads and prescribed displacements alone, (m,)."""
        if not self.load.any():
            return self.functionals @ self.assembled.prescribed
        return self.functionals @ self._displaced(self.load, 1.0)

    @cached_property
    def motion_shapes(self) -> Floats:
        """The rigid motions at the functionals, (m, r): they carry no stress, so e = u."""
        shapes = self.assembled.motions.shapes
        nodes = [self.surfaces[group].nodes for group in self.offsets]
        return np.concatenate([shapes[n].reshape(len(n) * shapes.shape[1], shapes.shape[2]) for n in nodes])

    def displacement(self, functional_forces: Floats, load: float, motion: Floats) -> Floats:
        """(N, d) from forces on the functionals (m,)."""
        deformed = self.deformation(functional_forces, load).reshape(-1, self.assembled.d)
        return deformed + self.assembled.motions.shapes @ motion

    def deformation(self, functional_forces: Floats, load: float) -> Floats:
        """(N·d,) the same without the rigid motion."""
        pushed = (self.forces.T @ functional_forces)[self.assembled.free]
        return self._displaced(load * self.load + pushed, load)

    def _displaced(self, force: Floats, prescribed: float) -> Floats:
        """(N·d,) under forces on the free degrees of freedom and this share of the prescribed displacements."""
        u = prescribed * self.assembled.prescribed
        u[self.assembled.free] = self.factor.solve(force)
        return u


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
    for group in sorted(first):
        check_smooth(surfaces[group], f"{body.name}, contact surface {group!r}")
    tractions = {g: nitsche_traction(body.mesh, body.material, surfaces[g], nitsche.safety) for g in sorted(first)}
    K = assembled.stiffness
    trace = {g: trace_functionals(surfaces[g], K.shape[0]) for g in groups}
    flux = {g: t.flux() for g, t in tractions.items()}
    seen = sp.vstack([trace[g] - flux[g] if g in flux else trace[g] for g in groups]).tocsr()
    pushed = sp.vstack([trace[g] - θ * flux[g] if g in flux else trace[g] for g in groups]).tocsr()
    for traction in tractions.values() if θ else ():
        K = K - θ * traction.constant_term()
    free = assembled.free
    load = (assembled.load - K @ assembled.prescribed)[free]
    K = K[free][:, free].tocsr()
    if θ == 1.0 or not tractions:
        C = _compliance(body, nitsche, K, seen[:, free], assembled.stiffness[free][:, free])
    else:
        C = compliance_by_columns(Factor(K), seen[:, free], pushed[:, free])
    offsets = dict(zip(groups, np.cumsum([0] + [trace[g].shape[0] for g in groups])))
    return PreparedBody(assembled, surfaces, tractions, offsets, seen, pushed, K, load, θ, C)


def _compliance(body: Body, nitsche: Nitsche, K: sp.csr_matrix, seen: sp.csr_matrix, graph: sp.csr_matrix) -> Floats:
    """The compliance; NotPositiveDefinite says which body, and what in a problem may have done it."""
    try:
        return compliance(K, seen, graph=graph)
    except NotPositiveDefinite as error:
        raise NotPositiveDefinite(
            f"{body.name}: wanted a stiffness that is positive definite with Nitsche's γ, found one that is not; "
            f"give Nitsche a larger safety than {nitsche.safety:g} (2 is usual), or theta=-1, which needs none"
        ) from error
