"""Figures of a motion that repeats with the mesh, or after several meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.oscillator.settling import LONGEST_REPEAT
from evolvent.dynamics.oscillator.torsional_model import History, TorsionalModel, history
from evolvent_meshes.arrays import Floats

SAMPLES = 256
"""Samples per mesh period from which harmonics are computed."""
HARMONICS = 5
HIGHEST_ORDER = 8
"""Highest mesh order of the spectrum."""
MESHES = 500
"""Mesh periods of a motion that does not repeat, from which its largest force and its times out of contact are taken:
from 16 of them the largest force of a chaotic motion of He's pair was 27 % too low."""
IN_RMS = 3
"""Harmonics in the equivalent amplitude of Kahraman and Blankenship's measurements (He et al. 2022, Eq. 14)."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Lines of a motion at the mesh orders 1/r, 2/r, ... up to `HIGHEST_ORDER`, r the mesh periods that it was taken
    over; half orders belong to a motion that repeats after two meshes."""

    orders: Floats
    """(n,) frequencies over that of the mesh."""
    total: Floats
    """(n,) amplitudes of s [mm]."""
    force: Floats
    """(n,) amplitudes of the mesh force [N]."""


@dataclass(frozen=True, eq=False)
class Response:
    """Figures of a motion at one speed."""

    total: Floats
    """(5,) amplitudes of the mesh harmonics of s, the dynamic transmission error with the unloaded one in it [mm]."""
    elastic: Floats
    """(5,) amplitudes of the mesh harmonics of the deflection s − e [mm]."""
    force: Floats
    """(5,) amplitudes of the mesh harmonics of the mesh force [N]."""
    largest_force: float
    """Largest mesh force [N]."""
    smallest_force: float
    """Smallest mesh force [N]; below 0 where back flanks press, or the damper pulls."""
    separated_share: float
    """Share of the time out of contact."""
    back_contact_share: float
    """Share of the time on the back flanks."""
    spectrum: Spectrum
    """Spectrum of the motion, with the lines between the mesh harmonics."""

    @property
    def equivalent_amplitude(self) -> float:
        """√ΣA_r² of the first three harmonics of s [mm]; the rms of such a motion is 1/√2 of it."""
        return float(np.linalg.norm(self.total[:IN_RMS]))

    @property
    def elastic_equivalent_amplitude(self) -> float:
        """√ΣA_r² of the first three harmonics of the deflection s − e [mm]."""
        return float(np.linalg.norm(self.elastic[:IN_RMS]))


def response(model: TorsionalModel, period: float, state: Floats, repeats: int = 1) -> Response:
    """Figures of the motion from a state (2,) at phase 0. period: of the mesh [s]. repeats: mesh periods after which
    the motion repeats; 0 where it does not. Harmonics are then those of `LONGEST_REPEAT` mesh periods, forces and
    contact shares those of `MESHES`."""
    wanted, later = np.arange(SAMPLES) / SAMPLES, 0 if repeats else MESHES - LONGEST_REPEAT
    repeats = repeats or LONGEST_REPEAT
    paths = histories(model, period, state, repeats, wanted)
    at = np.searchsorted(paths[0].phases, wanted - 1e-12)
    total, error, force = (
        np.concatenate([getattr(path, name)[at] for path in paths]) for name in ("transmission_error", "error", "force")
    )
    s, x, F = (_amplitudes(values) for values in (total, total - error, force))
    mesh = slice(repeats - 1, HARMONICS * repeats, repeats)
    count = HIGHEST_ORDER * repeats
    spectrum = Spectrum(np.arange(1, count + 1) / repeats, s[:count], F[:count])
    paths += histories(model, period, end_of(paths[-1]), later, wanted[:1])
    largest, smallest = max(path.largest_force for path in paths), min(path.smallest_force for path in paths)
    separated = float(np.mean([path.separated_share for path in paths]))
    back_contact = float(np.mean([path.back_contact_share for path in paths]))
    return Response(s[mesh], x[mesh], F[mesh], largest, smallest, separated, back_contact, spectrum)


def histories(model: TorsionalModel, period: float, state: Floats, repeats: int, phases: Floats) -> list[History]:
    """Histories of consecutive mesh periods from a state (2,) at phase 0. period: of the mesh [s]; repeats: number of
    mesh periods; phases: (k,) that each history has at least."""
    paths: list[History] = []
    for _ in range(repeats):
        paths.append(history(model, period, state, phases))
        state = end_of(paths[-1])
    return paths


def end_of(path: History) -> Floats:
    """State (2,) at the end of a mesh period."""
    return np.array([path.displacement[-1], path.velocity[-1]])


def _amplitudes(values: Floats) -> Floats:
    """Amplitudes (n // 2,) of the spectral lines 1, 2, ... of samples (n,) of one repeat."""
    return np.abs(np.fft.rfft(values)[1:]) * (2.0 / len(values))
