"""Archard's law, dh = (K/H) p |ds|, on a contact state: what each surface loses at its nodes.

    m_k h_k = (K/H) Σ_q w_q ψ_k(q) λ_q s_q ,   m_k = ∫ψ_k dΓ

with the hats ψ of the surface's nodes, which are nowhere negative and sum to one: no depth is negative, and the volume
Σ m_k h_k is (K/H) Σ w λ s, that is (K/H)∫∫p|v_s| dA dt, to rounding on any mesh.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError, ResultError

VOLUME = 1e-6  # relative difference of a volume by nodes and by contact points that is an error


class VolumeLost(ResultError):
    """The depth at the nodes is not the volume that the contact took away."""


class StepsTooLong(InputError):
    """The steps of a cycle slide further than the contact is wide."""


def certify_volume(name: str, found: float, wanted: float) -> None:
    """found: Σ m h at the nodes of what is named, wanted: (K/H)∫∫p|v_s| dA dt. Raises VolumeLost."""
    if not abs(found - wanted) <= VOLUME * abs(wanted):
        raise VolumeLost(
            f"wear of {name}: wanted the volume K/H·∫∫p|v_s| = {wanted:.9g}, found {found:.9g} at the nodes; put all "
            "facets that may touch into the worn surface"
        )


@dataclass(frozen=True)
class Archard:
    """K/H [mm²/N] of the first and of the second surface of a contact; zero: does not wear. Source: J. F. Archard,
    Contact and rubbing of flat surfaces, J. Appl. Phys. 24 (1953) 981. Raises InputError."""

    first: float = 0.0
    second: float = 0.0

    def __post_init__(self) -> None:
        for name, value in (("first", self.first), ("second", self.second)):
            if not (np.isfinite(value) and value >= 0.0):
                raise InputError(f"wear of the {name} surface: wanted K/H of zero or more in mm²/N, found {value}")

    @property
    def both(self) -> tuple[float, float]:
        """(first, second)."""
        return self.first, self.second


@dataclass(frozen=True)
class Places:
    """Where q contact points lie on a surface of n nodes.

    hats: (q, n) ψ at the points. areas: (n,) m_k of the whole surface [mm²; mm in 2D].
    """

    hats: sp.csr_matrix
    areas: Floats

    @staticmethod
    def of(surface: Surface, facets: Ints, xi: Floats) -> Places:
        """Of points xi (q, d−1) of the facets (q,); a point that lies a little outside counts to the rim."""
        return Places(surface.hat_matrix(facets, xi), surface.weights())

    def depth(self, volumes: Floats) -> Floats:
        """(n,) mean depth that takes away these volumes (q,) [mm³; mm² in 2D] at the points."""
        return np.asarray(self.hats.T @ volumes) / self.areas

    def at_points(self, depth: Floats) -> Floats:
        """(q,) of nodal depths (n,)."""
        return np.asarray(self.hats @ depth)

    def volume(self, depth: Floats) -> float:
        """Σ m_k h_k [mm³; mm² in 2D]."""
        return float(self.areas @ depth)


def between(grid: Floats, x: Floats) -> tuple[Ints, Floats]:
    """Interval and place in it (0 to 1) of x in an ascending grid; clamped to its ends."""
    if len(grid) == 1:
        return np.zeros(len(x), dtype=np.int64), np.zeros(len(x))
    i = np.clip(np.searchsorted(grid, x) - 1, 0, len(grid) - 2)
    return i, np.clip((x - grid[i]) / (grid[i + 1] - grid[i]), 0.0, 1.0)
