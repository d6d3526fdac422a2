"""The loads per length of a line contact in equilibrium with a torque.

    Σ_j B_ij q_j + ℓ_i φ(q_i) + ℓ_i g_i − H_i δ = 0   where q_i > 0, not negative elsewhere
    Gᵀ q = F,      φ(q) = (2/(π E*)) q [¼ + ln(w/b)],   b = √(4 q ρ / (π E*))

G is H without friction; with it G holds the moment of friction too, and B the normal displacements by friction. φ is
what the half-ellipse of half-width w and the least gap g leave out of the approach of both bodies: the difference
(2/(π E*)) q ln(w/b) of the mean displacements under it and under Hertz' half-ellipse b, and the mean gap b²/(8 ρ) under
that one above the least, (2/(π E*)) q/4 (Johnson, Contact Mechanics, 1985, 4.2 and 5.6).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from evolvent.contact.hertz import line_half_width
from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.line.face_ends import FaceEnds
from evolvent_meshes.arrays import Bools, Floats

STEPS, CLOSE = 60, 1e-10
"""Most Newton steps, and the change of the loads at which they end, over the largest load."""
LEAST = 1e-6
"""Least load per length, over the mean one, at which the derivative of φ is taken."""
WIDEST = 0.75
"""Largest half-width b of the contact over w: from e^(−¼) = 0.78 on φ would fall with the load. Beyond, b is taken as
that of w; what is computed then is no line contact (`LineResult.of`)."""


@dataclass(frozen=True, eq=False)
class LineSystem:
    """A position of m stations, under any torque."""

    B: Floats
    """(m, m) compliance between stations."""
    length: Floats
    """(m,) integral ℓ of each hat [mm]."""
    gap: Floats
    """(m,) mean of the gap under each hat [mm]."""
    radius: Floats
    """(m,) relative radius of curvature ρ [mm]."""
    log_width: Floats
    """(m,) mean of ln w, with w in mm."""
    H: Floats
    """(m,) work of a unit approach along the line of action on a unit load per length [mm]."""
    modulus: float
    """Contact modulus E* [MPa]."""
    ends: FaceEnds | None = None
    """Ends of the gears' faces, near which stations are softer; None in the plane."""
    moment: Floats | None = None
    """(m,) moment G of a unit load per length about the axis of the gear whose torque is given, over its base radius
    [mm]; None without friction, where it is H."""


@dataclass(frozen=True, eq=False)
class LineEquilibrium:
    """Equilibrium of a line contact."""

    load: Floats
    """(m,) load per length q [N/mm]."""
    approach: float
    """δ along the line of action, in the transverse section [mm]."""
    stiffness: float
    """Tangent stiffness dF/dδ [N/mm]."""
    iterations: int
    """Number of Newton steps."""


def line_equilibrium(system: LineSystem, force: float) -> LineEquilibrium:
    """Equilibrium under a force F [N]: torque over base radius, without friction along the line of action in the
    transverse section. Raises NotConverged."""
    L, H, c = system.length, system.H, 2.0 / (math.pi * system.modulus)
    mean = force / float(H.sum())
    q = _on_springs(system, force)
    active = q > 0.0
    for step in range(1, STEPS + 1):
        bounded = np.maximum(q, LEAST * mean)
        local, logarithmic = (c * part for part in _local(system, bounded))
        matrix, a = _matrix(system, active, L * (local - logarithmic)), np.flatnonzero(active)
        right = np.append(-L[a] * (system.gap[a] + logarithmic[a] * bounded[a]), force)
        solution = np.linalg.solve(matrix, right)
        new, δ = np.zeros_like(q), float(solution[-1])
        new[a] = solution[:-1]
        residual = system.B @ np.maximum(new, 0.0) + L * system.gap - H * δ
        change, q = float(np.abs(new - q).max()), np.maximum(new, 0.0)
        now = np.where(active, new > 0.0, residual < 0.0)
        if not now.any():
            raise NotConverged("line contact: wanted stations that bear, found none left after a step")
        if (now == active).all() and change <= CLOSE * float(q.max()):
            unit = np.linalg.solve(matrix, np.append(np.zeros(len(a)), 1.0))
            return LineEquilibrium(q, δ, 1.0 / float(unit[-1]), step)
        active = now
    raise NotConverged(f"line contact: wanted loads in equilibrium after {STEPS} steps, found them still changing")


def _local(system: LineSystem, load: Floats) -> tuple[Floats, Floats]:
    """φ/q over c = 2/(π E*), and the part of it that falls as dφ/dq = φ/q − that, at loads per length (m,) above 0."""
    narrower = system.log_width - np.log(line_half_width(load, system.radius, system.modulus))  # ln(w/b)
    carried, least = narrower > -math.log(WIDEST), np.maximum(narrower, -math.log(WIDEST))
    if system.ends is None:
        return 0.25 + least, 0.5 * carried
    w = np.exp(system.log_width)
    extra, falling = system.ends.extra(w * np.exp(-least), w)
    return 0.25 + least + extra, (0.5 + falling) * carried


def _on_springs(system: LineSystem, force: float) -> Floats:
    """Loads (m,) of a foundation of independent springs, each as soft as a station under equal loads on all of them."""
    L, H, G, softness = system.length, system.H, _moment(system), system.B.sum(axis=1)

    def loads(δ: float) -> Floats:
        return np.maximum(H * δ - L * system.gap, 0.0) / softness

    touch = L * system.gap / H
    stiff = float(G @ (H / softness))
    low, high = float(touch.min()), float(touch.max()) + 2.0 * force / stiff
    return loads(float(brentq(lambda δ: float(G @ loads(δ)) - force, low, high)))


def _matrix(system: LineSystem, active: Bools, diagonal: Floats) -> Floats:
    a = np.flatnonzero(active)
    T = np.zeros((len(a) + 1, len(a) + 1))
    T[:-1, :-1] = system.B[np.ix_(a, a)] + np.diag(diagonal[a])
    T[:-1, -1], T[-1, :-1] = -system.H[a], _moment(system)[a]
    return T


def _moment(system: LineSystem) -> Floats:
    """Moments G (m,)."""
    return system.H if system.moment is None else system.moment
