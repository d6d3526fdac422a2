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
from evolvent.gears.sweep.position_result import NodalForces, PositionResult, nodal_forces
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent.strength.root_surface import RootSurface, compression_side, tension_side
from evolvent_meshes.arrays import Floats

Moved = dict[int, Floats]
"""Tooth -> displacements (n, k, d) of its observed nodes [mm]."""


@dataclass(frozen=True)
class RootPeak:
    """The largest tension, or compression, of a passage."""

    stress: float
    """Largest, or smallest, principal stress [MPa]."""
    angle: float
    """Pinion rotation of the tooth [rad]; 0 where its flanks touch at the pitch point of the mid-face section."""
    radius: float
    """Radius of the place [mm]."""
    height: float
    """Axial position of the place [mm]."""
    tangent_angle: float
    """Angle of the profile at the place to the tooth's centre line [rad]; 30° at the standard's critical section."""
    mean: float
    """Mean of the largest and the smallest stress over the passage, there and in the direction of this one [MPa]."""
    amplitude: float
    """Half of the difference of the largest and the smallest stress over the passage, as in `mean` [MPa]."""
    load_share: float
    """Share of this tooth in the normal force at that rotation."""
    whole_load: float
    """Largest, or smallest, principal stress at that rotation with the whole load on this tooth [MPa]."""


@dataclass(frozen=True, eq=False)
class RootPassage:
    """Stress at the root of one side of a tooth, at k rotations in ascending order."""

    root: RootSurface
    """Root surface with n nodes."""
    angles: Floats
    """Pinion rotations (k,) of the tooth [rad]."""
    stress: Floats
    """Stress tensors (k, n, 3, 3) in the sector's frame [MPa]."""
    load_share: Floats
    """Share (k,) of this tooth in the normal force."""
    whole_load: Floats
    """Largest principal stress (k,) on the loaded side, smallest on the back, with the whole load on this tooth [MPa]:
    under the forces on it alone, over its share. NaN where there are none."""

    @cached_property
    def principal(self) -> Floats:
        """Principal stresses (k, n, 3), ascending [MPa]."""
        return principal_stresses(self.stress)

    @cached_property
    def highest(self) -> Floats:
        """Largest principal stress (k, n) [MPa]; -inf where it may be that of a contact (`is_fillet`)."""
        return np.where(self.root.is_fillet, self.principal[..., 2], -np.inf)

    @cached_property
    def lowest(self) -> Floats:
        """Smallest principal stress (k, n) [MPa]; inf where it may be that of a contact."""
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
        """Peak of the largest principal stress over nodes and rotations."""
        return self._peak(int(np.argmax(self.highest)), 2)

    @property
    def compression(self) -> RootPeak:
        """Peak of the smallest principal stress over nodes and rotations."""
        return self._peak(int(np.argmin(self.lowest)), 0)

    def tension_at(self, k: int) -> RootPeak:
        """Peak of the largest principal stress over the nodes at rotation number k."""
        return self._peak(k * len(self.root.radii) + int(np.argmax(self.highest[k])), 2)

    def joined(self, other: RootPassage) -> RootPassage:
        """Passage with the rotations of another one of the same root."""
        angles = np.concatenate([self.angles, other.angles])
        order = np.argsort(angles)
        stress = np.concatenate([self.stress, other.stress])
        share = np.concatenate([self.load_share, other.load_share])
        whole = np.concatenate([self.whole_load, other.whole_load])
        return RootPassage(self.root, angles[order], stress[order], share[order], whole[order])

    def _peak(self, place: int, number: int) -> RootPeak:
        """Peak of a principal stress. place: of the (k, n) stresses. number: of the principal stress there."""
        k, j = divmod(place, len(self.root.radii))
        direction = np.linalg.eigh(self.stress[k, j])[1][:, number]
        course = self.stress[:, j] @ direction @ direction
        return RootPeak(
            float(course[k]), float(self.angles[k]), float(self.root.radii[j]), float(self.root.heights[j]),
            float(self.root.tangent_angles[j]), 0.5 * float(course.max() + course.min()), 0.5 * float(np.ptp(course)),
            float(self.load_share[k]), float(self.whole_load[k]),
        )


@dataclass(frozen=True, eq=False)
class GearRoots:
    """Root stress of both sides of a tooth of one gear."""

    loaded_side: RootPassage
    """Passage of the root below the loaded flank, which bending pulls."""
    back_side: RootPassage
    """Passage of the root below the back flank, which bending presses."""

    def joined(self, other: GearRoots) -> GearRoots:
        """Roots with the rotations of other passages of the same tooth."""
        return GearRoots(self.loaded_side.joined(other.loaded_side), self.back_side.joined(other.back_side))


def root_passages(body: GearBody, results: Sequence[PositionResult]) -> GearRoots:
    """Root stress of one gear under the results of a pitch at one friction coefficient.

    body: as it was condensed for them, from a mesh of `root_meshes`.
    """
    loads, pitch = nodal_forces(results, body.member), 2.0 * np.pi / results[0].stand.pair.pinion.z
    assert isinstance(body.chain, ChainedCompliance | TwoLevelRing)
    moved, alone = _displacements(body.chain, loads)
    pairs = [body.member.sign * i for i in moved]
    angles = np.concatenate([[each.stand.angle + i * pitch for each in results] for i in pairs])
    share = np.concatenate([[each.load_share(i) for each in results] for i in pairs])
    order = np.argsort(angles)
    u, own = (np.concatenate(list(each.values()))[order] for each in (moved, alone))
    every = root_nodes(body.mesh)

    def passage(root: RootSurface, number: int) -> RootPassage:
        places = np.searchsorted(every, root.surface.nodes)
        stress, own_stress = (surface_stress(root.surface, body.material, each[:, places]) for each in (u, own))
        extreme = np.max if number == 2 else np.min
        under_own = extreme(principal_stresses(own_stress)[:, root.is_fillet, number], axis=1)
        whole = np.divide(under_own, share[order], out=np.full(len(order), np.nan), where=share[order] > 0.0)
        return RootPassage(root, angles[order], stress, share[order], whole)

    return GearRoots(passage(tension_side(body.mesh, body.gear), 2), passage(compression_side(body.mesh, body.gear), 0))


def _displacements(chain: ChainedCompliance | TwoLevelRing, loads: NodalForces) -> tuple[Moved, Moved]:
    """Displacements of each tooth's observed nodes under the forces on all teeth, and under those on this tooth
    alone."""
    teeth = np.unique(loads.rows[:, 0]).tolist()
    own = [np.where((loads.rows[:, 0] == tooth)[:, None], loads.forces, 0.0) for tooth in teeth]
    parts = chain.observed_displacements(loads.rows, np.concatenate([loads.forces, *own]))  # one factorisation for all
    split = {tooth: np.split(u, len(teeth) + 1) for tooth, u in parts.items()}
    alone = {i: u[1 + teeth.index(i)] if i in teeth else np.zeros_like(u[0]) for i, u in split.items()}
    return {tooth: u[0] for tooth, u in split.items()}, alone
