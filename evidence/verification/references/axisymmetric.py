"""An independent solution for a round body pressed on its mirror image: Signorini's problem in the section r, z.

Two equal bodies touch in the plane between them, whatever their shape. So one of them is pressed on a rigid plane
without friction: z + u_z >= 0 at the nodes of its underside. Linear elasticity, second-order quadrilaterals, an active
set of nodes. Of the contact solver only the shape functions are used.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from evolvent.fem.lagrange import gmsh_permutation, quadrature, tabulate
from evolvent.fem.material import Material
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.structured_grid import graded_ends, lattice_cells, subdivided

ROUNDS = 50


@dataclass(frozen=True)
class MeridianSection:
    """A mesh of the section r, z.

    points: (n, 2), r and z [mm].
    cells:  (m, 9), in basix's order.
    under:  (k,), nodes of the underside, from the axis outwards.
    top:    (k,), nodes of the top.
    axis:   (l,), nodes of the axis.
    """

    points: Floats
    cells: Ints
    under: Ints
    top: Ints
    axis: Ints


def sphere_section(radius: float, side: float, height: float, a: float, cells: int) -> MeridianSection:
    """Of an upright cylinder of radius `side`, flat at z = `height`, whose underside is a sphere that touches z = 0;
    cells of a/`cells` up to 1.3 a from the axis. All lengths in mm."""
    line = np.append(np.linspace(0.0, a, cells + 1)[:-1], a + graded_ends(side - a, a / cells, 0.3 * a, 1.15))
    r, z = subdivided(line, 2), subdivided(graded_ends(height, a / cells, 0.6 * a, 1.15), 2)
    sag = radius - np.sqrt(radius**2 - r**2)
    heights = sag[:, None] + z * (1.0 - sag[:, None] / height)
    points = np.stack([np.broadcast_to(r[:, None], heights.shape), heights], axis=-1).reshape(-1, 2)
    number = np.arange(len(points)).reshape(heights.shape)
    cells_of_nodes = lattice_cells((len(r) // 2, len(z) // 2), 2)[:, gmsh_permutation("quadrilateral", 2)]
    return MeridianSection(points, cells_of_nodes, number[:, 0], number[:, -1], number[0])


def pressed_on_plane(section: MeridianSection, material: Material, approach: float) -> tuple[float, Floats, Floats]:
    """A body whose top comes nearer to the plane by `approach` [mm]: force on the whole of it [N], radii (n,) of the
    nodes of its underside [mm], pressure (n,) there [MPa]. Raises RuntimeError where the active set keeps changing."""
    K, n = _stiffness(section, material), 2 * len(section.points)
    held, u = np.zeros(n, dtype=bool), np.zeros(n)
    held[[*(2 * section.top), *(2 * section.top + 1), *(2 * section.axis)]] = True
    u[2 * section.top + 1] = -approach
    gap, down = section.points[section.under, 1], 2 * section.under + 1
    active = gap < approach
    for _ in range(ROUNDS):
        fixed = held.copy()
        fixed[down[active]] = True
        u[down[active]] = -gap[active]
        free = ~fixed
        u[free] = spla.spsolve(K[free][:, free].tocsc(), -(K[free][:, fixed] @ u[fixed]))
        reaction = (K @ u)[down]
        then, active = active, np.where(active, reaction > 0.0, u[down] + gap < -1e-14)
        if (then == active).all():
            force = np.where(active, reaction, 0.0)
            r = section.points[section.under, 0]
            pressure = np.where(active, spla.spsolve(_mass(r), force), 0.0)
            return float(2.0 * np.pi * force.sum()), r, pressure
    raise RuntimeError(f"active set: wanted one that stays, found it changing after {ROUNDS} rounds")


def _stiffness(section: MeridianSection, material: Material) -> sp.csr_matrix:
    """∫ε:σ r dr dz, strains rr, zz, θθ, 2rz."""
    xi, w = quadrature("quadrilateral", 5)
    N, dN = tabulate("quadrilateral", 2, xi)
    x = section.points[section.cells]
    J = np.einsum("fka,qtk->fqat", x, dN)
    G = np.einsum("qtk,fqta->fqka", dN, np.linalg.inv(J))
    r = np.einsum("qk,fk->fq", N, x[..., 0])
    f, q, k, _ = G.shape
    B = np.zeros((f, q, 4, k, 2))
    B[:, :, 0, :, 0] = B[:, :, 3, :, 1] = G[..., 0]
    B[:, :, 1, :, 1] = B[:, :, 3, :, 0] = G[..., 1]
    B[:, :, 2, :, 0] = N / r[..., None]
    λ, μ = material.lame
    D = np.diag([2.0 * μ, 2.0 * μ, 2.0 * μ, μ]) + λ * np.outer([1.0, 1.0, 1.0, 0.0], [1.0, 1.0, 1.0, 0.0])
    B = B.reshape(f, q, 4, 2 * k)
    K = np.einsum("fq,fqai,ab,fqbj->fij", w * np.abs(np.linalg.det(J)) * r, B, D, B, optimize=True)
    dofs = (2 * section.cells[:, :, None] + np.arange(2)).reshape(f, -1)
    i, j = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
    return sp.csr_matrix((K.ravel(), (i.ravel(), j.ravel())), (2 * len(section.points),) * 2)


def _mass(r: Floats) -> sp.csc_matrix:
    """∫N_i N_j r dr over a line of second-order cells with nodes at r (n,)."""
    xi, w = quadrature("interval", 5)
    N, dN = tabulate("interval", 2, xi)
    nodes = np.arange(len(r) - 2)[::2, None] + np.array([0, 2, 1])
    values = np.einsum("fq,qi,qj->fij", w * (r[nodes] @ N.T) * (r[nodes] @ dN[:, 0].T), N, N)
    i, j = np.broadcast_arrays(nodes[:, :, None], nodes[:, None, :])
    return sp.csc_matrix((values.ravel(), (i.ravel(), j.ravel())), (len(r),) * 2)
