"""Natural modes of a gear of N equal sectors, held at its bore, harmonic by harmonic.

A harmonic 0 < k < N/2 has pairs of modes, u_s = √(2/N) Re(φ e^{iks2π/N}) and Im of the same, in the frames of the
sectors s; k = 0 and k = N/2 have single ones, √(1/N) φ e^{iks2π/N}. φ is a complex mode of one sector
(`cyclic_stiffness`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigsh

from evolvent.dynamics.modes.cyclic_stiffness import CyclicFaces, CyclicInverse, CyclicStiffness, Numbers
from evolvent_meshes.arrays import Bools, Floats, Ints

FEW = 60
"""Unknowns of a harmonic below which its dense eigenproblem is solved."""
MORE = 6
"""Krylov vectors beyond two for each mode. With ARPACK's own choice, 20 at least, and its own residual one mode takes
21 solves instead of 13."""
RESIDUAL = 1e-12
"""Relative residual of the modes; frequencies are then right to rounding (1e-14)."""


@dataclass(frozen=True)
class SectorMatrices:
    """Stiffness and mass of a sector on its N free degrees of freedom."""

    stiffness: sp.csr_matrix
    """Stiffness matrix (N, N) [N/mm]."""
    mass: sp.csr_matrix
    """Mass matrix (N, N) [t]."""
    faces: CyclicFaces
    """Degrees of freedom of the sector's interior and cut faces."""


@dataclass(frozen=True)
class RingModes:
    """m modes of the whole gear, ascending within each harmonic; those of a pair follow each other."""

    sectors: int
    """Number N of sectors."""
    frequencies: Floats
    """Natural frequencies ω (m,) [rad/s]."""
    harmonic: Ints
    """Harmonic k (m,) of each mode."""
    imaginary: Ints
    """Number (m,) of each mode in its pair: 1 for the second one, else 0."""
    shapes: Numbers
    """Complex shapes (n, m) of sector 0 in its own frame, scaled; the real part is the displacement, see
    `of_sector`."""

    @property
    def rank(self) -> Ints:
        """Rank (m,) of each mode in its harmonic by frequency, from 0; both of a pair have the same."""
        count = np.cumsum(self.imaginary == 0)
        first = np.searchsorted(self.harmonic, self.harmonic)
        return np.asarray(count - count[first])

    def of_sector(self, number: int, rows: Ints | None = None) -> Floats:
        """Displacements (n, m) of a sector in its own frame by unit amplitudes; rows: (k,) some of the n."""
        turned = np.exp(2j * np.pi * self.harmonic * number / self.sectors - 0.5j * np.pi * self.imaginary)
        shapes = self.shapes if rows is None else self.shapes[rows]
        return np.real(shapes * turned)

    def some(self, wanted: Bools) -> RingModes:
        """Some of the modes. wanted: (m,), both of a pair or none."""
        return RingModes(
            self.sectors, self.frequencies[wanted], self.harmonic[wanted], self.imaginary[wanted],
            self.shapes[:, wanted],
        )

    def earlier(self, amplitudes: Floats, pitches: int) -> Floats:
        """Amplitudes (m,) of the same motion, in which sector s moves as sector s + pitches did."""
        angle = 2.0 * np.pi * self.harmonic * pitches / self.sectors
        partner = np.arange(len(angle))
        pairs = np.flatnonzero(self.imaginary)
        partner[pairs], partner[pairs - 1] = pairs - 1, pairs
        sign = np.where(self.imaginary == 1, -1.0, 1.0)
        crossed = np.where(partner == np.arange(len(angle)), 0.0, sign * np.sin(angle) * amplitudes[partner])
        return np.cos(angle) * amplitudes + crossed


def harmonics(sectors: int) -> range:
    """Harmonics 0 … N/2 of a ring of N sectors."""
    return range(sectors // 2 + 1)


def modes_below(sector: SectorMatrices, sectors: int, highest: float) -> list[int]:
    """Number of modes of each harmonic below a frequency [rad/s], pairs counted once.

    Raises NotPositiveDefinite where the interior alone, with its cut faces held, vibrates below it; OutOfMemory.
    """
    shifted = CyclicStiffness((sector.stiffness - highest**2 * sector.mass).tocsr(), sector.faces)
    return [shifted.negative(phase_of(k, sectors)) for k in harmonics(sectors)]


def ring_modes(
    sector: SectorMatrices, sectors: int, counts: Sequence[int], computed: Callable[[], None] = lambda: None
) -> RingModes:
    """The lowest modes of each harmonic, so many, pairs counted once. computed: called after each harmonic. Raises
    NotPositiveDefinite, OutOfMemory."""
    size = sector.stiffness.shape[0]
    cyclic = CyclicStiffness(sector.stiffness, sector.faces) if any(counts) else None
    frequencies, harmonic, imaginary, shapes = [], [], [], []
    for k, count in enumerate(counts):
        if not count or cyclic is None:
            continue
        single, phase = 2 * k in (0, sectors), phase_of(k, sectors)
        ω, φ = _modes(sector, cyclic.inverse(phase), phase, count)
        whole = sector.faces.expanded(φ, phase, size) * np.sqrt((1.0 if single else 2.0) / sectors)
        copies = 1 if single else 2
        frequencies.append(np.repeat(ω, copies))
        shapes.append(np.repeat(whole, copies, axis=1))
        harmonic.append(np.full(copies * len(ω), k))
        imaginary.append(np.tile(np.arange(copies), len(ω)))
        computed()
    if not shapes:
        nothing = np.zeros(0, dtype=np.int64)
        return RingModes(sectors, np.zeros(0), nothing, nothing, np.zeros((size, 0)))
    numbers = np.concatenate(harmonic), np.concatenate(imaginary)
    return RingModes(sectors, np.concatenate(frequencies), *numbers, np.concatenate(shapes, axis=1))


def phase_of(k: int, sectors: int) -> complex:
    """Phase e^{2πik/N} of harmonic k between neighbouring sectors; a real number for k = 0 and N/2."""
    turned = np.exp(2j * np.pi * k / sectors)
    return complex(turned) if 2 * k not in (0, sectors) else float(np.real(turned))


def _modes(
    sector: SectorMatrices, inverse: CyclicInverse, phase: complex, count: int
) -> tuple[Floats, Numbers]:
    """Frequencies ω (m,) and shapes φ (n_i + c, m) of a harmonic, φᴴ M(θ) φ = 1."""
    K, M = (sector.faces.reduced(matrix, phase) for matrix in (sector.stiffness, sector.mass))
    n = K.shape[0]
    if n <= max(FEW, 3 * count):
        values, shapes = eigh(K.toarray(), M.toarray())
        return np.sqrt(values[:count]), shapes[:, :count]
    operator = LinearOperator((n, n), inverse.solve, dtype=K.dtype)
    start = np.random.default_rng(1).standard_normal(n).astype(K.dtype)  # ARPACK's own differs from run to run
    vectors = min(2 * count + MORE, n - 1)
    values, shapes = eigsh(K, count, M=M, sigma=0.0, OPinv=operator, v0=start, ncv=vectors, tol=RESIDUAL)
    order = np.argsort(values)
    shapes = shapes[:, order]
    norms = np.sqrt(np.real(np.einsum("nm,nm->m", shapes.conj(), M @ shapes)))
    return np.sqrt(values[order]), shapes / norms
