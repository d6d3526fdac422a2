"""A tooth flank as a grid of nodes over (arc, height), on which worn depth is accumulated and interpolated.

The arc u = ρ²/(2 r_b) is the involute's length from the base circle, ρ = √(r² − r_b²) its transverse radius of
curvature. The nodes of a flank lie in layers of equal height with the same arcs, for all cell types, and the hat
functions are linear in u and in z between them, as those of the surface are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.ndimage import binary_dilation

from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.wear.archard import grid_interval
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

LAYER_TOLERANCE = 1e-6  # of a module: heights closer than this are one layer
EDGE_MARGIN = 0.1  # modules of arc from a bearing tip edge, own or mate's, in which the pressure depends on the mesh
ARC_TOLERANCE = 1e-2  # of a module: largest difference of the layers' arcs, from flank modifications


def line_arc(pair: GearPair, gear: Member, ξ: Floats) -> Floats:
    """Arcs u [mm] of the contact line on a gear's flank at roll distances ξ [mm]."""
    ρ = pair.pitch_point_roll_lengths[gear] + gear.sign * ξ
    return np.asarray(ρ**2 / (2.0 * pair.gears[gear].base_radius))


def inner_arcs(pair: GearPair, gear: Member) -> tuple[float, float]:
    """Lowest and highest arc [mm] between the edge margins: those of the path of contact, less EDGE_MARGIN each."""
    low, high = sorted(line_arc(pair, gear, np.array(pair.path_of_contact)))
    margin = EDGE_MARGIN * pair.pinion.normal_module
    return float(low) + margin, float(high) - margin


@dataclass(frozen=True)
class FlankGrid:
    """The nodes of a flank.

    arcs: (m,) ascending [mm].
    heights: (l,) of the layers, ascending [mm].
    node: (l, m) index of the flank's node.
    areas: (n,) integrals of the nodes' hat functions [mm²; mm in 2D].
    """

    arcs: Floats
    heights: Floats
    node: Ints
    areas: Floats

    @staticmethod
    def of(body: GearBody) -> FlankGrid:
        """The grid of a gear's flank. Raises InputError where its nodes do not form one."""
        u, module = body.roll_length**2 / (2.0 * body.gear.base_radius), body.gear.normal_module
        layer = np.round(body.z / (LAYER_TOLERANCE * module)).astype(np.int64)
        heights, which = np.unique(layer, return_inverse=True)
        order = np.lexsort([u, which.reshape(-1)])
        if len(order) % len(heights) or len(set(np.bincount(which.reshape(-1)))) > 1:
            raise InputError(f"flank of {body.gear.z} teeth: wanted layers with equally many nodes, found others")
        node = order.reshape(len(heights), -1)
        spread = float(np.ptp(u[node], axis=0).max())
        if spread > ARC_TOLERANCE * module:
            raise InputError(f"flank of {body.gear.z} teeth: wanted the same arcs in all layers, found {spread:.2g} mm")
        return FlankGrid(u[node].mean(axis=0), body.z[node].mean(axis=1), node, body.flank.weights())

    @staticmethod
    def regular(arcs: Floats, heights: Floats, base_helix: float) -> FlankGrid:
        """A grid over all arcs (m,) and heights (l,) [mm], as in a flank chart; one height: a plane section.

        base_helix: base helix angle [rad].
        """
        widths = _hat_lengths(heights) / np.cos(base_helix) if len(heights) > 1 else np.ones(1)
        node = np.arange(len(heights) * len(arcs)).reshape(len(heights), -1)
        return FlankGrid(arcs, heights, node, np.outer(widths, _hat_lengths(arcs)).ravel())

    def inner_nodes(self, pair: GearPair, gear: Member) -> Ints:
        """The nodes between the edge margins."""
        low, high = inner_arcs(pair, gear)
        return self.node[:, (self.arcs >= low) & (self.arcs <= high)].ravel()

    def chart(self, gear: GearParameters, depth: Floats) -> FlankChart:
        """The chart over diameter and height of depths (n,) [mm] at the nodes of a gear's flank."""
        base = gear.base_radius
        return FlankChart(2.0 * np.sqrt(base**2 + 2.0 * base * self.arcs), self.heights, depth[self.node].T)

    def slope_limited(self, depth: Floats, slope: float) -> Floats:
        """The largest depths (n,) [mm] not above these whose slope along arcs and heights is at most `slope`, and which
        are zero at the root's rim, where the fillet begins."""
        field = depth[self.node]
        field[:, 0] = np.minimum(field[:, 0], 0.0)
        field = _slope_limited(_slope_limited(field, self.arcs, slope).T, self.heights, slope).T
        limited = np.empty(len(depth))
        limited[self.node] = field
        return limited

    def extended(self, nodes: Ints, values: Floats) -> Floats:
        """A field (n, d) from values (k, d) at some nodes (k,): within a layer linear between them and constant beyond,
        in other layers as in the nearest one with values."""
        known, field = np.zeros(self.node.size, dtype=bool), np.zeros((self.node.size, values.shape[1]))
        known[nodes], field[nodes] = True, values
        filled = np.flatnonzero(self.layers_with(nodes))
        for layer in self.node[filled]:
            given, at = layer[known[layer]], self.arcs[known[layer]]
            field[layer] = np.column_stack([np.interp(self.arcs, at, column) for column in field[given].T])
        nearest = np.abs(self.heights[:, None] - self.heights[filled]).argmin(axis=1)
        field[self.node] = field[self.node[filled[nearest]]]
        return field

    def neighbours(self, nodes: Ints, spacings: int) -> Bools:
        """(n,) which nodes are within so many spacings of arc of these, in the same or the next layers."""
        marked, near = np.zeros(self.node.size, dtype=bool), np.zeros(self.node.size, dtype=bool)
        marked[nodes] = True
        near[self.node] = binary_dilation(marked[self.node], np.ones((3, 2 * spacings + 1)))
        return near

    def layers_with(self, nodes: Ints) -> Bools:
        """(l,) which layers contain some of these nodes."""
        known = np.zeros(self.node.size, dtype=bool)
        known[nodes] = True
        return np.asarray(known[self.node].any(axis=1))

    def hats(self, u: Floats, z: Floats) -> sp.csr_matrix:
        """Hat functions (q, n) at arcs u and heights z (q,) [mm]; beyond the flank those of its rim."""
        (i, s), (j, t) = grid_interval(self.arcs, u), grid_interval(self.heights, z)
        m, corners, values = len(self.arcs), [], []
        for row, along in ((j, 1.0 - t), (np.minimum(j + 1, len(self.heights) - 1), t)):
            for column, across in ((i, 1.0 - s), (np.minimum(i + 1, m - 1), s)):
                corners.append(self.node[row, column])
                values.append(along * across)
        columns, weights = np.stack(corners, axis=1), np.stack(values, axis=1)
        matrix = sp.csr_matrix((weights.ravel(), columns.ravel(), 4 * np.arange(len(u) + 1)), (len(u), self.node.size))
        matrix.sum_duplicates()
        return matrix

    def depths_from_volumes(self, u: Floats, z: Floats, volumes: Floats) -> sp.csc_matrix:
        """Nodal depths (n, q) that remove volumes (q, e) [mm³; mm² in 2D] at arcs (q, e) and heights (q,) [mm], a
        column a point."""
        (i, s), (j, t) = grid_interval(self.arcs, u), grid_interval(self.heights, z)
        first = i.min(axis=1, initial=len(self.arcs) - 1)
        width = int((i - first[:, None]).max(initial=0)) + 2  # number of arcs that enclose a point's volumes
        place = (i - first[:, None]) + width * np.arange(len(u))[:, None]
        size = width * len(u)
        along = np.bincount(place.ravel(), ((1.0 - s) * volumes).ravel(), size)
        along += np.bincount(place.ravel() + 1, (s * volumes).ravel(), size)
        columns = np.minimum(first[:, None] + np.arange(width), len(self.arcs) - 1)
        layers = ((j, 1.0 - t), (np.minimum(j + 1, len(self.heights) - 1), t))[: min(len(self.heights), 2)]
        nodes = np.stack([self.node[layer[:, None], columns] for layer, _ in layers], axis=1)
        values = np.stack([share[:, None] * along.reshape(-1, width) for _, share in layers], axis=1)
        ends = len(layers) * width * np.arange(len(u) + 1)
        shape = (self.node.size, len(u))
        return sp.csc_matrix(((values / self.areas[nodes]).ravel(), nodes.ravel(), ends), shape)


def _slope_limited(rows: Floats, x: Floats, slope: float) -> Floats:
    """Limits the slope of values (k, n) over x (n,), row by row."""
    cone = slope * np.abs(x[:, None] - x)
    return np.array([(row + cone).min(axis=1) for row in rows])


def _hat_lengths(x: Floats) -> Floats:
    """∫ψ dx (n,) of the hat functions of an ascending grid (n,)."""
    steps = np.diff(x)
    return 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
