"""The closed ring of a gear's equal sectors, solved exactly by harmonics.

Interface s (0 … z − 1) is the low face of sector s, in that sector's frame; v_s its displacement. Every interface sees
the same, so the discrete Fourier transform over s takes the ring apart into one system a harmonic:

    A_k = S_LL + S_HH + S_LH ω^k + S_HL ω^−k,   ω = exp(2πi/z)        (c × c, Hermitian, positive definite)

Source: rotationally periodic structures, Thomas 1979, doi 10.1002/nme.1620140107.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from meshes.data import Floats


def ring_couplings(stiffness: Floats, reduced: Floats, z: int, reach: int) -> Floats:
    """What a sector's faces do to another's: B [v_t; v_{t+1}] under the face forces Bᵀ of sector 0.

    stiffness: S (2c, 2c) of a sector on its low and its high face, the high face in the frame of the next sector;
    reduced: B (r, 2c). Returns (2·reach + 1, r, r): entry reach + t for the offset t = −reach … reach.
    """
    c = len(stiffness) // 2
    low, high = slice(None, c), slice(c, None)
    result = np.zeros((2 * reach + 1, len(reduced), len(reduced)))
    offsets = np.arange(-reach, reach + 1)
    for k in range(z // 2 + 1):
        ω = np.exp(2j * np.pi * k / z)
        A = stiffness[low, low] + stiffness[high, high] + ω * stiffness[low, high] + stiffness[high, low] / ω
        W = reduced[:, low] + ω * reduced[:, high]
        response = W @ cho_solve(cho_factor(A, lower=True, overwrite_a=True, check_finite=False), W.conj().T)
        twice = 1.0 if k == 0 or 2 * k == z else 2.0  # harmonics k and z − k are conjugate
        phases = twice / z * ω**offsets
        result += phases.real[:, None, None] * response.real - phases.imag[:, None, None] * response.imag
    return result
