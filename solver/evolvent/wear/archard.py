"""Archard's law, dh = (K/H) p |ds|, on a contact state: the depth that each surface loses at its nodes.

    m_k h_k = (K/H) Σ_q w_q ψ_k(q) λ_q s_q ,   m_k = ∫ψ_k dΓ

ψ are the hat functions of the surface's nodes: never negative, sum one. So no depth is negative, and the volume
Σ m_k h_k equals (K/H) Σ w λ s, that is (K/H)∫∫p|v_s| dA dt, to rounding on any mesh.

Source: J. F. Archard, Contact and rubbing of flat surfaces, J. Appl. Phys. 24 (1953) 981.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError, ResultError
from evolvent_meshes.input_checks import number

VOLUME_TOLERANCE = 1e-6
"""Largest relative difference between the worn volumes at the nodes and at the contact points."""


class VolumeLost(ResultError):
    """The depths at the nodes do not add up to the volume that the contact has worn off."""


class StepsTooLong(InputError):
    """Error of a cycle in which a step slides further than the contact is wide."""


def certify_volume(name: str, nodal: float, integral: float) -> None:
    """Compares the two volumes [mm³; mm² in 2D] of what is named: Σ m h at its nodes and (K/H)∫∫p|v_s| dA dt.

    Raises VolumeLost where they differ by more than VOLUME_TOLERANCE.
    """
    if not abs(nodal - integral) <= VOLUME_TOLERANCE * abs(integral):
        raise VolumeLost(
            f"wear of {name}: wanted the volume K/H·∫∫p|v_s| = {integral:.9g}, found {nodal:.9g} at the nodes; put all "
            "facets that may touch into the worn surface"
        )


@dataclass(frozen=True)
class Archard:
    """Archard's wear coefficients of the two surfaces of a contact, over the hardness.

    first, second: K/H of the first and of the second surface [mm²/N]; zero: no wear.

    Raises InputError unless both are finite and not negative. Source: Archard 1953, see above.

    >>> Archard(first=1.4e-10).coefficients
    (1.4e-10, 0.0)
    """

    first: float = 0.0
    second: float = 0.0

    def __post_init__(self) -> None:
        for name, value in (("first", self.first), ("second", self.second)):
            what, wanted = f"wear of the {name} surface", "K/H of zero or more in mm²/N"
            number(what, value, wanted, "give it over the hardness, such as 1e-10", lambda k: k >= 0.0)

    @property
    def coefficients(self) -> tuple[float, float]:
        """K/H [mm²/N] of the first and of the second surface."""
        return self.first, self.second


@dataclass(frozen=True)
class DepthProjection:
    """Projection between q contact points and the n nodes of a worn surface.

    hats: (q, n) hat functions ψ at the points.
    areas: (n,) m_k = ∫ψ_k over the whole surface [mm²; mm in 2D].
    """

    hats: sp.csr_matrix
    areas: Floats

    @staticmethod
    def of(surface: Surface, facets: Ints, xi: Floats) -> DepthProjection:
        """Projection at points xi (q, d−1) of the facets (q,); a point slightly outside the surface counts to its rim.
        """
        return DepthProjection(surface.hat_matrix(facets, xi), surface.weights())

    def depth(self, volumes: Floats) -> Floats:
        """Nodal depths (n,) [mm] that remove the volumes (q,) [mm³; mm² in 2D] at the points."""
        return np.asarray(self.hats.T @ volumes) / self.areas

    def at_points(self, depth: Floats) -> Floats:
        """Depths (q,) [mm] at the points, from nodal depths (n,)."""
        return np.asarray(self.hats @ depth)

    def volume(self, depth: Floats) -> float:
        """Σ m_k h_k [mm³; mm² in 2D] of nodal depths (n,)."""
        return float(self.areas @ depth)


def grid_interval(grid: Floats, x: Floats) -> tuple[Ints, Floats]:
    """Interval number and local coordinate, 0 to 1, of x (q,) in an ascending grid (g,); clamped to the grid's ends."""
    if len(grid) == 1:
        return np.zeros(len(x), dtype=np.int64), np.zeros(len(x))
    i = np.clip(np.searchsorted(grid, x) - 1, 0, len(grid) - 2)
    return i, np.clip((x - grid[i]) / (grid[i + 1] - grid[i]), 0.0, 1.0)
