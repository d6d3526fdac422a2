"""Stress at the centres of a body's cells, for pictures and checks away from the contact.

Contact pressure is the multiplier λ of the contact formulation, not this stress.
"""

from __future__ import annotations

import numpy as np

from evolvent.fem.lagrange import gmsh_permutation, node_points, tabulate
from evolvent.fem.material import Material
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import refuse
from evolvent_meshes.mesh.mesh_data import MeshData


def cell_stress(mesh: MeshData, material: Material, displacement: Floats) -> Floats:
    """Stress tensors (n_cells, 3, 3) [MPa] at the centres of the cells; in 2D of plane strain, σ_zz = ν(σ_xx + σ_yy).

    displacement: (N, d) displacements of the mesh nodes [mm].
    Raises InputError for a displacement of another shape.
    """
    d = mesh.dimension
    if np.shape(displacement) != (len(mesh.points), d):
        wanted = f"numbers of shape {(len(mesh.points), d)}, one row a node of the mesh"
        refuse("stress, displacement", wanted, displacement, "give what Solution.displacement returns for this body")
    nodes = mesh.cells[:, gmsh_permutation(mesh.shape, mesh.order)]
    corners = node_points(mesh.shape, 1)
    dN = tabulate(mesh.shape, mesh.order, corners.mean(axis=0)[None])[1][0]
    jacobian = np.einsum("cka,tk->cat", mesh.points[nodes][..., :d], dN)
    slope = np.einsum("cka,tk,ctb->cab", displacement[nodes], dN, np.linalg.inv(jacobian))
    strain = np.zeros((len(nodes), 3, 3))
    strain[:, :d, :d] = 0.5 * (slope + np.swapaxes(slope, 1, 2))
    λ, μ = material.lame
    trace = np.trace(strain, axis1=1, axis2=2)
    stress: Floats = λ * trace[:, None, None] * np.eye(3) + 2.0 * μ * strain
    return stress


def von_mises(stress: Floats) -> Floats:
    """Von Mises stresses √(3/2 s:s) (n,) [MPa] of stress tensors (n, 3, 3) with deviator s."""
    deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
    result: Floats = np.sqrt(1.5 * np.einsum("nab,nab->n", deviator, deviator))
    return result
