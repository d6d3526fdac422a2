"""Stress on free surfaces against exact fields: uniform strain, and holes in a plate."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse.linalg as spla

from evolvent.fem.body import Body, Fixed, assemble
from evolvent.fem.material import Material
from evolvent.fem.surface import surface_of
from evolvent.fem.surface_stress import surface_stress
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.structured_grid import boundary_facets, facets_where, lattice_cells
from evolvent_meshes.shapes.blocks import box, rectangle

MATERIAL = Material(210e3, 0.3)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", ["triangle", "quadrilateral", "tetrahedron", "hexahedron"])
def test_uniform_stress_along_a_free_surface(shape: str, order: int) -> None:
    """Tension along x, in space with pressure along y and shear, all in the plane of the top, which bears no traction:
    the stress of Hooke's law at every node, 1e-9; in plane strain σ_zz = ν σ_xx."""
    plane = shape in ("triangle", "quadrilateral")
    mesh = rectangle(2.0, 1.0, 3, 2, order, shape) if plane else box((2.0, 1.0, 1.5), (2, 2, 2), order, shape)
    d, E, ν = mesh.dimension, 210e3, 0.3
    normal = d - 1  # the top's
    σ = np.zeros((3, 3))
    σ[0, 0] = 100.0
    if plane:
        σ[2, 2] = ν * σ[0, 0]
    else:
        σ[0, 1] = σ[1, 0] = 30.0
        σ[1, 1] = -40.0
    ε = (1.0 + ν) / E * σ - ν / E * np.trace(σ) * np.eye(3)
    surface = surface_of(mesh, "top")
    assert np.allclose(surface.points[:, normal], surface.points[0, normal])
    found = surface_stress(surface, MATERIAL, surface.points @ ε[:d, :d].T)
    assert np.allclose(found, σ, atol=1e-9)


class PlateWithHole:
    """An infinite plate in plane strain with an elliptical hole, pulled across the hole's larger axis, which is x:
    exact displacements and edge stresses by Kolosov's and Muskhelishvili's potentials. Half-axes 1 ± m [mm], tension
    1 MPa."""

    def __init__(self, m: float) -> None:
        self.m = m

    def point(self, ζ: Floats) -> Floats:
        """Complex place of points |ζ| ≥ 1; the hole's edge is |ζ| = 1."""
        return np.asarray(ζ + self.m / ζ)

    def displacement(self, ζ: Floats) -> Floats:
        """(n, 2) [mm]."""
        m, e = self.m, -1.0  # e = exp(2iβ) of a tension along y
        κ, μ = 3.0 - 4.0 * 0.3, MATERIAL.lame[1]
        φ = 0.25 * (ζ + (2.0 * e - m) / ζ)
        slope = 0.25 * (1.0 - (2.0 * e - m) / ζ**2) / (1.0 - m / ζ**2)
        ψ = -0.5 * (e * ζ + e / (m * ζ) - (1.0 + m**2) * (e - m) / m * ζ / (ζ**2 - m))
        u = (κ * φ - self.point(ζ) * np.conj(slope) - np.conj(ψ)) / (2.0 * μ)
        return np.stack([u.real, u.imag], axis=-1)

    def edge_stress(self, ζ: Floats) -> Floats:
        """(n,) along the hole's edge [MPa]: the trace of the stress, 4 Re φ′(z)."""
        return np.asarray(((1.0 + (2.0 + self.m) / ζ**2) / (1.0 - self.m / ζ**2)).real)

    def errors(self, cells: int) -> tuple[float, float]:
        """Largest and root mean square error of the edge stress over its largest value, with so many cells around a
        quarter of the hole, whose size grows with the distance."""
        angles = np.linspace(0.0, 0.5 * np.pi, 2 * cells + 1)
        distances = np.exp(0.5 * np.pi / cells * np.arange(2 * cells + 1) / 2.0)
        ζ = (distances[:, None] * np.exp(1j * angles)).ravel()
        z = self.point(ζ)
        nodes = np.stack([z.real, z.imag, np.zeros(len(z))], axis=-1)
        quadrilaterals = lattice_cells((cells, cells), 2)
        facets = boundary_facets("quadrilateral", 2, quadrilaterals)
        hole = np.abs(np.abs(ζ) - 1.0) < 1e-12
        elsewhere = ~np.isin(facets, np.flatnonzero(hole)).all(axis=1)
        groups = {"hole": facets_where(facets, hole), "outside": facets[elsewhere]}
        mesh = MeshData(nodes, "quadrilateral", 2, quadrilaterals, groups, {"plate": np.arange(len(quadrilaterals))})
        K = assemble(Body(mesh, MATERIAL, supports=(Fixed("outside"),))).stiffness
        u, held = self.displacement(ζ).ravel(), np.zeros(2 * len(ζ), dtype=bool)
        held.reshape(-1, 2)[np.unique(groups["outside"])] = True
        solved = np.where(held, u, 0.0)
        solved[~held] = spla.spsolve(K[~held][:, ~held].tocsc(), -(K[~held][:, held] @ u[held]))
        edge = surface_of(mesh, "hole")
        stress = surface_stress(edge, MATERIAL, solved.reshape(-1, 2)[edge.nodes])
        exact = self.edge_stress(ζ[edge.nodes])
        error = stress[:, 0, 0] + stress[:, 1, 1] - exact
        return float(np.abs(error).max() / exact.max()), float(np.sqrt(np.mean(error**2)) / exact.max())


@pytest.mark.parametrize(("m", "factor"), [(1e-5, 3.0), (0.5, 7.0)], ids=["circle", "ellipse 3:1"])
def test_stress_concentration_of_a_hole(m: float, factor: float) -> None:
    """K_t = 1 + 2a/b at the ends of the larger axis: the whole edge within 0.5 % of it with 30 cells around a quarter;
    root mean square errors fall by more than three where cells are halved."""
    plate = PlateWithHole(m)
    assert plate.edge_stress(np.array([1.0 + 0j]))[0] == pytest.approx(factor, rel=1e-4)
    (_, coarse), (largest, fine) = plate.errors(15), plate.errors(30)
    assert largest < 0.005
    assert fine < coarse / 3.0
