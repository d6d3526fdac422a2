"""Check of the pairs of a contact on the displaced surfaces of its solution.

Each surface is moved along with its contact as a rigid body, and both apart until they touch. Pairs are right if there
the points have the same partners, gaps and normals. The rigid motion of a surface at its contact includes all motions:
prescribed ones, free ones and those of a part of the body that bends. It leaves out strains, and rotations of the size
of strains: small strain neglects them, here as elsewhere, so that a contact pressed in place is solved on the
undeformed shape, like Hertz'.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from evolvent.contact.search.projection import locate
from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.step.paired_surfaces import (
    PairedSurfaces,
    SurfacePair,
    SurfacePositions,
    SurfaceSupports,
    displaced,
    distance_vectors,
    extent,
    pair_overlaps,
)
from evolvent.contact.step.step_system import StepSystem
from evolvent.fem.material import contact_modulus
from evolvent.fem.rigid_modes import rigid_modes
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Bools, Floats, Ints

GAP_CHANGE = 2e-3  # of the depth p0 a/E* of the contact: change of gaps that is accepted
TILT = 0.01  # rad between the normals before and after, rms weighted by force; smaller rotations are not followed
DRIFT = 0.01  # of the contact's width: accepted distance of partners along the surface
NEAR = 0.5  # of a facet: a point without a pair so near has not been searched


@dataclass(frozen=True)
class PairingCheck:
    """Comparison of a contact's pairs with those on the displaced surfaces of its solution.

    positions: the displaced surfaces, brought together; None where nothing presses.
    gap_change: largest change of a gap over the contact's depth, without a slope along the contact.
    tilt: root mean square angle between old and new normals [rad].
    drift: largest distance of partners along the surface, over the contact's width.
    unpaired_overlap: deepest overlap where there are no pairs [mm].
    needed_reach: the reach that would have found that overlap [mm]; 0 if a larger one would not.
    """

    positions: SurfacePositions | None
    gap_change: float
    tilt: float
    drift: float
    unpaired_overlap: float
    needed_reach: float

    @property
    def pairs_hold(self) -> bool:
        """Whether the pairs are accurate enough."""
        return self.gap_change <= GAP_CHANGE and self.tilt <= TILT and self.drift <= DRIFT


def check_pairing(system: StepSystem, index: int, result: ContactResult, positions: SurfacePositions) -> PairingCheck:
    """Checks contact `index` of a solution; positions: the deformed surfaces. Raises SearchError where a facet has
    folded."""
    paired = result.paired
    first, second = (system.problem.bodies[body].material for body, _ in system.sides[index])
    pressed = np.flatnonzero(result.pressure > 0.0)
    width = result.width.width if len(pressed) else 0.0
    depth = float(result.pressure.max(initial=0.0)) * 0.5 * width / contact_modulus(first, second)
    deformed = displaced(paired.placed, positions)
    overlap, reach = _unpaired_overlap(paired, deformed, system.reaches[index], GAP_CHANGE * depth)
    if not len(pressed):
        return PairingCheck(None, 0.0, 0.0, 0.0, overlap, reach)
    share = np.maximum((result.weights * result.pressure)[pressed], 0.0)  # a few weights may be slightly negative
    share /= share.sum()
    touching = _brought_together(paired, positions, pressed, share)
    change, angle, drift = _changes(paired, displaced(paired.placed, touching), pressed)
    tilt = float(np.sqrt(share @ angle**2))
    gap_change = _without_slope(change, result.points[pressed], share) / depth
    return PairingCheck(touching, gap_change, tilt, float(drift.max()) / width, overlap, reach)


def _without_slope(change: Floats, points: Floats, share: Floats) -> float:
    """Largest change of a gap (p,) at points (p, d) after their slope is removed: a curved contact that moves along the
    surface has a slope, which alters its place and nothing else."""
    if not np.isfinite(change).all():
        return float("inf")
    weight = np.sqrt(share)
    arms = points - share @ points
    slope = np.linalg.lstsq(weight[:, None] * arms, weight * (change - share @ change), rcond=None)[0]
    return float(np.abs(change - arms @ slope).max())


def _brought_together(paired: PairedSurfaces, positions: SurfacePositions, pressed: Ints,
                      share: Floats) -> SurfacePositions:
    """Both surfaces, moved along with their contact as rigid bodies, and apart until no pressed point overlaps; share:
    fraction of the force at each pressed point, (p,)."""
    pairing = paired.pairing
    moved = [
        _moved_rigidly(surface, supports, x, facets[pressed], xi[pressed], share)
        for surface, supports, x, facets, xi in zip(
            paired.placed, paired.supports, positions, (pairing.facet1, pairing.facet2), (pairing.xi1, pairing.xi2)
        )
    ]
    surfaces = displaced(paired.placed, (moved[0], moved[1]))
    normal = _normals(surfaces[0], pairing.facet1[pressed], pairing.xi1[pressed])
    gap = _gaps(paired, surfaces, pressed, normal)
    overlap = float(-gap[np.isfinite(gap)].min(initial=0.0))
    return moved[0], moved[1] + overlap * _within_symmetry_planes(paired, pressed, share @ normal)


def _within_symmetry_planes(paired: PairedSurfaces, pressed: Ints, direction: Floats) -> Floats:
    """A direction (d,) without its components out of the contact's planes of symmetry: the mean normal of half a
    contact points to one side of its plane."""
    free = direction
    for surface, supports, facets in zip(paired.placed, paired.supports, _facets(paired)):
        held = supports.held[surface.facets[facets[pressed]]].any(axis=(0, 1))
        free = free - supports.rotation @ np.where(held, supports.rotation.T @ free, 0.0)
    return free if np.linalg.norm(free) > 0.5 * np.linalg.norm(direction) else direction


def _facets(paired: PairedSurfaces) -> tuple[Ints, Ints]:
    return paired.pairing.facet1, paired.pairing.facet2


def _moved_rigidly(surface: Surface, supports: SurfaceSupports, positions: Floats, facets: Ints, xi: Floats,
                   share: Floats) -> Floats:
    """The nodes (n, d) of a surface after the rigid motion that fits the displacements at the points (p,) best, among
    those that the supports at these points allow."""
    points = surface.positions(facets, xi[:, None])[:, 0]
    u = surface.evaluate(positions - surface.points, facets, xi[:, None])[0][:, 0]
    centre, weight, d = share @ points, np.sqrt(share)[:, None], points.shape[1]
    R = supports.rotation
    allowed = _allowed_motions(supports.held[surface.facets[facets]])
    modes = (weight[..., None] * rigid_modes((points - centre) @ R)[:, :, allowed]).reshape(len(points) * d, -1)
    motion = np.zeros(d * (d + 1) // 2)
    motion[allowed] = np.linalg.lstsq(modes, (weight * (u @ R)).ravel(), rcond=None)[0]
    turn = np.pad(motion[d:], (3 - len(motion[d:]), 0))
    if np.linalg.norm(turn) <= TILT:
        turn = np.zeros(3)
    rotation = R @ Rotation.from_rotvec(turn).as_matrix()[:d, :d] @ R.T
    return np.asarray(centre + R @ motion[:d] + (surface.points - centre) @ rotation.T)


def _allowed_motions(held: Bools) -> Ints:
    """Rigid motions (r,) of a surface with held nodes (p, k, d): no translation along a direction that is held
    anywhere, and rotations about that direction only."""
    d = held.shape[-1]
    along = held.any(axis=(0, 1))
    if d == 2:
        return np.flatnonzero(np.append(~along, not along.any()))
    about = [not np.delete(along, axis).any() for axis in range(3)]
    return np.flatnonzero(np.concatenate([~along, about]))


def _changes(paired: PairedSurfaces, moved: SurfacePair, pressed: Ints) -> tuple[Floats, Floats, Floats]:
    """Changes at the pressed points on the moved surfaces, (p,) each: change of the gap [mm] if the partner is searched
    along the new normal, infinite where there is none; angle between old and new normal [rad]; distance of the partners
    along the surface [mm]."""
    pairing, op = paired.pairing, paired.operator
    before = _unit(op.shape[pressed] @ op.frames[:, 0])
    now = _normals(moved[0], pairing.facet1[pressed], pairing.xi1[pressed])
    apart = distance_vectors(moved, pairing)[pressed]
    change = _gaps(paired, moved, pressed, now) - np.einsum("qa,qa->q", before, apart)
    along = apart - np.einsum("qa,qa->q", now, apart)[:, None] * now
    return change, np.linalg.norm(now - before, axis=1), np.linalg.norm(along, axis=1)


def _gaps(paired: PairedSurfaces, moved: SurfacePair, pressed: Ints, normal: Floats) -> Floats:
    """Gaps (p,) [mm] of the pressed points along normals (p, d) on moved surfaces; infinite without a partner."""
    pairing = paired.pairing
    start = moved[0].positions(pairing.facet1[pressed], pairing.xi1[pressed][:, None])
    guess = pairing.xi2[pressed][:, None]
    _, gap, located = locate(moved[1], pairing.facet2[pressed], start, normal[:, None], guess)
    return np.where(located[:, 0], gap[:, 0], np.inf)


def _normals(surface: Surface, facets: Ints, xi: Floats) -> Floats:
    return _unit(surface.evaluate(surface.normals, facets, xi[:, None])[0][:, 0])


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _unpaired_overlap(
    paired: PairedSurfaces, deformed: SurfacePair, reach: float, tolerance: float
) -> tuple[float, float]:
    """Deepest overlap [mm] of the deformed surfaces where there are no pairs, and the reach [mm] that would have found
    it."""
    overlaps = pair_overlaps(deformed, reach)
    deep = overlaps.gap < -max(tolerance, 1e-9 * extent(paired.placed[0]))
    if not deep.any():
        return 0.0, 0.0
    facets, xi = overlaps.facet1[deep], overlaps.xi1[deep]
    normal = _normals(deformed[0], facets, xi)
    before = np.einsum("qa,qa->q", normal, distance_vectors(paired.searched, overlaps)[deep])
    points = paired.placed[0].positions(facets, xi[:, None])[:, 0]
    away = cKDTree(paired.operator.points).query(points)[0] / paired.placed[0].size
    unpaired = (before > reach) | (away > NEAR)
    if not unpaired.any():
        return 0.0, 0.0
    furthest = float(before[unpaired].max())
    deepest = float(-overlaps.gap[deep][unpaired].min())
    return deepest, max(2.0 * reach, 1.1 * furthest) if furthest > reach else 0.0
