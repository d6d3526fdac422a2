"""The compliance of fine flanks between the nodes of a position's contact, as products with contact forces."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.block_inverse import NearlyNormal
from evolvent.gears.ring.jump_map import JumpMap
from evolvent.gears.ring.ring_compliance import MappedNodes
from evolvent.gears.ring.ring_window import RingWindow
from evolvent.gears.two_level.strips import LoadedStrips
from evolvent_meshes.arrays import Floats, Ints, Reals


@dataclass(frozen=True)
class LevelWindow:
    """Transfer and correction of one level of all flanks between some of their nodes (k,), tooth by tooth.

    transfer: (k, c) shape functions of the nodes of the level before.
    strips: its correction between them.
    """

    transfer: sp.csr_matrix
    strips: LoadedStrips

    @cached_property
    def single(self) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """The transfer and its transpose in single precision."""
        R = self.transfer.astype(np.float32)
        return R, R.T.tocsr()

    @cached_property
    def double(self) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """The transfer and its transpose in double precision."""
        return self.transfer, self.transfer.T.tocsr()

    @property
    def nbytes(self) -> int:
        """Memory [bytes]: shape functions twice in either precision, and the places of the patches' nodes."""
        R = self.transfer
        return 3 * R.data.nbytes + 4 * R.indices.nbytes + self.strips.nbytes

    def of(self, dtype: Any) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """The transfer and its transpose in a precision."""
        return self.single if dtype == np.float32 else self.double


@dataclass(frozen=True)
class ToothWindow:
    """Some nodes of one tooth's flank.

    map: from their displacements, in the gear's frame, to the jumps.
    turn: (3, 3) from the frame of tooth 0 to that of the gear.
    nodes: of each level, from the coarse flank to the finest.
    """

    map: JumpMap
    turn: Floats
    nodes: tuple[Ints, ...]


@dataclass(frozen=True)
class FlankWindow:
    """One gear's part of the compliance of a position (a `SurfaceCompliance`).

    teeth: its flanks, one a tooth pair.
    levels: correction by each level between their nodes, from the coarsest to the finest.
    ring: the compliance of the coarse nodes.
    roughly: makes an approximate matrix of it.
    """

    teeth: tuple[ToothWindow, ...]
    levels: tuple[LevelWindow, ...]
    ring: RingWindow
    roughly: Callable[[FlankWindow], NearlyNormal]

    def times(self, force: Reals) -> Reals:
        """Jumps (n, k) [mm] under forces (n, k) [N], in the precision of the forces."""
        parts = np.split(force, _ends(len(t.map.axes) for t in self.teeth))
        forces = np.concatenate([t.map.forces(f) @ t.turn for t, f in zip(self.teeth, parts)])
        u = self.moved(forces.astype(force.dtype))
        moved = zip(self.teeth, np.split(u, _ends(len(t.nodes[-1]) for t in self.teeth)))
        jumps = [t.map.jumps((part @ t.turn.T).reshape(-1, 1)) for t, part in moved]
        return np.concatenate(jumps).reshape(force.shape).astype(force.dtype)

    def moved(self, forces: Reals) -> Reals:
        """Displacements (k, 3) of the finest nodes under forces (k, 3) on them, tooth by tooth, each in the frame of
        tooth 0."""
        loads = [forces]
        for level in reversed(self.levels):
            loads.append(level.of(forces.dtype)[1] @ loads[-1])
        u = self.ring.times(loads[-1])
        for level, f in zip(self.levels, loads[-2::-1]):
            u = level.of(forces.dtype)[0] @ u + level.strips.times(f)
        return u

    def normal(self) -> FlankWindow:
        """Compliance between normal components alone."""
        teeth = [replace(t, map=JumpMap(t.map.projection, t.map.axes[:, :1])) for t in self.teeth]
        return replace(self, teeth=tuple(teeth))

    def nearly(self) -> NearlyNormal:
        """Approximation as block matrix and modes, for preconditioning."""
        return self.roughly(self)

    @property
    def nbytes(self) -> int:
        """Memory of the ring's and the levels' parts [bytes]."""
        return self.ring.nbytes + sum(level.nbytes for level in self.levels)

    def smooth(self, modes: Floats) -> Floats:
        """Jumps (Σn·k, r) from modes (c·3, r) of the coarse nodes."""
        U = modes.reshape(-1, 3 * modes.shape[1])
        for level in self.levels:
            U = level.transfer @ U
        parts = np.split(U.reshape(len(U), 3, -1), _ends(len(t.nodes[-1]) for t in self.teeth))
        turned = [np.einsum("ab,nbr->nar", t.turn, part) for t, part in zip(self.teeth, parts)]
        return np.concatenate([t.map.jumps(u.reshape(-1, u.shape[2])) for t, u in zip(self.teeth, turned)])


def _ends(counts: Iterable[int]) -> Ints:
    """Ends of all but the last of some parts."""
    return np.cumsum(list(counts))[:-1]


def map_of(part: MappedNodes) -> JumpMap:
    """The map of a part's displacements; by default they are the jumps."""
    return part.map or JumpMap(None, np.broadcast_to(np.eye(3), (len(part.nodes), 3, 3)))
