"""The inertia of a gear: natural modes at its flanks, moment of inertia, and what both have in common."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from evolvent.dynamics.modes.cyclic_stiffness import CyclicFaces
from evolvent.dynamics.modes.ring_modes import RingModes, SectorMatrices, harmonics, modes_below, ring_modes
from evolvent.fem.modes.mass_matrix import mass_matrix
from evolvent.gears.condensed_gear import GearBody, sector_body, sector_parts
from evolvent.gears.kinematics import turn
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class GearModes:
    """m modes of a gear whose bore is held in its frame."""

    modes: RingModes
    """Their shapes are those of the flank's functionals (n·d, m), which enter the contact."""
    moment_of_inertia: float
    """Of the meshed body about its axis [t·mm²; t·mm in 2D]."""
    spun: Floats
    """φᵀ M r (m,): inertia force on each mode by a unit angular acceleration; zero but in harmonic 0."""

    @property
    def count(self) -> int:
        """m."""
        return len(self.modes.frequencies)

    def at(self, tooth: int, nodes: Ints, d: int) -> Floats:
        """Displacements (k·d, m) of nodes (k,) of a tooth's flank by unit amplitudes, in the tooth's own frame."""
        rows = (nodes[:, None] * d + np.arange(d)).ravel()
        return self.modes.of_sector(tooth, rows)


@dataclass(frozen=True)
class ModeChoice:
    """Which modes are computed."""

    highest: float
    """All up to this frequency [rad/s]."""
    per_harmonic: int | None = None
    """So many of each harmonic instead, pairs counted once."""

    def counts(self, sector: SectorMatrices, sectors: int) -> list[int]:
        """Of each harmonic. Raises NotPositiveDefinite, OutOfMemory."""
        if self.per_harmonic is not None:
            return [self.per_harmonic for _ in harmonics(sectors)]
        return modes_below(sector, sectors, self.highest)


def gear_modes(body: GearBody, choice: ModeChoice) -> GearModes:
    """Modes on the sector mesh of a condensed gear.

    Raises NotPositiveDefinite, OutOfMemory, CompileError, CacheError.
    """
    elastic, pitch, N = sector_body(body.mesh, body.material, body.member), 2.0 * np.pi / body.gear.z, body.gear.z
    parts = sector_parts(elastic, body.flank, body.traction, pitch)
    M = mass_matrix(elastic)
    place = np.full(M.shape[0], -1)
    place[parts.free] = np.arange(len(parts.free))
    low, high = place[parts.low], place[parts.high]
    interior = np.setdiff1d(np.arange(len(parts.free)), np.concatenate([low, high]))
    about = sp.kron(sp.eye(len(low) // body.d), turn(pitch, body.d)).tocsr()
    stiffness, mass = (matrix.tocsr()[parts.free][:, parts.free] for matrix in (parts.stiffness, M))
    sector = SectorMatrices(stiffness, mass, CyclicFaces(interior, low, high, about))
    found = ring_modes(sector, N, choice.counts(sector, N))
    r = _turning(body.mesh.points, body.d)
    pushed = np.real(found.shapes.T @ (M @ r)[parts.free])
    spun = np.where(found.harmonic == 0, N * pushed, 0.0)
    flank = parts.functionals.tocsc()[:, parts.free] @ found.shapes
    return GearModes(replace(found, shapes=flank), float(N * (r @ (M @ r))), spun)


def _turning(points: Floats, d: int) -> Floats:
    """Displacements (N·d,) by a unit turn about the axis."""
    moved = np.zeros((len(points), d))
    moved[:, 0], moved[:, 1] = -points[:, 1], points[:, 0]
    return moved.ravel()
