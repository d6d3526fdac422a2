"""Stress below point forces: equations of elasticity, and the closed form below a sphere that slides."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.strength.fatigue.half_plane import HertzTractions
from evolvent.strength.fatigue.half_space import PointForces
from evolvent_meshes.arrays import Floats

NU = 0.3
FORCES = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.4, -0.7, 1.3]])
AT = np.array([[0.3, -0.4, 0.5], [-1.0, 0.2, 0.3], [1e-3, 2e-3, 0.7]])
STEP = 1e-3


def below(force: Floats, at: Floats) -> Floats:
    return PointForces(np.zeros((1, 2)), force[None], NU).stress(at)


def slopes(force: Floats, at: Floats) -> Floats:
    """∂σ/∂x_c (k, c, 3, 3) by central differences of fourth order."""
    near = [(below(force, at + n * STEP * e) - below(force, at - n * STEP * e)) for n in (1, 2) for e in np.eye(3)]
    return np.stack([(8.0 * near[c] - near[3 + c]) / (12.0 * STEP) for c in range(3)], axis=1)


@pytest.mark.parametrize("force", FORCES)
def test_equilibrium_inside(force: Floats) -> None:
    """∂σ_ac/∂x_c = 0, to 1e-6 of the slopes."""
    slope = slopes(force, AT)
    assert np.abs(np.einsum("kcac->ka", slope)).max() < 1e-6 * np.abs(slope).max()


@pytest.mark.parametrize("force", FORCES)
def test_compatible_strains(force: Floats) -> None:
    """Beltrami and Michell: Δσ_ab + ∂²tr σ/∂x_a∂x_b/(1 + ν) = 0, to 1e-4 of its terms."""
    h = 4e-3
    centre, trace = below(force, AT), lambda at: np.trace(below(force, at), axis1=1, axis2=2)
    laplace = sum(below(force, AT + h * e) + below(force, AT - h * e) - 2.0 * centre for e in np.eye(3)) / h**2
    hessian = np.zeros((len(AT), 3, 3))
    for a, one in enumerate(np.eye(3)):
        for b, other in enumerate(np.eye(3)):
            corners = ((s * t, trace(AT + h * (s * one + t * other))) for s in (1, -1) for t in (1, -1))
            hessian[:, a, b] = sum(sign * value for sign, value in corners) / (4.0 * h**2)
    assert np.abs(laplace + hessian / (1.0 + NU)).max() < 1e-3 * np.abs(laplace).max()


@pytest.mark.parametrize("force", FORCES)
def test_planes_below_carry_the_force(force: Floats) -> None:
    """∫ σ·e_z over the plane z = 1 is −F, to 1e-3: its traction on what lies above balances the force."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    φ = 2.0 * np.pi * np.arange(64) / 64
    θ = 0.25 * np.pi * (nodes + 1.0)  # r = tan θ, to infinity
    r, dr = np.tan(θ), 0.25 * np.pi * weights / np.cos(θ) ** 2
    at = np.stack([np.outer(r, np.cos(φ)), np.outer(r, np.sin(φ)), np.ones((200, 64))], axis=2).reshape(-1, 3)
    area = np.repeat(r * dr * 2.0 * np.pi / 64, 64)
    assert area @ below(force, at)[:, :, 2] == pytest.approx(-force, abs=1e-3)


def test_surface_is_free_beside_the_force() -> None:
    """σ·e_z vanishes at z → 0."""
    at = np.array([[0.5, 0.3, 1e-7], [-1.0, 0.2, 1e-7]])
    for force in FORCES:
        assert np.abs(below(force, at)[:, :, 2]).max() < 1e-6


def test_a_row_of_forces_is_a_line_force() -> None:
    """Half-ellipses across, even along y to infinity: plane strain (ν enters in σ_y alone), to 1e-4 of p0."""
    s, w = np.polynomial.legendre.leggauss(24)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    y, dy = np.tan(0.5 * np.pi * nodes), 0.5 * np.pi * weights / np.cos(0.5 * np.pi * nodes) ** 2
    places = np.stack(np.meshgrid(s, y, indexing="ij"), axis=2).reshape(-1, 2)
    pressing = np.outer(np.sqrt(1.0 - s**2) * w, dy).ravel()
    forces = np.column_stack([0.2 * pressing, 0.0 * pressing, pressing])
    x, z = np.array([-0.7, 0.0, 0.4, 1.2]), np.array([0.6, 0.786, 1.0, 0.8])
    found = PointForces(places, forces, NU).stress(np.column_stack([x, 0.0 * x, z]))
    plane = HertzTractions(1.0, 1.0, 0.2).stress(x, z)
    assert found[:, [0, 2, 0], [0, 2, 2]] == pytest.approx(plane, abs=1e-4)
    assert found[:, 1, 1] == pytest.approx(NU * (plane[:, 0] + plane[:, 1]), abs=1e-4)


def sphere_axis(z: Floats, friction: float) -> tuple[Floats, Floats, Floats]:
    """σ_x, σ_z and τ_xz on the axis below Hertz' circle of radius 1 and peak 1 that slides towards +x (Johnson 1985,
    Eq. 3.45; Hamilton, Proc. Inst. Mech. Eng. C 197 (1983) 53-59, at x = y = 0)."""
    arc = np.arctan(1.0 / z)
    σx = -(1.0 + NU) * (1.0 - z * arc) + 0.5 / (1.0 + z**2)
    return σx, -1.0 / (1.0 + z**2), -friction * (1.0 - 1.5 * z * arc + 0.5 * z**2 / (1.0 + z**2))


def hertz_circle(friction: float) -> PointForces:
    """By forces at quadrature points: Gauss along the radius, even around."""
    nodes, weights = np.polynomial.legendre.leggauss(48)
    ω, dω = 0.25 * np.pi * (nodes + 1.0), 0.25 * np.pi * weights  # r = sin ω: smooth where the pressure ends
    φ = 2.0 * np.pi * (np.arange(64) + 0.5) / 64
    r = np.sin(ω)
    force = np.repeat(np.cos(ω) ** 2 * r * dω * 2.0 * np.pi / 64, 64)
    places = np.stack([np.outer(r, np.cos(φ)).ravel(), np.outer(r, np.sin(φ)).ravel()], axis=1)
    return PointForces(places, np.column_stack([friction * force, 0.0 * force, force]), NU)


@pytest.mark.parametrize("friction", [0.0, 0.25])
def test_axis_below_a_sphere_that_slides(friction: float) -> None:
    """σ_x, σ_z and τ_xz from 0.3 to 2 contact radii deep, to 1e-6 of p0."""
    z = np.linspace(0.3, 2.0, 12)
    found = hertz_circle(friction).stress(np.column_stack([0.0 * z, 0.0 * z, z]))
    for (a, b), exact in zip(((0, 0), (2, 2), (0, 2)), sphere_axis(z, friction)):
        assert found[:, a, b] == pytest.approx(exact, abs=1e-6)
