"""A body of a contact problem, assembled and condensed once for all steps to the functionals of its contact surfaces.

Contact couples to a body only through functionals of its displacement u: the extended trace e = u − F(u) at the nodes
of a surface that carries the pressure (F: recovered flux, flux_recovery.py), the trace u at the nodes of the other
side. P is their matrix, P_θ that of the test functions, with θF in place of F. Under forces f on the functionals

    K' u = load + P_θᵀ f ,   K' = K − θ ∫ γF·F ,

so that the contact system needs no more of the body than its compliance C = P K'⁻¹ P_θᵀ.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.contact.nitsche.flux_recovery import NitscheTraction, nitsche_traction, trace_functionals
from evolvent.contact.problem.definition import Nitsche, Problem
from evolvent.contact.problem.pressure_carrier import pressure_sides
from evolvent.fem.backend.dolfinx_mesh import NodalSpace, nodal_space
from evolvent.fem.body import Assembled, Body, assemble
from evolvent.fem.condensation.schur_complement import Factor, NotPositiveDefinite, compliance, compliance_by_columns
from evolvent.fem.surface import Surface, check_smooth, surface_of
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class CondensedBody:
    """A body with N mesh nodes in d dimensions, condensed to the m functionals of its contact surfaces.

    assembled: stiffness, loads, supports and rigid motions of the body, with the body itself.
    surfaces: facet group -> contact surface.
    tractions: facet group -> recovered traction, of the surfaces that carry the pressure.
    offsets: facet group -> row of its first functional.
    functionals: P (m, N·d).
    test_functionals: P_θ (m, N·d).
    stiffness: K' on the free degrees of freedom (free, free) [N/mm].
    load: external loads and prescribed displacements as forces on the free degrees of freedom (free,) [N].
    theta: θ of Nitsche's method.
    compliance: C (m, m) [mm/N].
    """

    assembled: Assembled
    surfaces: dict[str, Surface]
    tractions: dict[str, NitscheTraction]
    offsets: dict[str, int]
    functionals: sp.csr_matrix
    test_functionals: sp.csr_matrix
    stiffness: sp.csr_matrix
    load: Floats
    theta: float
    compliance: Floats

    @cached_property
    def factor(self) -> Factor:
        """The factored stiffness, for loads and fields."""
        return Factor(self.stiffness)

    @cached_property
    def nodal_space(self) -> NodalSpace:
        """dolfinx' space of the displacements of the body's nodes."""
        return nodal_space(self.assembled.body.mesh)

    @cached_property
    def load_response(self) -> Floats:
        """P u under the external loads and prescribed displacements alone, (m,) [mm]."""
        if not self.load.any():
            return self.functionals @ self.assembled.prescribed
        return self.functionals @ self._displacement(self.load, 1.0)

    @cached_property
    def motion_shapes(self) -> Floats:
        """The r rigid motions at the functionals, (m, r): they carry no stress, so that e = u."""
        shapes = self.assembled.motions.shapes
        nodes = [self.surfaces[group].nodes for group in self.offsets]
        return np.concatenate([shapes[n].reshape(len(n) * shapes.shape[1], shapes.shape[2]) for n in nodes])

    def displacement(self, functional_forces: Floats, load: float, motion: Floats) -> Floats:
        """Displacement of the nodes (N, d) [mm] under forces on the functionals (m,) [N], a load factor and amplitudes
        of the rigid motions (r,)."""
        deformed = self.deformation(functional_forces, load).reshape(-1, self.assembled.d)
        return deformed + self.assembled.motions.shapes @ motion

    def deformation(self, functional_forces: Floats, load: float) -> Floats:
        """Displacement of the nodes without rigid motions (N·d,) [mm] under forces on the functionals (m,) [N] and a
        load factor."""
        contact_load = (self.test_functionals.T @ functional_forces)[self.assembled.free]
        return self._displacement(load * self.load + contact_load, load)

    def _displacement(self, force: Floats, prescribed: float) -> Floats:
        """Displacement (N·d,) [mm] under forces on the free degrees of freedom and a fraction of the prescribed
        displacements."""
        u = prescribed * self.assembled.prescribed
        u[self.assembled.free] = self.factor.solve(force)
        return u


def condense_bodies(problem: Problem) -> tuple[CondensedBody, ...]:
    """Assembles and condenses every body of a problem.

    Raises NotPositiveDefinite where supports do not hold a body or γ is too small, OutOfMemory, MeshError for a contact
    surface with sharp edges.
    """
    return tuple(
        _condensed(body, _groups(problem, i, carrier=True), _groups(problem, i, carrier=False), problem.nitsche)
        for i, body in enumerate(problem.bodies)
    )


def _groups(problem: Problem, body: int, carrier: bool) -> set[str]:
    """The facet groups of a body that carry the pressure of a contact, or those on the other side of one."""
    sides = [pressure_sides(problem.bodies, contact)[0 if carrier else 1] for contact in problem.contacts]
    return {group for index, group in sides if index == body}


def _condensed(body: Body, carriers: set[str], others: set[str], nitsche: Nitsche) -> CondensedBody:
    assembled, groups, θ = assemble(body), sorted(carriers | others), nitsche.theta
    surfaces = {g: surface_of(body.mesh, g) for g in groups}
    for group in sorted(carriers):
        check_smooth(surfaces[group], f"{body.name}, contact surface {group!r}")
    tractions = {g: nitsche_traction(body.mesh, body.material, surfaces[g], nitsche.safety) for g in sorted(carriers)}
    K = assembled.stiffness
    trace = {g: trace_functionals(surfaces[g], K.shape[0]) for g in groups}
    flux = {g: t.flux() for g, t in tractions.items()}
    P = sp.vstack([trace[g] - flux[g] if g in flux else trace[g] for g in groups]).tocsr()
    P_θ = sp.vstack([trace[g] - θ * flux[g] if g in flux else trace[g] for g in groups]).tocsr()
    for traction in tractions.values() if θ else ():
        K = K - θ * traction.constant_term()
    free = assembled.free
    load = (assembled.load - K @ assembled.prescribed)[free]
    K = K[free][:, free].tocsr()
    if θ == 1.0 or not tractions:
        C = _compliance(body, nitsche, K, P[:, free], assembled.stiffness[free][:, free])
    else:
        C = compliance_by_columns(Factor(K), P[:, free], P_θ[:, free])
    offsets = dict(zip(groups, np.cumsum([0] + [trace[g].shape[0] for g in groups])))
    return CondensedBody(assembled, surfaces, tractions, offsets, P, P_θ, K, load, θ, C)


def _compliance(body: Body, nitsche: Nitsche, K: sp.csr_matrix, P: sp.csr_matrix, graph: sp.csr_matrix) -> Floats:
    """C of the symmetric variant. NotPositiveDefinite names the body and the setting that may have caused it."""
    try:
        return compliance(K, P, graph=graph)
    except NotPositiveDefinite as error:
        raise NotPositiveDefinite(
            f"{body.name}: wanted a stiffness that is positive definite with Nitsche's γ, found one that is not; "
            f"give Nitsche a larger safety than {nitsche.safety:g} (2 is usual), or theta=-1, which needs none"
        ) from error
