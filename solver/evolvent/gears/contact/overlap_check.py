"""Whether deflected flanks overlap where the window was not searched.

Deep deflection can bring a tip's edge into contact far from every contact line, and a solution without it is balanced
all the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.search.pairing import Pairing, pair_surfaces
from evolvent.fem.lagrange import tabulate
from evolvent.fem.surface import Surface
from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.contact_line import ContactLine
from evolvent.gears.contact.lattice_pairing import with_wheel_edges
from evolvent.gears.contact.moved_contact import farthest_moved
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.contact.pressure_normals import pressure_normals
from evolvent.gears.contact.search_window import facets_in_window, placed_flanks
from evolvent.gears.contact.tooth_contact import PENETRATION
from evolvent.gears.contact.unsearched_points import unsearched_pairs
from evolvent.gears.kinematics import PairRotation, spin
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member

NEARLY = 5e-3  # modules: flanks so far apart may overlap once the gears have turned on, see worn_position.STALE

WITHIN_WINDOW = 0.5
"""Distance by which modifications may move the contact, over the half-width of the window; the rest is its own width.
"""
FlankPoints = tuple[Surface, Ints, Floats]
"""Points of a flank: its surface, the facets (q,), the reference coordinates (q, d−1)."""


@dataclass(frozen=True)
class UnsearchedOverlap:
    """Points where the undeformed flanks of a tooth pair overlap, or nearly do, outside the window.

    tooth: tooth pair.
    pinion: the pinion's flank in place.
    wheel: the wheel's flank in place.
    pairs: the q pairs of points.
    stand: where the gears stand.
    """

    tooth: int
    pinion: Surface
    wheel: Surface
    pairs: Pairing
    stand: PairRotation

    @property
    def sides(self) -> tuple[FlankPoints, FlankPoints]:
        """The points on the pinion's flank and on the wheel's."""
        pairs = self.pairs
        return (self.pinion, pairs.facet1, pairs.xi1), (self.wheel, pairs.facet2, pairs.xi2)

    def along_pressure(self) -> tuple[Floats, Floats]:
        """Unit normals (q, d) along which a pressure would act, and their cosines (q,) with the pinion's, along which
        the gaps were measured. Along others flanks that slide on each other would seem to overlap."""
        first, second = (_unit_normals(*side) for side in self.sides)
        x = self.pinion.positions(self.pairs.facet1, self.pairs.xi1[:, None])[:, 0]
        ξ = self.stand.roll_distance(self.tooth, x[:, 2] if x.shape[1] == 3 else np.zeros(len(x)))
        normals = pressure_normals(first, second, self.stand.pair, ξ)
        return normals, np.einsum("qa,qa->q", normals, first)


def unsearched_overlaps(geometry: ContactGeometry, teeth: tuple[int, ...]) -> tuple[UnsearchedOverlap, ...]:
    """Overlaps outside the window of all tooth pairs, for flanks without wear.

    Only flanks that overlap undeformed are checked, or that a rotation of up to NEARLY can bring to overlap: loaded
    teeth deflect, so that flanks apart from the contact move away from each other. And only slices whose contact line
    is off the path of contact: on it conjugate flanks are closest in the window, unless modifications are so steep that
    they move the contact out of it. None where whole flanks were searched. Raises SearchError.
    """
    if np.isinf(geometry.half_width):
        return ()
    overlaps = []
    for tooth in teeth:
        flanks = placed_flanks(geometry.bodies, geometry.stand, tooth)
        pairs = _unsearched_pairs(geometry, tooth, flanks)
        if pairs is not None and len(pairs.gap):
            overlaps.append(UnsearchedOverlap(tooth, *flanks, pairs, geometry.stand))
    return tuple(overlaps)


def overlap_outside(
    contact: GearContact, places: tuple[UnsearchedOverlap, ...], force: Floats, rotation: tuple[float, float]
) -> float:
    """Depth [mm] of the deepest overlap of the deflected flanks at these places; 0 where they do not overlap. force:
    contact forces (n, k) of the solution; rotation: of pinion and wheel [rad] since the search."""
    if not places:
        return 0.0
    moved = [_deflections(contact.geometry, gear, places, force) for gear in Member]
    return max(_overlap(contact, place, each, rotation) for place, each in zip(places, zip(*moved)))


def _overlap(
    contact: GearContact, place: UnsearchedOverlap, moved: tuple[Floats, ...], rotation: tuple[float, float]
) -> float:
    """Depth [mm] of the deepest overlap at a place. moved: displacements (q, d) of its points on pinion and wheel."""
    u1, u2 = (
        u + _rotated(contact.geometry, gear, rotation[gear], side) for gear, u, side in zip(Member, moved, place.sides)
    )
    gap = place.pairs.gap + sum(body.lost(*side[1:]) for body, side in zip(contact.bodies, place.sides))
    normals, shorter = place.along_pressure()
    return float(np.max(np.einsum("qa,qa->q", normals, u1 - u2) - shorter * gap, initial=0.0))


def _unit_normals(surface: Surface, facets: Ints, xi: Floats) -> Floats:
    """Unit normals (q, d) at points of a flank."""
    n = surface.evaluate(surface.normals, facets, xi[:, None])[0][:, 0]
    return np.asarray(n / np.linalg.norm(n, axis=1, keepdims=True))


def _rotated(geometry: ContactGeometry, gear: Member, angle: float, points: FlankPoints) -> Floats:
    """Displacements (q, d) [mm] at points of a gear's flank as the gear turns by a small angle [rad]."""
    surface, facets, xi = points
    x = surface.evaluate(surface.points, facets, xi[:, None])[0][:, 0]
    return angle * spin(x, geometry.stand.centre(gear, geometry.d), geometry.stand.axis(gear))


def _unsearched_pairs(
    geometry: ContactGeometry, tooth: int, flanks: tuple[Surface, Surface]
) -> Pairing | None:
    """Points that the window leaves out with partners near them: in slices off the path of contact, and as far beside
    the window as steep modifications may move the contact. None where the window leaves nothing out."""
    pinion, wheel = geometry.bodies
    reach, depth = NEARLY * pinion.gear.normal_module, PENETRATION * pinion.gear.normal_module
    moved = farthest_moved(geometry.stand.pair)
    moved = moved if moved > WITHIN_WINDOW * geometry.half_width else 0.0
    if pinion.levels:
        known = (t.wheel_edges for t in geometry.teeth if t.tooth == tooth and t.displaced is None)
        line = ContactLine((pinion.cells, wheel.cells), geometry.stand, tooth, next(known, None))
        line = with_wheel_edges(line, flanks) if line.wheel_edges is None else line
        return unsearched_pairs(line, geometry.half_width, moved, flanks, reach, depth)
    facets = _unsearched_facets(geometry, tooth, moved)
    return pair_surfaces(*flanks, reach, depth, facets) if len(facets) else None


def _unsearched_facets(geometry: ContactGeometry, tooth: int, moved: float) -> Ints:
    """The pinion's facets that the window leaves out. moved: how far beside it [mm] they are looked at."""
    pinion, stand = geometry.bodies[Member.PINION], geometry.stand
    start, end = stand.pair.path_of_contact
    ξ = stand.roll_distance(tooth, pinion.z)
    off = ((ξ < start) | (ξ > end))[pinion.flank.facets].any(axis=1)
    if moved:
        off |= facets_in_window(pinion, stand, tooth, geometry.half_width + moved)
    return np.flatnonzero(off & ~facets_in_window(pinion, stand, tooth, geometry.half_width))


def _deflections(
    geometry: ContactGeometry, gear: Member, places: tuple[UnsearchedOverlap, ...], force: Floats
) -> list[Floats]:
    """Displacements (q, d) [mm] of the points of each place on a gear's flanks, in the common frame; force (n, k): the
    contact forces. All places share one product with the compliance."""
    body, sides = geometry.bodies[gear], [place.sides[gear] for place in places]
    found = [np.unique(surface.facets[facets], return_inverse=True) for surface, facets, _ in sides]
    rows = [body.rows(place.tooth, nodes) for place, (nodes, _) in zip(places, found)]
    u = body.chain.apply(geometry.rows(gear)[0], geometry.flank_forces(gear, force), np.concatenate(rows))
    parts = np.split(u @ geometry.stand.rotation(gear, geometry.d).T, np.cumsum([len(each) for each in rows])[:-1])
    result = []
    for (surface, _, xi), (_, index), part in zip(sides, found, parts):
        N = tabulate(surface.shape, surface.order, xi)[0]
        result.append(np.einsum("qk,qka->qa", N, part[index.reshape(N.shape)]))
    return result
