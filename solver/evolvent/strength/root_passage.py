"""Root stress of a tooth from before it takes up load until after it has shed it, from the positions of one pitch.

All teeth are alike: tooth pair i at pinion rotation φ is one tooth at φ + 2πi/z_1 (`results.engagement`). The
displacements of its root's nodes, which are condensed with the flank, follow from the forces on all teeth; the stress
there from these displacements alone (`fem.surface_stress`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.fem.surface_stress import principal_stresses, surface_stress
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.meshing.root_meshes import root_nodes
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.sweep.position_result import PositionResult, nodal_forces
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent.strength.root_surface import RootSurface, compression_side, tension_side
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class RootPeak:
    """The largest tension, or compression, of a passage."""

    stress: float
    """Largest, or smallest, principal stress [MPa]."""
    angle: float
    """Pinion rotation of the tooth [rad]; 0 where its flanks touch at the pitch point of the mid-face section."""
    radius: float
    """Of the place [mm]."""
    height: float
    """Axial position of the place [mm]."""
    tangent_angle: float
    """Of the profile at the place to the tooth's centre line [rad]; 30° at the standard's critical section."""
    mean: float
    """Mean of the largest and the smallest stress over the passage, there and in the direction of this one [MPa]."""
    amplitude: float
    """Half of their difference [MPa]."""


@dataclass(frozen=True, eq=False)
class RootPassage:
    """Stress at the root of one side of a tooth, at k rotations in ascending order."""

    root: RootSurface
    """n nodes."""
    angles: Floats
    """(k,) pinion rotation of the tooth [rad]."""
    stress: Floats
    """(k, n, 3, 3) in the sector's frame [MPa]."""

    @cached_property
    def principal(self) -> Floats:
        """(k, n, 3) principal stresses, ascending [MPa]."""
        return principal_stresses(self.stress)

    @cached_property
    def highest(self) -> Floats:
        """(k, n) largest principal stress [MPa]; -inf where it may be that of a contact (`is_fillet`)."""
        return np.where(self.root.is_fillet, self.principal[..., 2], -np.inf)

    @cached_property
    def lowest(self) -> Floats:
        """(k, n) smallest principal stress [MPa]; inf where it may be that of a contact."""
        return np.where(self.root.is_fillet, self.principal[..., 0], np.inf)

    @property
    def largest(self) -> Floats:
        """Largest principal stress (k,) of the fillet's nodes [MPa]."""
        return np.asarray(self.highest.max(axis=1))

    @property
    def smallest(self) -> Floats:
        """Smallest principal stress (k,) of the fillet's nodes [MPa]."""
        return np.asarray(self.lowest.min(axis=1))

    @property
    def tension(self) -> RootPeak:
        """Where and when the largest principal stress is largest."""
        return self._peak(int(np.argmax(self.highest)), 2)

    @property
    def compression(self) -> RootPeak:
        """Where and when the smallest principal stress is smallest."""
        return self._peak(int(np.argmin(self.lowest)), 0)

    def tension_at(self, k: int) -> RootPeak:
        """Where the largest principal stress is largest at rotation number k."""
        return self._peak(k * len(self.root.radii) + int(np.argmax(self.highest[k])), 2)

    def joined(self, other: RootPassage) -> RootPassage:
        """With the rotations of another passage of the same root."""
        angles = np.concatenate([self.angles, other.angles])
        order = np.argsort(angles)
        return RootPassage(self.root, angles[order], np.concatenate([self.stress, other.stress])[order])

    def _peak(self, place: int, number: int) -> RootPeak:
        """place: of the (k, n) stresses. number: of the principal stress there."""
        k, j = divmod(place, len(self.root.radii))
        direction = np.linalg.eigh(self.stress[k, j])[1][:, number]
        course = self.stress[:, j] @ direction @ direction
        return RootPeak(
            float(course[k]), float(self.angles[k]), float(self.root.radii[j]), float(self.root.heights[j]),
            float(self.root.tangent_angles[j]), 0.5 * float(course.max() + course.min()), 0.5 * float(np.ptp(course)),
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class GearRoots:
    """Both sides of a tooth of one gear."""

    loaded_side: RootPassage
    """Below the loaded flank, pulled."""
    back_side: RootPassage
    """Pressed."""

    def joined(self, other: GearRoots) -> GearRoots:
        """With the rotations of other passages of the same tooth."""
        return GearRoots(self.loaded_side.joined(other.loaded_side), self.back_side.joined(other.back_side))


def root_passages(body: GearBody, results: Sequence[PositionResult]) -> GearRoots:
    """Of one gear under the results of a pitch at one friction coefficient.

    body: as it was condensed for them, from a mesh of `root_meshes`.
    """
    loads, pitch = nodal_forces(results, body.member), 2.0 * np.pi / results[0].stand.pair.pinion.z
    assert isinstance(body.chain, ChainedCompliance | TwoLevelRing)
    moved = body.chain.observed_displacements(loads.rows, loads.forces)
    stands = np.array([each.stand.angle for each in results])
    angles = np.concatenate([stands + body.member.sign * i * pitch for i in moved])
    order, u = np.argsort(angles), np.concatenate(list(moved.values()))
    every = root_nodes(body.mesh)

    def passage(root: RootSurface) -> RootPassage:
        own = u[order][:, np.searchsorted(every, root.surface.nodes)]
        return RootPassage(root, angles[order], surface_stress(root.surface, body.material, own))

    return GearRoots(passage(tension_side(body.mesh, body.gear)), passage(compression_side(body.mesh, body.gear)))
