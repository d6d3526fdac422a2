"""A small system of gear bodies: mass and stiffness of rotations and static shapes, and the mesh that acts on them.

    M z̈ + K z = g (F_0 − F) ,    x = g·z ,    t = b·z

x is the approach of the flanks, where the mesh force acts; t is that of the bores, the transmission error. K is that of
the bodies alone, so that rigid rotation is free.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as la

from evolvent_meshes.arrays import Floats

RIGID = 1e-10
"""Part of the largest ω² below which a mode counts as rigid."""
MESHING = 1e-2
"""Part of a motion's elastic energy in the mesh from which on the mesh excites it."""


@dataclass(frozen=True, eq=False)
class GearShapes:
    """A gear as a rotation about its axis and m static shapes with held bore."""

    mass: Floats
    """Mass matrix (m + 1, m + 1), the rotation first [t·mm², and so on by the units of the shapes; per mm of face in
    2D]."""
    stiffness: Floats
    """Stiffness matrix (m + 1, m + 1); zero for the rotation."""
    closing: Floats
    """Approach of the flanks (m + 1,) along the line of action by unit coordinates [mm]: the base radius first."""

    def with_inertia(self, moment: float) -> GearShapes:
        """Gear with another total moment of inertia [t·mm²]: the part beyond its body rotates rigidly with the bore."""
        mass = self.mass.copy()
        mass[0, 0] = moment
        return GearShapes(mass, self.stiffness, self.closing)

    def scaled(self, width: float) -> GearShapes:
        """Gear of face width `width` [mm] from one per mm of face, under a unit force on all of it."""
        size = np.append(1.0, np.full(len(self.mass) - 1, 1.0 / width))
        both = np.outer(size, size) * width
        return GearShapes(self.mass * both, self.stiffness * both, self.closing * size)


@dataclass(frozen=True, eq=False)
class SmallSystem:
    """Mass, stiffness and mesh of a system with n coordinates."""

    mass: Floats
    """Mass matrix M (n, n)."""
    stiffness: Floats
    """Stiffness matrix K (n, n) of the bodies."""
    closing: Floats
    """Approach g (n,) of the flanks by unit coordinates [mm]."""
    reading: Floats
    """Transmission error b (n,) by unit coordinates [mm]: the approach of rigid bodies that turn as their bores do."""

    @cached_property
    def modes(self) -> tuple[Floats, Floats]:
        """Squared natural frequencies ω² (n,) of the bodies without the mesh, 0 where rigid, ascending, and their
        shapes (n, n), φᵀMφ = 1."""
        squares, shapes = la.eigh(self.stiffness, self.mass)
        squares[squares < RIGID * max(float(squares[-1]), 1.0)] = 0.0
        return squares, shapes

    @property
    def rigid_mass(self) -> float:
        """Mass m [t] of rigid bodies at the mesh: 1/Σ (g·φ)² over the rigid motions."""
        squares, shapes = self.modes
        return float(1.0 / np.sum((self.closing @ shapes[:, squares == 0.0]) ** 2))

    def compliance(self, one: Floats, other: Floats) -> float:
        """Compliance Σ (one·φ)(other·φ)/ω² over all elastic modes [mm/N]: displacement along one row (n,) by a unit
        force along another."""
        squares, shapes = self.modes
        elastic = squares > 0.0
        return float(np.sum((one @ shapes[:, elastic]) * (other @ shapes[:, elastic]) / squares[elastic]))

    def natural(self, stiffness: float) -> tuple[float, float]:
        """Natural frequencies ω [rad/s] of small motions on a mesh with a stiffness [N/mm] where its force acts: of the
        motion that carries most of the transmission error under a change of the mesh force, and of the next faster one
        in which the mesh has a part; infinite where there is none. A light hub on a soft web, which the torque at its
        bore turns most, is not taken for the pair's own motion."""
        g = self.closing
        squares, shapes = la.eigh(self.stiffness + stiffness * np.outer(g, g), self.mass)
        least = RIGID * max(float(squares[-1]), 1.0)
        safe = np.maximum(squares, least)
        carried = (g @ shapes) * (self.reading @ shapes) / safe
        own = int(np.argmax(np.where(squares > least, carried, 0.0)))
        meshing = stiffness * (g @ shapes) ** 2 / safe > MESHING
        faster = squares[own + 1 :][meshing[own + 1 :]]
        return float(np.sqrt(squares[own])), float(np.sqrt(faster[0])) if len(faster) else np.inf


def pair_system(pinion: GearShapes, wheel: GearShapes) -> SmallSystem:
    """System of both gears, free to turn, and their mesh. Coordinates are the rotations, oriented so that the mesh
    closes, and the shapes."""
    gears, turns = (pinion, wheel), (0, len(pinion.mass))
    closing = np.concatenate([gear.closing for gear in gears])
    reading = np.zeros_like(closing)
    reading[list(turns)] = closing[list(turns)]
    mass, stiffness = (la.block_diag(*parts) for parts in ([g.mass for g in gears], [g.stiffness for g in gears]))
    return SmallSystem(mass, stiffness, closing, reading)
