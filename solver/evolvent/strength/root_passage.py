"""Root stress of a tooth from before it takes up load until after it has shed it, from the positions of one pitch.

All teeth are alike: tooth pair i at pinion rotation φ is one tooth at φ + 2πi/z_1 (`results.engagement`). Its sector's
displacements follow from the forces on all teeth (`results.fields.deformation`), the stress at its root from those of
the root's nodes (`fem.surface_stress`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from evolvent.fem.surface_stress import surface_stress
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.fields.deformation import GearField
from evolvent.strength.root_surface import RootSurface, compression_side, tension_side
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member


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
        return np.asarray(np.linalg.eigvalsh(self.stress))

    @property
    def tension(self) -> RootPeak:
        """Where and when the largest principal stress is largest."""
        return self._peak(int(np.argmax(self.principal[..., 2])), 2)

    @property
    def compression(self) -> RootPeak:
        """Where and when the smallest principal stress is smallest."""
        return self._peak(int(np.argmin(self.principal[..., 0])), 0)

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


def root_passages(body: GearBody, results: Sequence[PositionResult]) -> GearRoots:
    """Of one gear under the results of a pitch at one friction coefficient.

    body: as it was condensed for them.

    Raises NotPositiveDefinite, OutOfMemory.
    """
    roots = tension_side(body.mesh, body.gear), compression_side(body.mesh, body.gear)
    pinion = body.member is Member.PINION
    rows = [each.pinion_rows if pinion else each.wheel_rows for each in results]
    forces = [each.pinion_forces if pinion else each.wheel_forces for each in results]
    field = GearField(body, rows, forces)
    numbers = sorted({number for k in range(len(results)) for number in field.teeth(k)})
    pitch = 2.0 * np.pi / results[0].stand.pair.pinion.z
    angles, stresses = [], [list[Floats](), list[Floats]()]
    for k, result in enumerate(results):
        for number in numbers:
            u = field.displacement(k, number)
            angles.append(result.stand.angle + body.member.sign * number * pitch)
            for root, found in zip(roots, stresses):
                found.append(surface_stress(root.surface, body.material, u[root.surface.nodes]))
    order = np.argsort(angles)
    loaded, back = (
        RootPassage(root, np.array(angles)[order], np.array(found)[order]) for root, found in zip(roots, stresses)
    )
    return GearRoots(loaded, back)
