"""Equivalent stresses and strains of a stress history at a material point, for contact fatigue.

A history is one load cycle, (k, 3, 3) stress tensors [MPa], in an elastic body.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from evolvent_meshes.arrays import Floats

ROUNDS = 10_000
SETTLED = 1e-12
"""Of the radius of the smallest sphere: change at which its centre is found."""
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
    amplitude = largest_shear(deviator - _centre(deviator.reshape(-1, 9)).reshape(3, 3))
    return float((amplitude + pressure_factor * hydrostatic).max())


def fatemi_socie(stress: Floats, shear_modulus: float, yield_stress: float, factor: float) -> float:
    """max over planes of Δγ/2 (1 + k σ_n,max/σ_y): shear strain amplitude and largest normal stress on the plane
    (Fatemi and Socie, Fatigue Fract. Eng. Mater. Struct. 11 (1988) 149-165). Planes contain the axis y of a plane
    problem."""

    def damage(angle: float) -> float:
        n, t = np.array([np.cos(angle), 0.0, np.sin(angle)]), np.array([-np.sin(angle), 0.0, np.cos(angle)])
        shear, normal = np.einsum("kij,i,j->k", stress, t, n), np.einsum("kij,i,j->k", stress, n, n)
        opened = max(float(normal.max()), 0.0)
        return float(np.ptp(shear)) / (2.0 * shear_modulus) * (1.0 + factor * opened / yield_stress)

    angles = np.linspace(0.0, np.pi, PLANES, endpoint=False)
    worst, step = float(angles[int(np.argmax([damage(angle) for angle in angles]))]), np.pi / PLANES
    found = minimize_scalar(lambda a: -damage(a), bounds=(worst - step, worst + step), method="bounded",
                            options={"xatol": 1e-10})  # fmt: skip
    return float(max(-found.fun, damage(worst)))


def _centre(points: Floats) -> Floats:
    """Centre (d,) of the smallest sphere that holds points (k, d): an active set of furthest points, between which the
    centre is the one of equal distances."""
    active = [int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))]
    centre = points[active[0]]
    for _ in range(ROUNDS):
        distance = np.linalg.norm(points - centre, axis=1)
        radius = max(distance[active].max(), 0.0)
        far = int(np.argmax(distance))
        if distance[far] <= radius * (1.0 + SETTLED) + 1e-300:
            return centre
        active.append(far)
        centre, active = _of_few(points, active)
    raise ArithmeticError("smallest sphere: wanted its centre, found none; look for values that are no numbers")


def _of_few(points: Floats, active: list[int]) -> tuple[Floats, list[int]]:
    """Centre of the smallest sphere that holds the active points, and those of them on it: points with a negative share
    in the centre are dropped in turn."""
    while True:
        base, others = points[active[-1]], points[active[:-1]] - points[active[-1]]
        gram = 2.0 * others @ others.T
        shares = np.linalg.lstsq(gram, np.einsum("ij,ij->i", others, others), rcond=None)[0]
        every = np.append(shares, 1.0 - shares.sum())
        if (every >= -1e-12).all():
            return base + shares @ others, active
        active = [index for index, share in zip(active, every) if share != every.min()]
