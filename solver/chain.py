"""The compliance of a body's contact surface: of one body, or of a gear made of equal sectors, behind one interface.

A gear is N sectors, sector s = one sector turned by 2πs/z, held at the bore. The sector is condensed once
(`condense.SectorSystem`), the interfaces between the sectors are eliminated exactly (`interfaces`). With v_s the
displacement of the low face of sector s in its own frame and R the turn by one pitch, the high face of sector s moves
by R v_{s+1}, and

    y_s = C f_s + T [v_s; v_{s+1}],   A v = Σ_s E_sᵀ Tᵀ f_s,

so that y_s = C f_s + Σ_t T G_st Tᵀ f_t. T is smooth (the cut is away from the flank): T = U B with U orthonormal and of
fewer columns, and what a pair of teeth needs of all the rest is one small matrix B G_st Bᵀ.

The ring is closed by default. A few teeth with free outer cuts are a wedge that is held at a narrow bore and leans
over. Error of the deflection of two or three touching teeth under a tangential load, against the closed ring:

    teeth more on each side                 1       2       3       4
    spur, 50 teeth × 3 mm, bore 70 mm     600 %   220 %   110 %    63 %
    the same, bore 120 mm                  16 %   3.8 %   1.1 %   0.3 %
    helical, 17 × 2.1 mm, bore 20          24 %   7.6 %   2.8 %
    helical, 60 × 2.1 mm, bore 60         860 %   370 %   200 %

Measured for the 17-tooth sector of demos/yang2022.toml at level quick (105,000 rows, 6,765 functionals, 2 × 1,230 cut
dofs; CPU time, one thread): condensed in 54 s with 2.6 GB at the peak, ring 10 s (6 s with tolerance 1e-10), rank 1,152
(832), a block of 2,500 rows on four teeth 0.5 s (0.3 s).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from solver.condense import SectorCondensation
from solver.interfaces import Interfaces, OpenChain, Ring, compressed

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Compliance(Protocol):
    """What a contact solver needs of a body: displacements of its surface nodes under forces on surface nodes.

    Rows are (k × 2) integers: tooth and surface node; a body that is not a gear has the one tooth 0. Vectors are in
    the frame of the whole body, `dimension` d components a node.
    """

    @property
    def dimension(self) -> int:
        """Components a node, 2 or 3."""
        ...

    @property
    def node_count(self) -> int:
        """Surface nodes of one tooth."""
        ...

    @property
    def teeth(self) -> range:
        """Numbers of the teeth that exist."""
        ...

    def block(self, rows: Ints) -> Floats:
        """Dense compliance (d·k × d·k, mm/N, symmetric) of the `rows` (k × 2)."""
        ...

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        """Displacements (k_out × d, mm) of `rows_out` under `forces` (k_in × d, N) on `rows_in`."""
        ...


class DenseCompliance:
    """A body that is not a gear: its compliance C (d·n × d·n) is simply indexed."""

    def __init__(self, compliance: Floats, dimension: int) -> None:
        self.compliance = compliance
        self.dimension = dimension
        self.node_count = _node_count(compliance, dimension)
        self.teeth = range(1)

    def block(self, rows: Ints) -> Floats:
        """See `Compliance.block`."""
        dofs = self._dofs(rows)
        return self.compliance[np.ix_(dofs, dofs)]

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        """See `Compliance.apply`."""
        picked = self.compliance[np.ix_(self._dofs(rows_out), self._dofs(rows_in))]
        return (picked @ forces.ravel()).reshape(-1, self.dimension)

    def _dofs(self, rows: Ints) -> Ints:
        _check_rows(rows, self.teeth, self.node_count)
        return _dofs(rows[:, 1], self.dimension)


@dataclass(frozen=True)
class ChainSettings:
    """The teeth that rows may name, and how the sectors are joined.

    `first` is the number of the lowest tooth (tooth s is tooth 0 turned by +s pitches), `count` how many there are.
    `ends`: "closed" joins all 2π/`pitch` sectors of the gear, whatever `count`; "free" and "clamped" model only the
    `count` sectors, and leave the two outermost cut faces free or hold them.
    `tolerance` is the relative error (Frobenius) of the compressed transfer T: 1e-13 is rounding.
    """

    pitch: float
    count: int
    first: int = 0
    dimension: int = 3
    tolerance: float = 1e-13
    ends: Literal["closed", "free", "clamped"] = "closed"

    def __post_init__(self) -> None:
        sectors = 2 * np.pi / self.pitch
        if self.ends == "closed" and (abs(sectors - round(sectors)) > 1e-9 * sectors or self.count > round(sectors)):
            raise ValueError(
                f"a closed gear wants a pitch that divides the circle and no more teeth than it has, found a pitch of "
                f"{self.pitch} rad ({sectors:.6f} to the circle) and {self.count} teeth: correct them or leave the "
                'ends "free"'
            )


class ChainedCompliance:
    """Compliance of a gear of equal sectors: one sector's C, shared by all, and the coupling through the interfaces."""

    def __init__(self, sector: SectorCondensation, settings: ChainSettings) -> None:
        self.dimension = settings.dimension
        self.node_count = _node_count(sector.compliance, settings.dimension)
        self.teeth = range(settings.first, settings.first + settings.count)
        self._pitch = settings.pitch
        self._sector = sector.compliance
        turned = _with_turned_high_face(sector, settings.pitch, settings.dimension)
        self._basis, self._reduced = compressed(turned.transfer, settings.tolerance)
        self._interfaces = _joined(turned.stiffness, self._reduced, settings)

    @property
    def rank(self) -> int:
        """Columns of the compressed transfer."""
        return self._basis.shape[1]

    def block(self, rows: Ints) -> Floats:
        """See `Compliance.block`; memory is that of the result and of one temporary tooth block."""
        groups = self._groups(rows)
        size = len(rows) * self.dimension
        result = np.empty((size, size))
        bases = {tooth: self._turned_basis(tooth, nodes) for tooth, (_, nodes) in groups.items()}
        for tooth, (places, nodes) in groups.items():
            own = _span(places, self.dimension)
            for other in (t for t in groups if t >= tooth):
                columns = _span(groups[other][0], self.dimension)
                part = (bases[tooth] @ self._coupling(tooth, other)) @ bases[other].T
                if other == tooth:
                    part += self._turned_sector(tooth, nodes)
                else:
                    _assign(result, columns, own, part.T)
                _assign(result, own, columns, part)
        return result

    def apply(self, rows_in: Ints, forces: Floats, rows_out: Ints) -> Floats:
        """See `Compliance.apply`."""
        loaded = self._loads(rows_in, forces)
        result = np.empty((len(rows_out), self.dimension))
        for tooth, (places, nodes) in self._groups(rows_out).items():
            dofs = _dofs(nodes, self.dimension)
            modes = sum(self._coupling(tooth, other) @ amplitude for other, (_, _, amplitude) in loaded.items())
            local = self._basis[dofs] @ modes
            if tooth in loaded:
                sources, values, _ = loaded[tooth]
                rows_of_sources = self._sector[sources]  # C is symmetric, and rows are what lies together in memory
                local += values @ (rows_of_sources if len(dofs) == len(self._sector) else rows_of_sources[:, dofs])
            result[places] = local.reshape(-1, self.dimension) @ self._turn(tooth).T
        return result

    def cut_displacements(self, rows_in: Ints, forces: Floats) -> dict[int, Floats]:
        """Displacements (2c: low, high face; sector's own frame) of each tooth's cut faces, for `SectorRecovery`."""
        loaded = self._loads(rows_in, forces)
        sources = {self._place(tooth): self._reduced.T @ amplitude for tooth, (_, _, amplitude) in loaded.items()}
        low_faces = self._interfaces.displacements(sources)
        turn = _turn_by(self._pitch, self.dimension)
        highs = [(face.reshape(-1, self.dimension) @ turn.T).ravel() for face in low_faces[1:]]
        # a closed ring has more sectors than the named teeth
        return {tooth: np.concatenate([low_faces[i], highs[i]]) for i, tooth in enumerate(self.teeth)}

    def _loads(self, rows: Ints, forces: Floats) -> dict[int, tuple[Ints, Floats, Floats]]:
        """Tooth -> dofs, forces in the sector's frame, amplitudes of the basis."""
        loaded = {}
        for tooth, (places, nodes) in self._groups(rows).items():
            dofs = _dofs(nodes, self.dimension)
            values = (forces[places] @ self._turn(tooth)).ravel()
            loaded[tooth] = (dofs, values, self._basis[dofs].T @ values)
        return loaded

    def _groups(self, rows: Ints) -> dict[int, tuple[Ints, Ints]]:
        """Tooth -> places in `rows`, nodes."""
        _check_rows(rows, self.teeth, self.node_count)
        places = {int(tooth): np.flatnonzero(rows[:, 0] == tooth) for tooth in np.unique(rows[:, 0])}
        return {tooth: (place, rows[place, 1]) for tooth, place in places.items()}

    def _place(self, tooth: int) -> int:
        return tooth - self.teeth.start

    def _coupling(self, tooth: int, other: int) -> Floats:
        return self._interfaces.coupling(self._place(tooth), self._place(other))

    def _turn(self, tooth: int) -> Floats:
        return _turn_by(tooth * self._pitch, self.dimension)

    def _turned_basis(self, tooth: int, nodes: Ints) -> Floats:
        return _turn_rows(self._turn(tooth), self._basis[_dofs(nodes, self.dimension)])

    def _turned_sector(self, tooth: int, nodes: Ints) -> Floats:
        dofs = _dofs(nodes, self.dimension)
        local = self._sector[np.ix_(dofs, dofs)]
        if tooth == 0:
            return local
        turn = self._turn(tooth)
        return _turn_rows(turn, _turn_rows(turn, local).T)


def _span(places: Ints, d: int) -> slice | Ints:
    """Degrees of freedom of rows at `places`, as a slice where they follow one another."""
    if len(places) and places[-1] - places[0] + 1 == len(places):
        return slice(d * int(places[0]), d * (int(places[-1]) + 1))
    return _dofs(places, d)


def _assign(matrix: Floats, rows: slice | Ints, columns: slice | Ints, block: Floats) -> None:
    """matrix[rows, columns] = block, for any two index sets."""
    if isinstance(rows, slice) or isinstance(columns, slice):
        matrix[rows, columns] = block
    else:
        matrix[np.ix_(rows, columns)] = block


def _joined(stiffness: Floats, reduced: Floats, settings: ChainSettings) -> Interfaces:
    if settings.ends == "closed":
        return Ring(stiffness, reduced, round(2 * np.pi / settings.pitch), settings.count)
    return OpenChain(stiffness, reduced, settings.count, settings.ends == "clamped")


def _with_turned_high_face(sector: SectorCondensation, pitch: float, dimension: int) -> SectorCondensation:
    """The same sector, its high face in the frame of the next sector (copies of S and T, C shared)."""
    faces = len(sector.stiffness)
    turn = _turn_by(pitch, dimension).T
    high = slice(faces // 2, None)
    transfer, stiffness = sector.transfer.copy(), sector.stiffness.copy()
    transfer[:, high] = _turn_rows(turn, transfer[:, high].T).T
    stiffness[:, high] = _turn_rows(turn, stiffness[:, high].T).T
    stiffness[high] = _turn_rows(turn, stiffness[high])
    return SectorCondensation(stiffness, transfer, sector.compliance)


def _turn_by(angle: float, dimension: int) -> Floats:
    turn = np.eye(dimension)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return turn


def _turn_rows(turn: Floats, matrix: Floats) -> Floats:
    """Every node's d rows of `matrix` (d·k × c) turned by `turn` (d × d)."""
    d = len(turn)
    return np.matmul(turn, matrix.reshape(-1, d, matrix.shape[1])).reshape(matrix.shape)


def _dofs(nodes: Ints, dimension: int) -> Ints:
    return (nodes[:, None] * dimension + np.arange(dimension)).ravel()


def _node_count(compliance: Floats, dimension: int) -> int:
    if compliance.shape[0] != compliance.shape[1] or len(compliance) % dimension:
        raise ValueError(
            f"a square compliance with {dimension} rows a node is wanted, found shape {compliance.shape}: "
            "give the functionals node by node"
        )
    return len(compliance) // dimension


def _check_rows(rows: Ints, teeth: range, node_count: int) -> None:
    bad = (rows[:, 0] < teeth.start) | (rows[:, 0] >= teeth.stop) | (rows[:, 1] < 0) | (rows[:, 1] >= node_count)
    if bad.any():
        tooth, node = rows[np.argmax(bad)]
        raise IndexError(
            f"rows (tooth, node) with teeth {teeth.start} to {teeth.stop - 1} and nodes 0 to {node_count - 1} are "
            f"wanted, found ({tooth}, {node}): model more teeth or correct the node number"
        )
