"""Inertia of a gear: natural modes at its flanks, moment of inertia, and their coupling."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from evolvent.contact.nitsche.flux_recovery import NitscheTraction
from evolvent.dynamics.modes.cyclic_stiffness import CyclicFaces
from evolvent.dynamics.modes.ring_modes import RingModes, SectorMatrices, harmonics, modes_below, ring_modes
from evolvent.fem.body import Body
from evolvent.fem.cache.cache import Cache
from evolvent.fem.condensation.schur_complement import NotPositiveDefinite
from evolvent.fem.mass_matrix import mass_matrix
from evolvent.fem.parallel.memory import return_free_memory
from evolvent.fem.surface import Surface, surface_of
from evolvent.gears.condensed_gear import GearBody, SectorParts, in_words, sector_body, sector_parts
from evolvent.gears.kinematics import spin
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.mesh_digest import mesh_digest
from evolvent_meshes.rotation import turn


@dataclass(frozen=True)
class GearModes:
    """Inertia of a gear with m modes, its bore held in its frame."""

    modes: RingModes
    """Natural modes with the shapes (n·d, m) of the flank's functionals, which enter the contact."""
    moment_of_inertia: float
    """Moment of inertia of the meshed body about its axis [t·mm²; t·mm in 2D]."""
    spun: Floats
    """Inertia force φᵀ M r (m,) on each mode by a unit angular acceleration; zero but in harmonic 0."""

    @property
    def count(self) -> int:
        """Number m of modes."""
        return len(self.modes.frequencies)

    def at(self, tooth: int, nodes: Ints, d: int) -> Floats:
        """Displacements (k·d, m) of nodes (k,) of a tooth's flank by unit amplitudes, in the tooth's own frame."""
        rows = (nodes[:, None] * d + np.arange(d)).ravel()
        return self.modes.of_sector(tooth, rows)


FIRST = 8
"""Modes of each harmonic that are computed first where they cannot be counted beforehand."""


@dataclass(frozen=True)
class ModeChoice:
    """Rule by which modes are computed."""

    highest: float
    """Frequency up to which all modes are computed [rad/s]."""
    per_harmonic: int | None = None
    """Number of modes of each harmonic, pairs counted once; None: all up to a frequency."""
    least: int = 0
    """Fewest modes of each harmonic, whatever their frequency."""

    def of(
        self, sector: SectorMatrices, sectors: int, computed: Callable[[], None] = lambda: None
    ) -> RingModes:
        """Modes of a ring of sectors. computed: called after each harmonic. Raises NotPositiveDefinite, OutOfMemory."""
        if self.per_harmonic is not None:
            return ring_modes(sector, sectors, [self.per_harmonic for _ in harmonics(sectors)], computed)
        try:
            below = modes_below(sector, sectors, self.highest)
            return ring_modes(sector, sectors, [max(count, self.least) for count in below], computed)
        except NotPositiveDefinite:  # a sector between held cut faces vibrates below it, too
            return self._by_search(sector, sectors, computed)

    def _by_search(self, sector: SectorMatrices, sectors: int, computed: Callable[[], None]) -> RingModes:
        """Modes of a ring of sectors, more and more of each harmonic until one beyond the highest frequency is among
        them."""
        count = FIRST
        while True:
            found = ring_modes(sector, sectors, [count for _ in harmonics(sectors)], computed)
            beyond = found.harmonic[found.frequencies > self.highest]
            if count >= sector.stiffness.shape[0] // 2 or len(np.unique(beyond)) == len(harmonics(sectors)):
                return found.some((found.frequencies <= self.highest) | (found.rank < self.least))
            count *= 2


def gear_modes(
    body: GearBody, choice: ModeChoice, mesh: MeshData | None = None, computed: Callable[[], None] = lambda: None
) -> GearModes:
    """Modes of a condensed gear.

    mesh: of another sector of it, whose modes are interpolated to the flank's nodes; None: on its own, exactly.
    computed: called after each harmonic of the ring.

    Raises NotPositiveDefinite, OutOfMemory, CompileError, CacheError.
    """
    sector, γ, to_flank = body.condensed_mesh, body.stabiliser, None
    if mesh is not None:
        # traction-free there: the modes' own flux on a coarse flank is nothing but its error
        sector, γ, to_flank = mesh, None, FlankLattice.of(surface_of(mesh, "flank").points)
    mean = "" if γ is None else f"{γ.mean():.6e}"  # whatever the order of its sums
    inputs = "modes", mesh_digest(sector), body.material, choice, body.gear.z, mean
    found = Cache.of_environment().kept(
        f"natural modes, {in_words(body.gear)}", inputs, GearModes,
        lambda: _on_mesh(body, sector, body.traction if mesh is None else None, choice, computed),
    )
    return_free_memory()  # of the factors, gigabytes; time steps want less at once
    if to_flank is None:
        return found
    across = sp.kron(to_flank.interpolation(body.flank.points), sp.eye(body.d)).tocsr()
    return replace(found, modes=replace(found.modes, shapes=across @ found.modes.shapes))


def sector_matrices(
    elastic: Body, flank: Surface, traction: NitscheTraction | None, sectors: int
) -> tuple[SectorMatrices, sp.csr_matrix, SectorParts]:
    """Matrices of a sector of a gear of so many, its mass matrix with the held degrees of freedom, and its parts.
    traction: of Nitsche's method on its flank, None without."""
    pitch, d = 2.0 * np.pi / sectors, elastic.mesh.dimension
    parts = sector_parts(elastic, flank, traction, pitch)
    M = mass_matrix(elastic)
    place = np.full(M.shape[0], -1)
    place[parts.free] = np.arange(len(parts.free))
    low, high = place[parts.low], place[parts.high]
    interior = np.setdiff1d(np.arange(len(parts.free)), np.concatenate([low, high]))
    about = sp.kron(sp.eye(len(low) // d), turn(pitch, d)).tocsr()
    stiffness, mass = (matrix.tocsr()[parts.free][:, parts.free] for matrix in (parts.stiffness, M))
    return SectorMatrices(stiffness, mass, CyclicFaces(interior, low, high, about)), M, parts


def _on_mesh(
    body: GearBody, sector_of: MeshData, traction: NitscheTraction | None, choice: ModeChoice,
    computed: Callable[[], None],
) -> GearModes:
    """Modes at the functionals of the flank of a sector mesh."""
    elastic, N = sector_body(sector_of, body.material, body.member), body.gear.z
    sector, M, parts = sector_matrices(elastic, surface_of(sector_of, "flank"), traction, N)
    found = choice.of(sector, N, computed)
    r = spin(sector_of.points[:, : body.d], np.zeros(body.d)).ravel()
    pushed = np.real(found.shapes.T @ (M @ r)[parts.free])
    spun = np.where(found.harmonic == 0, N * pushed, 0.0)
    shapes = parts.functionals.tocsc()[:, parts.free] @ found.shapes
    return GearModes(replace(found, shapes=shapes), float(N * (r @ (M @ r))), spun)
