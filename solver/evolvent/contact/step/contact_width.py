"""How many cells a contact is wide: its pressure can be no better than the mesh that has to show it.

A separate patch of contact is as wide as twice the largest distance from a place that presses to the nearest place of
the surface that does not, or to its rim. So a strip counts across, a ring across its band; and half a contact at a
plane of symmetry, whose nodes a support holds, counts as the whole. Each cell that presses is measured in the direction
of the edge next to it, on both surfaces; the longest one counts, because pressure is steepest at the edge, where a mesh
that is fine in the middle may be coarse. The ends of a long patch are left out: along it cells may be long.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from evolvent.contact.problem.step_pairing import Meeting
from evolvent.contact.problem.user_warnings import warn_user
from evolvent.fem.reference_facets import reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints

ENOUGH = 2.0  # cells across; at one a Hertz contact's peak was found off by up to 120 %, at two by 20, in order 1 by 50
NOTICEABLE = 0.05  # share of a contact's force below which a patch is not counted
ENDS = 2.0  # times the least mean square extent of a patch: in directions in which it is longer its ends lie


class CoarseContactWarning(UserWarning):
    """A contact is less than two cells wide: its pressure may be off by half, and its area too."""


@dataclass(frozen=True)
class Width:
    """Of the patch of a contact that has the fewest cells across.

    width: of the patch [mm]; 0 where nothing presses.
    cell: the size [mm] of the longest cell that presses there, across the patch.
    """

    width: float
    cell: float

    @property
    def cells(self) -> float:
        """Cells across; 0 where nothing presses."""
        return self.width / self.cell if self.width > 0.0 else 0.0


def width_of(meeting: Meeting, pressure: Floats) -> Width:
    """From the pressure (q,) at a meeting's points."""
    pressed = np.flatnonzero(pressure > 0.0)
    if not len(pressed):
        return Width(0.0, 0.0)
    found, points = meeting.pairing, meeting.operator.points
    bounds = np.concatenate([points[pressure <= 0.0], _ends(meeting, np.unique(found.facet1[pressed]))])
    distance, nearest = cKDTree(bounds).query(points[pressed])
    towards = (bounds[nearest] - points[pressed]) / np.maximum(distance, 1e-300)[:, None]
    force = (meeting.operator.weights * pressure)[pressed]
    widths = []
    for own in _patches(meeting.placed[0], found.facet1[pressed]):
        if force[own].sum() >= NOTICEABLE * force.sum():
            across = own[_across(points[pressed[own]], towards[own])]
            cell = max(
                _largest(side, facets[pressed[across]], towards[across])
                for side, facets in zip(meeting.placed, (found.facet1, found.facet2))
            )
            widths.append(Width(2.0 * float(distance[own].max()), cell))
    return min(widths, key=lambda width: width.cells)


def _across(points: Floats, towards: Floats) -> Ints:
    """Of a patch's points (p, d) those at which the direction (p, d) of the nearest edge is across the patch."""
    extent = np.einsum("pi,ij,pj->p", towards, np.cov(points.T, bias=True), towards)
    return np.flatnonzero(extent <= ENDS * extent.min())


def _ends(meeting: Meeting, facets: Ints) -> Floats:
    """Points (b, d) at which a contact on these facets (f,) ends: nodes of others, and the rim that no support holds;
    the whole rim of a surface that presses all over and is held all around."""
    surface = meeting.placed[0]
    beyond = np.ones(len(surface.points), dtype=bool)
    beyond[surface.facets[facets]] = False
    rim = _rim(surface)
    held = meeting.supports[0].held.any(axis=1)
    free = rim[~held[rim].all(axis=1)]
    if not beyond.any() and not len(free):
        free = rim
    corners = surface.points[free]
    return np.concatenate([surface.points[beyond], *corners.swapaxes(0, 1), corners.mean(axis=1)])


def _rim(surface: Surface) -> Ints:
    """Corners (s, 1 or 2) of the sides on the border of a surface; of all sides where it is closed."""
    corners = {"interval": [[0], [1]], "triangle": [[0, 1], [1, 2], [2, 0]],
               "quadrilateral": [[0, 1], [1, 3], [3, 2], [2, 0]]}[surface.shape]  # fmt: skip
    sides = np.sort(surface.facets[:, corners].reshape(-1, len(corners[0])), axis=1)
    unique, count = np.unique(sides, axis=0, return_counts=True)
    return unique[count == 1] if (count == 1).any() else unique


def _patches(surface: Surface, facets: Ints) -> list[Ints]:
    """Rows of the facets (p,) that press, one array for each group of facets that touch at a node."""
    own, place = np.unique(facets, return_inverse=True)
    nodes = surface.facets[own]
    rows = np.repeat(np.arange(len(own)), nodes.shape[1])
    incidence = sp.csr_matrix((np.ones(nodes.size), (rows, nodes.ravel())), (len(own), len(surface.points)))
    count, label = connected_components(incidence @ incidence.T, directed=False)
    return [np.flatnonzero(label[place] == k) for k in range(count)]


def _largest(surface: Surface, facets: Ints, directions: Floats) -> float:
    """Largest size [mm] of the facets (p,), each in its direction (p, d) along it: 1/|∇ξ| of the reference ones."""
    own, place = np.unique(facets, return_inverse=True)
    centre = reference_cell(surface.shape, surface.order).centre
    middle = np.broadcast_to(centre, (len(own), 1, len(centre)))
    jacobian = np.stack([slope[:, 0] for slope in surface.evaluate(surface.points, own, middle)[1]], axis=2)
    passed = np.einsum("pid,pd->pi", np.linalg.pinv(jacobian)[place], directions)
    along = np.einsum("pdi,pi->pd", jacobian[place], passed)
    return float((np.linalg.norm(along, axis=1) / np.linalg.norm(passed, axis=1)).max())


def warn_if_coarse(name: str, width: Width) -> None:
    """CoarseContactWarning for a contact of less than two cells, not for none; name: which."""
    if 0.0 < width.cells < ENOUGH:
        cells = math.floor(100.0 * width.cells) / 100.0  # 1.999 is less than 2
        warn_user(
            f"{name}: wanted a contact at least {ENOUGH:g} cells wide, found {cells:g}, {width.width:.3g} mm "
            f"with cells of {width.cell:.3g} mm; its pressure may be off by half. Mesh it with cells of at most "
            f"{width.width / ENOUGH:.2g} mm on both surfaces, better {width.width / 8:.2g} mm",
            CoarseContactWarning,
        )
