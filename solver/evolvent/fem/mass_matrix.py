"""The consistent mass matrix of an elastic body."""

from __future__ import annotations

from typing import cast

import scipy.sparse as sp
import ufl

from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.body import Body


def mass_matrix(body: Body) -> sp.csr_matrix:
    """M (N·d, N·d) [t; t/mm in 2D] of a body's N nodes, on the degrees of freedom d·node + component.

    Raises CompileError and CacheError where dolfinx cannot compile the form.
    """
    (mesh, space, order), d = dolfinx_compat.displacement_space(body.mesh), body.mesh.dimension
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    ρ = dolfinx_compat.constant(mesh, float(body.material.density))
    # exact for the shape functions; the Jacobian of curved cells adds (order − 1)·d degrees
    degree = 2 * body.mesh.order + (body.mesh.order - 1) * d
    form = ρ * ufl.inner(u, v) * ufl.Measure("dx", domain=mesh, metadata={"quadrature_degree": degree})
    return cast(sp.csr_matrix, dolfinx_compat.assemble_csr(form)[order][:, order].tocsr())
