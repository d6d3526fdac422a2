"""Width of a contact in cells: a pressure cannot be more accurate than the mesh that resolves it.

The width of a patch of contact is twice the largest distance from a point that presses to the nearest point of the
surface that does not, or to the surface's rim. A strip is so measured across, a ring across its band; half a contact at
a plane of symmetry, whose nodes a support holds, counts as the whole. Each cell that presses is measured in the
direction of the nearest edge of contact, on both surfaces. The longest one counts: the pressure is steepest at the
edge, where a mesh that is fine in the middle may be coarse. The ends of a long patch are left out, since cells may be
long along it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from evolvent.contact.problem.user_warnings import warn_user
from evolvent.contact.step.paired_surfaces import PairedSurfaces
from evolvent.fem.reference_facets import reference_cell
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints

ENOUGH = 2.0  # cells across; at one the peak of a Hertz contact was off by up to 120 %, at two by 20, in order 1 by 50
NOTICEABLE = 0.05  # fraction of a contact's force below which a patch is not counted
ENDS = 2.0  # times the least mean square extent of a patch: directions in which it is longer lead to its ends


class CoarseContactWarning(UserWarning):
    """A contact is less than two cells wide: its pressure may be off by half, and its area too."""


@dataclass(frozen=True)
class ContactWidth:
    """Width of the patch of a contact that has the fewest cells across.

    width: width of the patch [mm]; 0 where nothing presses.
    cell: size of the longest cell that presses there, measured across the patch [mm].
    """

    width: float
    cell: float

    @property
    def cells(self) -> float:
        """Cells across; 0 where nothing presses."""
        return self.width / self.cell if self.width > 0.0 else 0.0


def measure_width(paired: PairedSurfaces, pressure: Floats) -> ContactWidth:
    """The width of a contact with the given pressure (q,) at its points."""
    pressed = np.flatnonzero(pressure > 0.0)
    if not len(pressed):
        return ContactWidth(0.0, 0.0)
    pairing, points = paired.pairing, paired.operator.points
    bounds = np.concatenate([points[pressure <= 0.0], _ends(paired, np.unique(pairing.facet1[pressed]))])
    distance, nearest = cKDTree(bounds).query(points[pressed])
    towards = (bounds[nearest] - points[pressed]) / np.maximum(distance, 1e-300)[:, None]
    force = (paired.operator.weights * pressure)[pressed]
    widths = []
    for patch in _patches(paired.placed[0], pairing.facet1[pressed]):
        if force[patch].sum() >= NOTICEABLE * force.sum():
            across = patch[_across(points[pressed[patch]], towards[patch])]
            cell = max(
                _largest(side, facets[pressed[across]], towards[across])
                for side, facets in zip(paired.placed, (pairing.facet1, pairing.facet2))
            )
            widths.append(ContactWidth(2.0 * float(distance[patch].max()), cell))
    return min(widths, key=lambda width: width.cells)


def _across(points: Floats, towards: Floats) -> Ints:
    """Points of a patch (p, d) at which the direction (p, d) of the nearest edge is across the patch."""
    extent = np.einsum("pi,ij,pj->p", towards, np.cov(points.T, bias=True), towards)
    return np.flatnonzero(extent <= ENDS * extent.min())


def _ends(paired: PairedSurfaces, facets: Ints) -> Floats:
    """Points (b, d) at which a contact on these facets (f,) ends: the nodes of other facets, and the rim where no
    support holds it; the whole rim of a surface that presses everywhere and is held all around."""
    surface = paired.placed[0]
    beyond = np.ones(len(surface.points), dtype=bool)
    beyond[surface.facets[facets]] = False
    rim = _rim(surface)
    held = paired.supports[0].held.any(axis=1)
    free = rim[~held[rim].all(axis=1)]
    if not beyond.any() and not len(free):
        free = rim
    corners = surface.points[free]
    return np.concatenate([surface.points[beyond], *corners.swapaxes(0, 1), corners.mean(axis=1)])


def _rim(surface: Surface) -> Ints:
    """Corner nodes (s, 1 or 2) of the facet sides on the rim of a surface; of all sides where it is closed."""
    corners = {"interval": [[0], [1]], "triangle": [[0, 1], [1, 2], [2, 0]],
               "quadrilateral": [[0, 1], [1, 3], [3, 2], [2, 0]]}[surface.shape]
    sides = np.sort(surface.facets[:, corners].reshape(-1, len(corners[0])), axis=1)
    unique, count = np.unique(sides, axis=0, return_counts=True)
    return unique[count == 1] if (count == 1).any() else unique


def _patches(surface: Surface, facets: Ints) -> list[Ints]:
    """Indices into the facets of the points that press, (p,): one array for each patch of facets that share nodes."""
    pressed, place = np.unique(facets, return_inverse=True)
    nodes = surface.facets[pressed]
    rows = np.repeat(np.arange(len(pressed)), nodes.shape[1])
    incidence = sp.csr_matrix((np.ones(nodes.size), (rows, nodes.ravel())), (len(pressed), len(surface.points)))
    count, label = connected_components(incidence @ incidence.T, directed=False)
    return [np.flatnonzero(label[place] == k) for k in range(count)]


def _largest(surface: Surface, facets: Ints, directions: Floats) -> float:
    """Largest size [mm] of facets (p,), each in its direction (p, d) along the facet: 1/|∇ξ| of the reference facet."""
    unique, place = np.unique(facets, return_inverse=True)
    centre = reference_cell(surface.shape, surface.order).centre
    middle = np.broadcast_to(centre, (len(unique), 1, len(centre)))
    jacobian = np.stack([slope[:, 0] for slope in surface.evaluate(surface.points, unique, middle)[1]], axis=2)
    passed = np.einsum("pid,pd->pi", np.linalg.pinv(jacobian)[place], directions)
    along = np.einsum("pdi,pi->pd", jacobian[place], passed)
    return float((np.linalg.norm(along, axis=1) / np.linalg.norm(passed, axis=1)).max())


def warn_if_coarse(name: str, width: ContactWidth) -> None:
    """Warns by a CoarseContactWarning of a closed contact less than two cells wide. name: name of the contact."""
    if 0.0 < width.cells < ENOUGH:
        cells = math.floor(100.0 * width.cells) / 100.0  # 1.999 is less than 2
        warn_user(
            f"{name}: wanted a contact at least {ENOUGH:g} cells wide, found {cells:g}, {width.width:.3g} mm "
            f"with cells of {width.cell:.3g} mm; its pressure may be off by half. Mesh it with cells of at most "
            f"{width.width / ENOUGH:.2g} mm on both surfaces, better {width.width / 8:.2g} mm",
            CoarseContactWarning,
        )
