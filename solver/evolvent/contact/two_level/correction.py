"""The sum of what fine cells change in a compliance, over patches.

    C ≈ R C_0 Rᵀ + ½ (D + Dᵀ),   D = Σ (C_fine − R C_coarse Rᵀ) of each patch, under the forces that it owns

C_0 is the compliance of the coarse body, R its shape functions at the fine nodes. Each fine node is a source in one
patch only. Patches that are congruent share their response.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class PlacedResponse:
    """A response at g congruent places of a surface.

    change: (n·d, s·d) fine less coarse displacements under unit forces, in the frame of the patch [mm/N].
    nodes: (g, n) fine nodes that move.
    sources: (g, s) fine nodes with forces.
    turns: (g, d, d) from the frame of the patch to the body's.
    """

    change: Floats
    nodes: Ints
    sources: Ints
    turns: Floats

    def moved(self, forces: Floats, result: Floats) -> None:
        """Adds the displacements under forces (c, n, d), and those under the transposed change, to result (c, n, d)."""
        for loaded, moved, matrix in (
            (self.sources, self.nodes, self.change.T), (self.nodes, self.sources, self.change)
        ):  # fmt: skip
            own = np.einsum("cgja,gab->cgjb", forces[:, loaded], self.turns)
            u = own.reshape(*own.shape[:2], -1) @ matrix
            turned = np.einsum("cgka,gba->cgkb", u.reshape(*u.shape[:2], -1, own.shape[3]), self.turns)
            for place, nodes in enumerate(moved):
                result[:, nodes] += turned[:, place]


class Correction:
    """½ (D + Dᵀ) of a surface with n nodes and d components."""

    def __init__(self, size: int, responses: Sequence[PlacedResponse]) -> None:
        self.size, self.responses = size, tuple(responses)
        self.d = self.responses[0].turns.shape[-1]

    def times(self, forces: Floats) -> Floats:
        """Displacements (c, n, d) [mm] under forces (c, n, d) [N]."""
        result = np.zeros_like(forces)
        for part in self.responses:
            part.moved(forces, result)
        return result / 2.0

    def among(self, nodes: Ints) -> Floats:
        """(k·d, k·d) [mm/N] between k different nodes."""
        d, place = self.d, np.full(self.size, -1)
        place[nodes] = np.arange(len(nodes))
        result = np.zeros((len(nodes), d, len(nodes), d))
        axes = np.arange(d)
        for part in self.responses:
            for turn, moved, loaded in zip(part.turns, place[part.nodes], place[part.sources]):
                to, of = np.flatnonzero(moved >= 0), np.flatnonzero(loaded >= 0)
                if len(to) and len(of):
                    change = part.change[np.ix_(_dofs(to, d), _dofs(of, d))].reshape(len(to), d, len(of), d)
                    turned = np.einsum("ab,ibjc,ec->iaje", turn, change, turn, optimize=True)
                    result[np.ix_(moved[to], axes, loaded[of], axes)] += turned
        D = result.reshape(d * len(nodes), -1)
        return (D + D.T) / 2.0


def _dofs(nodes: Ints, d: int) -> Ints:
    return np.asarray((nodes[:, None] * d + np.arange(d)).ravel())
