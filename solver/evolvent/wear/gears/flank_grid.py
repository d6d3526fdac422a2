"""A tooth's flank as a grid of nodes over (arc, height): where wear is gathered and looked up.

The arc u = ρ²/(2 r_b) is the involute's length from the base circle, ρ the transverse curvature radius √(r² − r_b²). A
flank's nodes lie in layers of equal height with the same arcs, whatever cells the mesh is made of, and between them the
hats are linear in u and in z, as those of the surface are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.ndimage import binary_dilation

from evolvent.gears.condensed_gear import GearBody
from evolvent.wear.archard import between
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.mesh.structured_grid import Mask

SAME = 1e-6  # of a module: heights that are one layer
EDGE = 0.1  # modules of arc: next to a tip edge that bears, its own or its mate's, the pressure is a matter of the mesh
UNEVEN = 1e-2  # of a module: how far the arcs of layers may differ, by modifications


def line_arc(pair: GearPair, gear: Member, ξ: Floats) -> Floats:
    """Arc u [mm] of the contact line on a gear's flank at roll distances ξ."""
    ρ = pair.pitch_point_roll_lengths[gear] + gear.sign * ξ
    return np.asarray(ρ**2 / (2.0 * pair.gears[gear].base_radius))


def inner_arcs(pair: GearPair, gear: Member) -> tuple[float, float]:
    """Arcs between which no tip edge bears: those of the path of contact, less EDGE at either end."""
    low, high = sorted(line_arc(pair, gear, np.array(pair.path_of_contact)))
    margin = EDGE * pair.pinion.normal_module
    return float(low) + margin, float(high) - margin


@dataclass(frozen=True)
class FlankGrid:
    """arcs (m,) and heights (l,), ascending [mm]. node: (l, m) flank node. areas: (n,) of the nodes' hats [mm²; mm]."""

    arcs: Floats
    heights: Floats
    node: Ints
    areas: Floats

    @staticmethod
    def of(body: GearBody) -> FlankGrid:
        """Of a gear's flank. Raises InputError where its nodes are no grid."""
        u, module = body.roll_length**2 / (2.0 * body.gear.base_radius), body.gear.normal_module
        layer = np.round(body.z / (SAME * module)).astype(np.int64)
        heights, which = np.unique(layer, return_inverse=True)
        order = np.lexsort([u, which.reshape(-1)])
        if len(order) % len(heights) or len(set(np.bincount(which.reshape(-1)))) > 1:
            raise InputError(f"flank of {body.gear.z} teeth: wanted layers with equally many nodes, found others")
        node = order.reshape(len(heights), -1)
        spread = float(np.ptp(u[node], axis=0).max())
        if spread > UNEVEN * module:
            raise InputError(f"flank of {body.gear.z} teeth: wanted the same arcs in all layers, found {spread:.2g} mm")
        return FlankGrid(u[node].mean(axis=0), body.z[node].mean(axis=1), node, body.flank.weights())

    @staticmethod
    def regular(arcs: Floats, heights: Floats, base_helix: float) -> FlankGrid:
        """Nodes at all arcs (m,) and heights (l,) [mm] of a flank with base helix angle [rad], as a chart has them; one
        height: a section, its areas per mm."""
        widths = _hat_lengths(heights) / np.cos(base_helix) if len(heights) > 1 else np.ones(1)
        node = np.arange(len(heights) * len(arcs)).reshape(len(heights), -1)
        return FlankGrid(arcs, heights, node, np.outer(widths, _hat_lengths(arcs)).ravel())

    def inner(self, pair: GearPair, gear: Member) -> Ints:
        """The nodes between the tip-edge zones."""
        low, high = inner_arcs(pair, gear)
        return self.node[:, (self.arcs >= low) & (self.arcs <= high)].ravel()

    def gentle(self, depth: Floats, slope: float) -> Floats:
        """The largest depths (n,) below these that are nothing at the root's rim, where the fillet goes on, and rise
        and fall by no more than `slope` along arcs and heights."""
        field = depth[self.node]
        field[:, 0] = np.minimum(field[:, 0], 0.0)
        field = _gentle(_gentle(field, self.arcs, slope).T, self.heights, slope).T
        found = np.empty(len(depth))
        found[self.node] = field
        return found

    def spread(self, nodes: Ints, values: Floats) -> Floats:
        """(n, d) of values (k, d) at some nodes (k,): in their layers linear between them and constant beyond, other
        layers as the nearest one that has some."""
        known, field = np.zeros(self.node.size, dtype=bool), np.zeros((self.node.size, values.shape[1]))
        known[nodes], field[nodes] = True, values
        filled = np.flatnonzero(self.seen(nodes))
        for layer in self.node[filled]:
            own, at = layer[known[layer]], self.arcs[known[layer]]
            field[layer] = np.column_stack([np.interp(self.arcs, at, column) for column in field[own].T])
        nearest = np.abs(self.heights[:, None] - self.heights[filled]).argmin(axis=1)
        field[self.node] = field[self.node[filled[nearest]]]
        return field

    def near(self, nodes: Ints, spacings: int) -> Mask:
        """(n,) bool: nodes so many spacings of arc from these, also in the next layers."""
        marked, found = np.zeros(self.node.size, dtype=bool), np.zeros(self.node.size, dtype=bool)
        marked[nodes] = True
        found[self.node] = binary_dilation(marked[self.node], np.ones((3, 2 * spacings + 1)))
        return found

    def seen(self, nodes: Ints) -> Mask:
        """(l,) bool: layers that have some of these nodes."""
        known = np.zeros(self.node.size, dtype=bool)
        known[nodes] = True
        return np.asarray(known[self.node].any(axis=1))

    def hats(self, u: Floats, z: Floats) -> sp.csr_matrix:
        """(q, n) hats of the nodes at q places; beyond the flank those of its rim."""
        (i, s), (j, t) = between(self.arcs, u), between(self.heights, z)
        m, corners, values = len(self.arcs), [], []
        for row, along in ((j, 1.0 - t), (np.minimum(j + 1, len(self.heights) - 1), t)):
            for column, across in ((i, 1.0 - s), (np.minimum(i + 1, m - 1), s)):
                corners.append(self.node[row, column])
                values.append(along * across)
        columns, weights = np.stack(corners, axis=1), np.stack(values, axis=1)
        matrix = sp.csr_matrix((weights.ravel(), columns.ravel(), 4 * np.arange(len(u) + 1)), (len(u), self.node.size))
        matrix.sum_duplicates()
        return matrix

    def gathered(self, u: Floats, z: Floats, volumes: Floats) -> sp.csc_matrix:
        """(n, q) mean depths that take away volumes (q, e) at arcs (q, e) and heights (q,)."""
        (i, s), (j, t) = between(self.arcs, u), between(self.heights, z)
        first = i.min(axis=1, initial=len(self.arcs) - 1)
        width = int((i - first[:, None]).max(initial=0)) + 2  # of the arcs that a point's volumes lie between
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


def _gentle(rows: Floats, x: Floats, slope: float) -> Floats:
    """Of values (k, n) at x (n,), row by row."""
    cone = slope * np.abs(x[:, None] - x)
    return np.array([(row + cone).min(axis=1) for row in rows])


def _hat_lengths(x: Floats) -> Floats:
    """∫ψ dx of the hats of an ascending grid (n,)."""
    steps = np.diff(x)
    return 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
