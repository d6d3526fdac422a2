"""Equivalent stresses and strains of a stress history at a material point, for contact fatigue.

A history is one load cycle, (k, 3, 3) stress tensors [MPa], in an elastic body.
"""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from scipy.optimize import minimize

from evolvent.strength.fatigue.smallest_sphere import centre
from evolvent_meshes.arrays import Floats
from evolvent_meshes.input_checks import Words, number, refuse

AROUND, TILTS, DIRECTIONS = 90, 18, 12
"""Planes that are tried, 2° around the y axis and 5° towards it, and directions in each of them."""


ASYMMETRY = 1e-6
"""Largest difference of a tensor and its transpose, over the largest stress of the history."""


def von_mises(stress: Floats) -> Floats:
    """Von Mises stress (k,) of a history [MPa]. Raises InputError."""
    stress = _history(stress)
    deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
    return np.asarray(np.sqrt(1.5 * np.einsum("kij,kij->k", deviator, deviator)))


def largest_shear(stress: Floats) -> Floats:
    """Maximum shear stress (k,) of a history: half of the difference of the largest and the smallest principal stress
    [MPa]. Raises InputError."""
    return _largest_shear(_history(stress))


def _largest_shear(stress: Floats) -> Floats:
    principal = np.linalg.eigvalsh(stress)
    return np.asarray(0.5 * (principal[:, 2] - principal[:, 0]))


def orthogonal_shear_range(stress: Floats) -> float:
    """Largest less smallest shear stress parallel to the surface, τ_xz [MPa] (Lundberg and Palmgren 1947). Raises
    InputError."""
    return float(np.ptp(_history(stress)[:, 0, 2]))


def dang_van(stress: Floats, tension_factor: float, compression_factor: float) -> float:
    """max (τ_a(t) + a σ_h(t)) [MPa]: τ_a the largest shear of the deviator about the centre of the smallest sphere that
    holds its path, σ_h the hydrostatic stress (Dang Van, Cailletaud, Flavenot, Le Douaron and Lieurade, in: Biaxial and
    Multiaxial Fatigue, EGF 3, 1989, 459-478). a is one factor under tension and another under compression, where a
    straight line is not conservative in rolling contact (Desimone, Bernasconi and Beretta, Wear 260 (2006) 567-572).

    The locus breaks at σ_h = 0, where it is the fatigue limit τ_w in fully reversed torsion; with a = 3 τ_w/σ_w − 1.5
    under tension it passes fully reversed tension too, τ_a = σ_w/2 at σ_h = σ_w/3. Another one that does is constant at
    σ_w/2 below σ_h = σ_w/3: there it allows σ_w/2 where this one, with no factor under compression, has up to τ_w.

    Raises InputError."""
    stress = _history(stress)
    _positive("tension_factor", tension_factor)
    _positive("compression_factor", compression_factor)
    hydrostatic = np.trace(stress, axis1=1, axis2=2) / 3.0
    deviator = stress - hydrostatic[:, None, None] * np.eye(3)
    amplitude = _largest_shear(deviator - centre(deviator.reshape(-1, 9)).reshape(3, 3))
    factor = np.where(hydrostatic > 0.0, tension_factor, compression_factor)
    return float((amplitude + factor * hydrostatic).max())


def fatemi_socie(stress: Floats, shear_modulus: float, yield_stress: float, factor: float) -> float:
    """max over planes and directions in them of Δγ/2 (1 + k σ_n,max/σ_y): amplitude of the shear strain, and largest
    tension on the plane, none under compression (Fatemi and Socie, Fatigue Fract. Eng. Mater. Struct. 11 (1988)
    149-165).

    shear_modulus: G [MPa]. yield_stress: σ_y [MPa]. factor: k.

    Raises InputError."""
    stress = _history(stress)
    _positive("factor", factor)
    for name, value in (("shear_modulus", shear_modulus), ("yield_stress", yield_stress)):
        number(name, value, "a number above 0, in MPa", "give a number", lambda n: n > 0.0)

    def damage(normals: Floats) -> Floats:
        shear, normal = plane_amplitudes(stress, normals)
        return np.asarray(shear / shear_modulus * (1.0 + factor * normal / yield_stress))

    angles = plane_angles()
    tried = damage(normals_at(angles))
    best = minimize(lambda at: -float(damage(normals_at(at[None]))[0]), angles[int(np.argmax(tried))],
                    method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-15})
    return float(max(-best.fun, tried.max()))


def _positive(name: str, factor: float) -> None:
    """Raises InputError for a factor that is no number from 0 on."""
    number(name, factor, "a number from 0 on", "give a number", lambda a: a >= 0.0)


def _history(stress: Any) -> Floats:
    """The stress tensors as an array. Raises InputError unless they are finite and symmetric, one at least."""
    try:
        tensors = np.asarray(stress, dtype=np.float64)
    except (TypeError, ValueError):
        _refuse_history(stress)
    if tensors.ndim != 3 or tensors.shape[1:] != (3, 3) or not len(tensors):
        _refuse_history(Words(f"shape {tensors.shape}"))
    if not np.isfinite(tensors).all():
        _refuse_history(Words("NaN or infinite values in it"))
    if np.abs(tensors - tensors.transpose(0, 2, 1)).max() > ASYMMETRY * np.abs(tensors).max():
        _refuse_history(Words("a tensor that is not symmetric"))
    return tensors


def _refuse_history(found: object) -> NoReturn:
    refuse("stress", "finite, symmetric tensors (k, 3, 3) [MPa], k >= 1", found, "passing_stress gives such a history")


def plane_angles() -> Floats:
    """Angles (a, 2) of the planes that are tried: of the normal from x in the x-z plane, and its tilt towards y [rad].
    Stress that is even in y has the same on planes tilted the other way."""
    around = np.linspace(0.0, np.pi, AROUND, endpoint=False)
    tilts = np.linspace(0.0, 0.5 * np.pi, TILTS, endpoint=False)
    return np.stack(np.meshgrid(around, tilts), axis=2).reshape(-1, 2)


def normals_at(angles: Floats) -> Floats:
    """Unit normals (a, 3) at angles (a, 2)."""
    around, tilt = angles.T
    return np.column_stack([np.cos(around) * np.cos(tilt), np.sin(tilt), np.sin(around) * np.cos(tilt)])


def plane_amplitudes(stress: Floats, normals: Floats) -> tuple[Floats, Floats]:
    """Amplitude of the shear stress, in the direction in which it is largest, and largest tension (a,) [MPa], 0 under
    compression, on planes with normals (a, 3)."""
    traction = np.einsum("kij,aj->kai", stress, normals)
    normal = np.einsum("kai,ai->ka", traction, normals)
    first = np.cross(normals, np.where(np.abs(normals[:, 1:2]) < 0.9, [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]]))
    first /= np.linalg.norm(first, axis=1)[:, None]
    one, other = (np.einsum("kai,ai->ka", traction, axes) for axes in (first, np.cross(normals, first)))
    β = np.linspace(0.0, np.pi, DIRECTIONS, endpoint=False)
    ranges = np.array([np.ptp(c * one + s * other, axis=0) for c, s in zip(np.cos(β), np.sin(β))])
    return 0.5 * _refined(ranges), np.maximum(normal.max(axis=0), 0.0)


def _refined(ranges: Floats) -> Floats:
    """Largest (a,) of ranges (directions, a) over half a turn, between directions by the parabola through three."""
    top = np.argmax(ranges, axis=0)
    at = np.arange(ranges.shape[1])
    before, best, after = (ranges[(top + n) % len(ranges), at] for n in (-1, 0, 1))
    bend = before - 2.0 * best + after
    rise = np.where(bend < 0.0, (after - before) ** 2 / np.where(bend < 0.0, -8.0 * bend, 1.0), 0.0)
    return np.asarray(best + rise)
