"""Small elasticity matrices in plain NumPy, for tests that need a stiffness and no dolfinx: order 1, 2D or 3D."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
import scipy.sparse as sp

from evolvent_meshes.arrays import Floats, Ints

E_MODULUS, POISSON = 210e3, 0.3


def hooke(dimension: int) -> Floats:
    """Elasticity tensor C_ijkl (plane strain in 2D)."""
    shear = E_MODULUS / (2 * (1 + POISSON))
    lame = E_MODULUS * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    one = np.eye(dimension)
    mixed = np.einsum("ik,jl->ijkl", one, one) + np.einsum("il,jk->ijkl", one, one)
    return lame * np.einsum("ij,kl->ijkl", one, one) + shear * mixed


def stiffness(points: Floats, cells: Ints, corners_of: Ints | None = None) -> sp.csr_matrix:
    """K of order-1 quadrilaterals or hexahedra, `cells` with lexicographic corners (last coordinate fastest).

    `corners_of` are the cells as the points have them, where `cells` joins nodes at equal places.
    """
    places = points[cells if corners_of is None else corners_of]
    dimension = points.shape[1]
    corners = np.array(list(product((-1.0, 1.0), repeat=dimension)))
    tensor = hooke(dimension)
    size = dimension * cells.shape[1]
    local = np.zeros((len(cells), size, size))
    for gauss in corners / np.sqrt(3):
        terms = (1 + corners * gauss) / 2
        slopes = np.stack([corners[:, a] / 2 * np.delete(terms, a, axis=1).prod(axis=1) for a in range(dimension)], 1)
        jacobian = np.einsum("cni,na->cia", places, slopes)
        gradients = np.einsum("na,cai->cni", slopes, np.linalg.inv(jacobian))
        part = np.einsum("cnj,ijkl,cml->cnimk", gradients, tensor, gradients).reshape(local.shape)
        local += np.abs(np.linalg.det(jacobian))[:, None, None] * part
    dofs = (dimension * cells[:, :, None] + np.arange(dimension)).reshape(len(cells), size)
    rows, columns = np.repeat(dofs, size, axis=1), np.tile(dofs, (1, size))
    count = dimension * len(points)
    return sp.coo_matrix((local.ravel(), (rows.ravel(), columns.ravel())), shape=(count, count)).tocsr()


def grid_cells(counts: tuple[int, ...]) -> tuple[Ints, Ints]:
    """Node numbers (counts + 1, C order) and cells of a structured grid."""
    numbers = np.arange(np.prod(np.add(counts, 1))).reshape(np.add(counts, 1))
    shifts = product((0, 1), repeat=len(counts))
    corners = [numbers[tuple(slice(s, s + n) for s, n in zip(shift, counts, strict=True))].ravel() for shift in shifts]
    return numbers, np.stack(corners, axis=1)


def dofs_of(nodes: Ints, dimension: int) -> Ints:
    """Degrees of freedom of `nodes`, node by node."""
    return (dimension * np.ravel(nodes)[:, None] + np.arange(dimension)).ravel()


def block(counts: tuple[int, int, int]) -> tuple[sp.csr_matrix, Ints, sp.csr_matrix]:
    """K of a block with unit cells, free dofs (bottom z = 0 held), and displacement + traction-like functionals."""
    numbers, cells = grid_cells(counts)
    points = np.indices(numbers.shape).reshape(3, -1).T.astype(float)
    matrix = stiffness(points, cells)
    top = dofs_of(numbers[:, :, -1], 3)
    pick = sp.csr_matrix((np.ones(len(top)), (np.arange(len(top)), top)), shape=(len(top), matrix.shape[0]))
    return matrix, dofs_of(numbers[:, :, 1:], 3), (pick - 1e-6 * matrix[top]).tocsr()


@dataclass(frozen=True)
class Ring:
    """`count` sectors of an annulus (toothed outer edge), held at the bore; nodes (radius, angle, [z]).

    `free` are the free dofs; `low`, `high` the cut faces' dofs and `surface[s]` those of sector s's outer surface.
    """

    stiffness: sp.csr_matrix
    free: Ints
    low: Ints
    high: Ints
    surface: list[Ints]
    dimension: int


def ring(counts: tuple[int, ...], count: int, pitch: float, first: int = 0, closed: bool = False) -> Ring:
    """Sectors `first` … `first + count − 1` of `counts` (radial, angular, [axial]) cells each; sector 0 is about +x.

    `closed` joins the last cut to the first one; the last one's nodes are then no longer used nor free.
    """
    radial, angular, *axial = counts
    dimension = len(counts)
    numbers, cells = grid_cells((radial, angular * count, *axial))
    fractions = np.indices(numbers.shape).reshape(dimension, -1).astype(float)
    along = fractions[1] / angular
    angle = (along + first - 0.5) * pitch
    depth = fractions[0] / radial
    # a bump with the period of a pitch stands for the tooth; the skew breaks the symmetry low-high
    radius = 10.0 + depth * (4.0 + 1.5 * np.sin(np.pi * along) ** 2 * depth)
    angle += 0.1 * pitch * depth * (1 - depth) * np.sin(2 * np.pi * along)
    coordinates = [radius * np.cos(angle), radius * np.sin(angle)]
    if axial:
        coordinates.append(2.0 * fractions[2] / axial[0])
    used = np.arange(numbers.size)
    if closed:
        used[numbers[:, -1]] = numbers[:, 0]
    outer = [numbers[-1, 1 + s * angular : (s + 1) * angular] for s in range(count)]
    return Ring(
        stiffness=stiffness(np.stack(coordinates, axis=1), used[cells], cells),
        free=dofs_of(numbers[1:, :-1] if closed else numbers[1:], dimension),
        low=dofs_of(numbers[1:, 0], dimension),
        high=dofs_of(numbers[1:, -1], dimension),
        surface=[dofs_of(nodes, dimension) for nodes in outer],
        dimension=dimension,
    )
