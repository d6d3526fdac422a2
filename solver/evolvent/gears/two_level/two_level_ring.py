"""The compliance of a gear's finely divided flanks, from its coarse sectors and the corrections of finer levels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.sparse as sp

from evolvent.contact.two_level.correction import Correction
from evolvent.gears.ring.ring_compliance import Compliance, Map, MappedNodes
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class RefinedLevel:
    """A flank finer than the one before.

    transfer: (n, c) shape functions of the level before at the nodes.
    correction: what its cells change, in the frame of tooth 0.
    """

    transfer: sp.csr_matrix
    correction: Correction


class TwoLevelRing:
    """Compliance of the nodes of all flanks on the finest level.

    coarse: compliance of the ring of coarse sectors.
    levels: from the coarsest to the finest.
    pitch: angle between teeth [rad].
    """

    def __init__(self, coarse: Compliance, levels: Sequence[RefinedLevel], pitch: float) -> None:
        self.coarse, self.levels, self.pitch = coarse, tuple(levels), pitch
        self.d = self.levels[0].correction.d
        transfer = self.levels[0].transfer
        for level in self.levels[1:]:
            transfer = level.transfer @ transfer
        self.transfer = transfer.tocsr()

    def block(self, parts: Sequence[MappedNodes]) -> Floats:
        """See `Compliance.block`."""
        transfers = [self.transfer[part.nodes] for part in parts]
        used = [np.unique(R.indices) for R in transfers]
        coarse = [
            MappedNodes(part.tooth, nodes, partial(_through, part.map, R[:, nodes].tocsr(), self.d))
            for part, R, nodes in zip(parts, transfers, used)
        ]
        result = self.coarse.block(coarse)
        start = 0
        for part in parts:
            near = self._turned(part.tooth, self._near(len(self.levels) - 1, part.nodes))
            own = part.map(part.map(near).T)
            end = start + len(own)
            result[start:end, start:end] += own
            start = end
        return result

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        """See `Compliance.apply`."""
        columns = forces.reshape(-1, len(rows_in), self.d)
        result = np.zeros((len(columns), len(rows_out), self.d))
        loads = {int(tooth): self._spread(rows_in, columns, tooth) for tooth in np.unique(rows_in[:, 0])}
        wanted = {int(tooth): np.flatnonzero(rows_out[:, 0] == tooth) for tooth in np.unique(rows_out[:, 0])}
        far = self._far(loads, list(wanted))
        for tooth, places in wanted.items():
            u = _of_nodes(self.transfer, far[tooth])
            if tooth in loads:
                turn = self._turn(tooth)
                u = u + self._corrected(loads[tooth] @ turn) @ turn.T
            result[:, places] = u[:, rows_out[places, 1]]
        return result.reshape(*forces.shape[:-2], len(rows_out), self.d)

    def _spread(self, rows: Ints, forces: Floats, tooth: int) -> Floats:
        """Forces (c, n, d) on all nodes of a tooth."""
        mine = rows[:, 0] == tooth
        result = np.zeros((len(forces), self.transfer.shape[0], self.d))
        result[:, rows[mine, 1]] = forces[:, mine]
        return result

    def _far(self, loads: dict[int, Floats], teeth: list[int]) -> dict[int, Floats]:
        """Displacements (c, n_0, d) of the coarse nodes of teeth under forces (c, n, d) on the fine ones."""
        count = self.transfer.shape[1]
        rows = {tooth: np.column_stack([np.full(count, tooth), np.arange(count)]) for tooth in {*loads, *teeth}}
        coarse = np.concatenate([_of_nodes(self.transfer.T, f) for f in loads.values()], axis=1)
        u = self.coarse.apply(
            np.concatenate([rows[t] for t in loads]), coarse, np.concatenate([rows[t] for t in teeth])
        )
        return dict(zip(teeth, np.split(u, len(teeth), axis=1)))

    def _corrected(self, forces: Floats) -> Floats:
        """Displacements (c, n, d) by the corrections of all levels under forces (c, n, d) on the finest, tooth 0."""
        loads = [forces]
        for level in self.levels[:0:-1]:
            loads.append(_of_nodes(level.transfer.T, loads[-1]))
        u = self.levels[0].correction.times(loads[-1])
        for level, f in zip(self.levels[1:], loads[-2::-1]):
            u = _of_nodes(level.transfer, u) + level.correction.times(f)
        return u

    def _near(self, number: int, nodes: Ints) -> Floats:
        """(k·d, k·d) corrections of this level and those before between its nodes (k,), in the frame of tooth 0."""
        level = self.levels[number]
        result = level.correction.among(nodes)
        if number:
            R = level.transfer[nodes]
            used = np.unique(R.indices)
            wide = sp.kron(R[:, used], np.eye(self.d), format="csr")
            result += wide @ (wide @ self._near(number - 1, used)).T
        return result

    def _turned(self, tooth: int, matrix: Floats) -> Floats:
        """(k·d, k·d) from the frame of tooth 0, turned to that of the gear."""
        if tooth == 0:
            return matrix
        turn, k = self._turn(tooth), len(matrix) // self.d
        rows = np.matmul(turn, matrix.reshape(k, self.d, -1)).reshape(matrix.shape)
        return np.asarray(np.matmul(turn, rows.T.reshape(k, self.d, -1)).reshape(matrix.shape).T)

    def _turn(self, tooth: int) -> Floats:
        result, angle = np.eye(self.d), tooth * self.pitch
        result[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        return result


def _of_nodes(matrix: sp.spmatrix, vectors: Floats) -> Floats:
    """A matrix (m, n) applied to vectors (c, n, d) of the nodes, (c, m, d)."""
    c, n, d = vectors.shape
    flat = matrix @ np.moveaxis(vectors, 1, 0).reshape(n, c * d)
    return np.moveaxis(np.asarray(flat).reshape(-1, c, d), 0, 1)


def _through(map_: Map, R: sp.csr_matrix, d: int, displacements: Floats) -> Floats:
    """A map of fine displacements, of coarse ones (d·c, columns)."""
    columns = displacements.shape[1]
    fine = R @ displacements.reshape(R.shape[1], d * columns)
    return map_(np.asarray(fine).reshape(-1, columns))
