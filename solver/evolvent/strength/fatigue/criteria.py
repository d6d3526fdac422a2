"""Equivalent stresses and strains of a stress history at a material point, for contact fatigue.

A history is one load cycle, (k, 3, 3) stress tensors [MPa], in an elastic body.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from evolvent.strength.fatigue.smallest_sphere import centre
from evolvent_meshes.arrays import Floats

PLANES = 360
"""Directions of planes in half a turn that are tried before the worst is refined."""


def von_mises(stress: Floats) -> Floats:
    """(k,) [MPa]."""
    deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
    return np.asarray(np.sqrt(1.5 * np.einsum("kij,kij->k", deviator, deviator)))


def largest_shear(stress: Floats) -> Floats:
    """(k,) half of the difference of the largest and the smallest principal stress [MPa]."""
    principal = np.linalg.eigvalsh(stress)
    return np.asarray(0.5 * (principal[:, 2] - principal[:, 0]))


def orthogonal_shear_range(stress: Floats) -> float:
    """Largest less smallest shear stress parallel to the surface, τ_xz [MPa] (Lundberg and Palmgren 1947)."""
    return float(np.ptp(stress[:, 0, 2]))


def dang_van(stress: Floats, pressure_factor: float) -> float:
    """max (τ_a(t) + a σ_h(t)) [MPa]: τ_a the largest shear of the deviator about the centre of the smallest sphere that
    holds its path, σ_h the hydrostatic stress, a the pressure factor (Dang Van, Cailletaud, Flavenot, Le Douaron and
    Lieurade, in: Biaxial and Multiaxial Fatigue, EGF 3, 1989, 459-478)."""
    hydrostatic = np.trace(stress, axis1=1, axis2=2) / 3.0
    deviator = stress - hydrostatic[:, None, None] * np.eye(3)
    amplitude = largest_shear(deviator - centre(deviator.reshape(-1, 9)).reshape(3, 3))
    return float((amplitude + pressure_factor * hydrostatic).max())


def fatemi_socie(stress: Floats, shear_modulus: float, yield_stress: float, factor: float) -> float:
    """max over planes of Δγ/2 (1 + k σ_n,max/σ_y): shear strain amplitude and largest normal stress on the plane
    (Fatemi and Socie, Fatigue Fract. Eng. Mater. Struct. 11 (1988) 149-165). Planes contain the axis y of a plane
    problem."""

    def damage(angles: Floats) -> Floats:
        shear, normal = plane_amplitudes(stress, angles)
        return np.asarray(shear / shear_modulus * (1.0 + factor * normal / yield_stress))

    angles = np.linspace(0.0, np.pi, PLANES, endpoint=False)
    tried = damage(angles)
    worst, step = float(angles[int(np.argmax(tried))]), np.pi / PLANES
    found = minimize_scalar(lambda a: -float(damage(np.array([a]))[0]), bounds=(worst - step, worst + step),
                            method="bounded", options={"xatol": 1e-10})  # fmt: skip
    return float(max(-found.fun, tried.max()))


def plane_amplitudes(stress: Floats, angles: Floats) -> tuple[Floats, Floats]:
    """Amplitude of the shear stress and largest tension (a,) [MPa], 0 under compression, on planes that contain the
    axis y, their normals at angles (a,) [rad] from x."""
    c, s = np.cos(angles), np.sin(angles)
    σx, σz, τ = (stress[:, i, j, None] for i, j in ((0, 0), (2, 2), (0, 2)))
    shear = (σz - σx) * (c * s) + τ * (c**2 - s**2)
    normal = σx * c**2 + σz * s**2 + 2.0 * τ * (c * s)
    return 0.5 * np.ptp(shear, axis=0), np.maximum(normal.max(axis=0), 0.0)
