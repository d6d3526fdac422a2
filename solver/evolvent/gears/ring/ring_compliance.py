"""The compliance of the flanks of a gear that is made of equal sectors.

A gear is N sectors held at the bore; sector s is one sector turned by 2πs/z. The sector is condensed once
(`schur_complement.SectorSystem`), the interfaces between the sectors are eliminated exactly (`sector_interfaces`). With
v_s the displacement of the low face of sector s in its own frame and R the turn by one pitch, the high face of sector s
moves by R v_{s+1}, and

    y_s = C f_s + T [v_s; v_{s+1}],   A v = Σ_s E_sᵀ Tᵀ f_s,

so that y_s = C f_s + Σ_t T G_st Tᵀ f_t. T is smooth (the cut is away from the flank), so the coupling of a pair of
teeth through all other sectors is one small matrix between a few modes (`ring_modes`).

The ring is closed. A few teeth with free outer cuts would be a wedge held at a narrow bore, which tilts. Error of the
deflection of two or three touching teeth under a tangential load, against the closed ring:

    teeth more on each side                 1       2       3       4
    spur, 50 teeth × 3 mm, bore 70 mm     600 %   220 %   110 %    63 %
    the same, bore 120 mm                  16 %   3.8 %   1.1 %   0.3 %
    helical, 17 × 2.1 mm, bore 20          24 %   7.6 %   2.8 %
    helical, 60 × 2.1 mm, bore 60         860 %   370 %   200 %

The cost of condensing and of the ring is measured in docs/benchmark.md.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from evolvent.contact.newton.applied_compliance import SurfaceCompliance
from evolvent.fem.condensation.schur_complement import SectorCondensation
from evolvent.gears.ring.chain_settings import ChainSettings
from evolvent.gears.ring.jump_map import JumpMap
from evolvent.gears.ring.ring_modes import Coupling, coupling
from evolvent.gears.ring.ring_window import RingWindow, TeethCoupling
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.rotation import turn


@dataclass(frozen=True)
class MappedNodes:
    """Nodes of one tooth's flank and linear functionals of their displacements.

    tooth: number of the tooth.
    nodes: (k,), of its flank.
    map: from their displacements to the functionals; None: the displacements.
    """

    tooth: int
    nodes: Ints
    map: JumpMap | None = None

    def jumps(self, displacements: Floats) -> Floats:
        """Values (m, c) of the functionals for columns of displacements (d·k, c)."""
        return displacements if self.map is None else self.map.jumps(displacements)

    def of_turned(self, turn: Floats) -> MappedNodes:
        """Functionals of displacements before they are turned by `turn` (d, d)."""
        axes = np.broadcast_to(turn, (len(self.nodes), *turn.shape)) if self.map is None else self.map.axes @ turn
        return replace(self, map=JumpMap(None if self.map is None else self.map.projection, axes))


@dataclass(frozen=True, eq=False)
class DirectedCompliance:
    """Displacements of the nodes of all flanks along one direction a node, under forces along one direction a node."""

    own: Floats
    """(n, n) of the sector of the loaded tooth [mm/N]."""
    modes: Floats
    """(n, r) of the coupling of sectors, along the directions of the displacements."""
    force_modes: Floats
    """(n, r) of the coupling of sectors, along the directions of the forces."""
    between: Callable[[int, int], Floats]
    """Displacements (r, r) of the modes of a tooth by forces on those of another one [mm/N]."""


class Compliance(Protocol):
    """Compliance of a gear: displacements of its flanks' nodes under forces on them, d components a node."""

    def jumps(self, parts: Sequence[MappedNodes]) -> Floats | SurfaceCompliance:
        """Compliance E C Eᵀ (mm/N where E = 1) of the parts' maps E, in their order; each tooth at most once. It is a
        matrix, or applied to forces without one."""
        ...

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        """Displacements (..., k_out, d; mm) of `rows_out` under `forces` (..., k_in, d; N) on `rows_in`.

        Rows are (k × 2) integers, tooth and flank node; vectors are in the frame of the whole gear. Leading axes are
        for several loads on the same rows: reading the compliance costs more than multiplying with it.
        """
        ...


@dataclass(frozen=True, eq=False)
class ChainedCompliance:
    """Compliance of a gear of equal sectors: one sector's C, which all share, and the coupling through interfaces."""

    sector: SectorCondensation
    """One sector, in its own frame."""
    coupling: Coupling
    """Coupling of the teeth through the cut faces of all sectors."""
    settings: ChainSettings
    """Teeth that rows may name."""

    @staticmethod
    def of(sector: SectorCondensation, settings: ChainSettings) -> ChainedCompliance:
        """Closes a sector to the ring. Raises ValueError where the compliance has no whole nodes."""
        _require_nodes(sector.compliance, settings.dimension)
        frames = settings.frames_of_faces(len(sector.stiffness))
        return ChainedCompliance(sector, coupling(sector, frames, settings.joined, settings.tolerance), settings)

    @property
    def dimension(self) -> int:
        """Dimension of space, d."""
        return self.settings.dimension

    @property
    def node_count(self) -> int:
        """Number of nodes of a tooth's flank."""
        return len(self.sector.compliance) // self.dimension

    @property
    def teeth(self) -> range:
        """Numbers of the teeth that rows may name."""
        return range(self.settings.first, self.settings.first + self.settings.count)

    def jumps(self, parts: Sequence[MappedNodes]) -> Floats:
        """Compliance E C Eᵀ of the parts' maps E as a matrix, in their order (mm/N where E = 1). The maps are applied
        to the few modes of the coupling, and to the whole compliance of their own tooth only."""
        self._check([(part.tooth, node) for part in parts for node in part.nodes])
        parts = [part.of_turned(self._turn(part.tooth)) if part.tooth else part for part in parts]
        modes = [part.jumps(self.coupling.modes[_dofs(part.nodes, self.dimension)]) for part in parts]
        ends = np.cumsum([0] + [len(mode) for mode in modes])
        result = np.empty((ends[-1], ends[-1]))
        for i, (part, mode) in enumerate(zip(parts, modes)):
            for j in range(i, len(parts)):
                block = mode @ self._between(part.tooth, parts[j].tooth) @ modes[j].T
                if j == i:
                    block += part.jumps(part.jumps(self._own(part.nodes)).T)
                result[ends[i] : ends[i + 1], ends[j] : ends[j + 1]] = block
                result[ends[j] : ends[j + 1], ends[i] : ends[i + 1]] = block.T
        return result

    def directed(self, nodes: Ints, axes: Floats, forces: Floats | None = None) -> DirectedCompliance:
        """Compliance between some nodes (n,) of each tooth along directions (n, d) in the frame of its sector. forces:
        (n, d) directions of the forces, by default those of the displacements."""
        along = axes if forces is None else forces
        dofs, d = _dofs(nodes, self.dimension), self.dimension
        right = np.empty((len(dofs), len(nodes)))
        for j, (node, axis) in enumerate(zip(nodes, along)):
            right[:, j] = self.sector.compliance[d * node : d * node + d].T[dofs] @ axis  # C is symmetric
        own = np.einsum("iaj,ia->ij", right.reshape(len(nodes), d, -1), axes)
        here = self.coupling.modes[dofs].reshape(len(nodes), d, -1)
        modes, force_modes = (np.einsum("iar,ia->ir", here, each) for each in (axes, along))
        return DirectedCompliance(own, modes, force_modes, self._between)

    def window(self, parts: Sequence[tuple[int, Ints]]) -> RingWindow:
        """Compliance between some nodes (k,) of some teeth, each at most once. Raises IndexError."""
        self._check([(tooth, node) for tooth, nodes in parts for node in nodes])
        dofs = [_dofs(nodes, self.dimension) for _, nodes in parts]
        own = tuple(self._own(nodes) for _, nodes in parts)
        coupling = self._coupling_of(tuple(tooth for tooth, _ in parts))
        return RingWindow(own, tuple(self.coupling.modes[each] for each in dofs), coupling)

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        """Displacements (..., k_out, d) [mm] of `rows_out` (k_out, 2) under `forces` (..., k_in, d) [N] on `rows_in`. A
        row is a tooth and a flank node."""
        loaded = self._loads(rows_in, forces)
        result = np.empty((*forces.shape[:-2], len(rows_out), self.dimension))
        for tooth, (places, nodes) in self._groups(rows_out).items():
            dofs = _dofs(nodes, self.dimension)
            modes = sum(amplitude @ self._between(other, tooth) for other, (_, _, amplitude) in loaded.items())
            local = modes @ self.coupling.modes[dofs].T
            if tooth in loaded:
                sources, values, _ = loaded[tooth]
                local += values @ self.sector.compliance[np.ix_(sources, dofs)]  # C is symmetric
            result[..., places, :] = local.reshape(*local.shape[:-1], -1, self.dimension) @ self._turn(tooth).T
        return result

    def cut_displacements(self, rows_in: Ints, forces: Floats) -> dict[int, Floats]:
        """Displacements (2c: low, high face; sector's own frame; mm) of each tooth's cut faces under `forces`
        (k_in, d; N), or (n, 2c) under (n, k_in, d), for `SectorRecovery`. Exact, whatever the tolerance."""
        frames = self.settings.frames_of_faces(len(self.sector.stiffness))
        sources = {
            self._place(tooth): frames.T @ (values @ self.sector.transfer[dofs]).T
            for tooth, (dofs, values, _) in self._loads(rows_in, forces).items()
        }
        low_faces = self.settings.joined(frames.T @ self.sector.stiffness @ frames).displacements(sources)
        # the ring has more sectors than the named teeth
        return {tooth: (frames @ np.concatenate(low_faces[i : i + 2])).T for i, tooth in enumerate(self.teeth)}

    def observed_displacements(self, rows_in: Ints, forces: Floats) -> dict[int, Floats]:
        """Displacements (n, k, d; sector's own frame; mm) of the k observed nodes of each tooth under `forces`
        (n, k_in, d; N). Exact, whatever the tolerance. Raises ValueError where none were condensed."""
        response = self.sector.observed
        if response is None:
            raise ValueError("ring of sectors: wanted observed nodes, found none; condense them with the flank")
        loaded = self._loads(rows_in, forces)
        result = {}
        for tooth, cut in self.cut_displacements(rows_in, forces).items():
            moved = cut @ response.transfer.T
            if tooth in loaded:
                dofs, values, _ = loaded[tooth]
                moved += values @ response.compliance[:, dofs].T
            result[tooth] = moved.reshape(len(forces), -1, self.dimension)
        return result

    def _loads(self, rows: Ints, forces: Floats) -> dict[int, tuple[Ints, Floats, Floats]]:
        """Tooth -> dofs, forces in the sector's frame, amplitudes of the modes."""
        loaded = {}
        for tooth, (places, nodes) in self._groups(rows).items():
            dofs = _dofs(nodes, self.dimension)
            values = forces[..., places, :] @ self._turn(tooth)
            values = values.reshape(*values.shape[:-2], -1)
            loaded[tooth] = (dofs, values, values @ self.coupling.modes[dofs])
        return loaded

    def _groups(self, rows: Ints) -> dict[int, tuple[Ints, Ints]]:
        """Tooth -> places in `rows`, nodes."""
        self._check(rows)
        places = {int(tooth): np.flatnonzero(rows[:, 0] == tooth) for tooth in np.unique(rows[:, 0])}
        return {tooth: (place, rows[place, 1]) for tooth, place in places.items()}

    def _check(self, rows: Ints | list[tuple[int, int]]) -> None:
        rows = np.asarray(rows).reshape(-1, 2)
        teeth, nodes = rows.T
        bad = (teeth < self.teeth.start) | (teeth >= self.teeth.stop) | (nodes < 0) | (nodes >= self.node_count)
        if bad.any():
            tooth, node = rows[np.argmax(bad)]
            raise IndexError(
                f"rows of a gear: wanted (tooth, node) with teeth {self.teeth.start} to {self.teeth.stop - 1} and "
                f"nodes 0 to {self.node_count - 1}, found ({tooth}, {node}); model more teeth or correct the number"
            )

    def _place(self, tooth: int) -> int:
        return tooth - self.teeth.start

    def _between(self, tooth: int, other: int) -> Floats:
        return self.coupling.between(self._place(tooth), self._place(other))

    def _coupling_of(self, teeth: tuple[int, ...]) -> TeethCoupling:
        """Coupling of some teeth, made once: it is the same at all positions."""
        if teeth not in self._couplings:
            blocks = [[self._between(tooth, other) for other in teeth] for tooth in teeth]
            self._couplings[teeth] = TeethCoupling(np.block(blocks))
        return self._couplings[teeth]

    @cached_property
    def _couplings(self) -> dict[tuple[int, ...], TeethCoupling]:
        return {}

    def _turn(self, tooth: int) -> Floats:
        return turn(tooth * self.settings.pitch, self.dimension)

    def _own(self, nodes: Ints) -> Floats:
        """Compliance of the sector between some nodes, in its own frame."""
        dofs = _dofs(nodes, self.dimension)
        return self.sector.compliance[np.ix_(dofs, dofs)]


def _dofs(nodes: Ints, dimension: int) -> Ints:
    return (nodes[:, None] * dimension + np.arange(dimension)).ravel()


def _require_nodes(compliance: Floats, dimension: int) -> None:
    if compliance.shape[0] != compliance.shape[1] or len(compliance) % dimension:
        raise ValueError(
            f"sector: wanted a square compliance with {dimension} rows a node, found shape {compliance.shape}; "
            "give the functionals node by node"
        )
