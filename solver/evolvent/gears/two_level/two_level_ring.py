"""The compliance of a gear's finely divided flanks, from its coarse sectors and the corrections of finer levels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.fem.surface import Surface
from evolvent.gears.ring.ring_compliance import ChainedCompliance, MappedNodes
from evolvent.gears.two_level.flank_window import FlankWindow, LevelWindow, ToothWindow, map_of
from evolvent.gears.two_level.refined_level import RefinedLevel
from evolvent.gears.two_level.rough_flanks import RoughFlanks
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.rotation import turn


@dataclass(frozen=True, eq=False)
class TwoLevelRing:
    """Compliance of the nodes of all flanks on the finest level."""

    coarse: ChainedCompliance
    """Compliance of the ring of coarse sectors."""
    flank: Surface
    """Flank of the coarse sector."""
    levels: tuple[RefinedLevel, ...]
    """Levels from the coarsest to the finest."""
    pitch: float
    """Angle between teeth [rad]."""

    def jumps(self, parts: Sequence[MappedNodes]) -> FlankWindow:
        """Compliance E C Eᵀ of the parts' maps E between nodes of the finest level, applied to forces without a
        matrix."""
        nodes = [[part.nodes for part in parts]]
        levels = []
        for level in reversed(self.levels):
            rows = [level.transfer[own] for own in nodes[-1]]
            nodes.append([np.unique(R.indices) for R in rows])
            transfer = sp.block_diag([R[:, used] for R, used in zip(rows, nodes[-1])], format="csr")
            levels.append(LevelWindow(transfer, level.correction.among(nodes[-2])))
        teeth = [ToothWindow(map_of(p), self._turn(p.tooth), tuple(own)) for p, *own in zip(parts, *nodes[::-1])]
        ring = self.coarse.window([(part.tooth, used) for part, used in zip(parts, nodes[-1])])
        return FlankWindow(tuple(teeth), tuple(levels[::-1]), ring, self._rough.nearly)

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        """Displacements (..., k_out, 3) [mm] of `rows_out` (k_out, 2) under `forces` (..., k_in, 3) [N] on `rows_in`. A
        row is a tooth and a node of the finest flank."""
        rows = np.unique(np.concatenate([rows_in, rows_out]), axis=0)  # tooth by tooth
        key = rows @ [self.size, 1]
        of, to = (np.searchsorted(key, each @ [self.size, 1]) for each in (rows_in, rows_out))
        teeth = np.unique(rows[:, 0])
        window = self.jumps([MappedNodes(int(t), rows[rows[:, 0] == t, 1]) for t in teeth])
        turns = np.array([tooth.turn for tooth in window.teeth])[np.searchsorted(teeth, rows[:, 0])]
        columns = forces.reshape(-1, len(rows_in), 3)
        result = np.empty((len(columns), len(rows_out), 3))
        for f, u in zip(columns, result):
            whole = np.zeros((len(rows), 3))
            whole[of] = f
            moved = window.moved(np.einsum("nab,na->nb", turns, whole))
            u[:] = np.einsum("nab,nb->na", turns, moved)[to]
        return result.reshape(*forces.shape[:-2], len(rows_out), 3)

    def observed_displacements(self, rows_in: Ints, forces: Floats) -> dict[int, Floats]:
        """Displacements (n, k, 3; sector's own frame; mm) of the k observed nodes of each tooth under `forces` (n,
        k_in, 3; N), which act on the sector through its coarse flank. Raises ValueError where none were condensed."""
        return self.coarse.observed_displacements(*self.on_coarse_nodes(rows_in, forces))

    def on_coarse_nodes(self, rows: Ints, forces: Floats) -> tuple[Ints, Floats]:
        """Rows (c, 2) of the coarse flank's nodes and the forces (n, c, 3) there that do the same work as `forces`
        (n, k, 3) on rows (k, 2) of the finest flank."""
        parts = []
        for tooth in np.unique(rows[:, 0]):
            here = rows[:, 0] == tooth
            load = np.zeros((self.size, 3 * len(forces)))
            load[rows[here, 1]] = np.moveaxis(forces[:, here], 0, 1).reshape(-1, load.shape[1])
            for level in reversed(self.levels):
                load = level.transfer.T @ load
            nodes = np.flatnonzero(load.any(axis=1))
            parts.append((np.column_stack([np.full(len(nodes), tooth), nodes]), load[nodes]))
        coarse = np.concatenate([load for _, load in parts]).reshape(-1, len(forces), 3)
        return np.concatenate([own for own, _ in parts]), np.moveaxis(coarse, 0, 1)

    @property
    def size(self) -> int:
        """Number of nodes of the finest flank."""
        return self.levels[-1].correction.size

    def _turn(self, tooth: int) -> Floats:
        return turn(tooth * self.pitch, 3)

    @cached_property
    def _rough(self) -> RoughFlanks:
        return RoughFlanks(self.flank, self.levels)
