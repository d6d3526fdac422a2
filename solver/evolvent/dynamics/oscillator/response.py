"""Figures of a motion that repeats with the mesh, or after several meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.oscillator.torsional_model import History, TorsionalModel, history
from evolvent_meshes.arrays import Floats

SAMPLES = 256
"""Of a mesh period, for harmonics."""
HARMONICS = 5
IN_RMS = 3
"""Harmonics in the equivalent amplitude of Kahraman and Blankenship's measurements (He et al. 2022, Eq. 14)."""


@dataclass(frozen=True, eq=False)
class Response:
    """A motion at one speed."""

    total: Floats
    """(5,) amplitudes of the mesh harmonics of s, the dynamic transmission error with the unloaded one in it [mm]."""
    elastic: Floats
    """(5,) of s − e [mm]."""
    force: Floats
    """(5,) of the mesh force [N]."""
    largest_force: float
    """[N]."""
    smallest_force: float
    """[N]; below 0 where back flanks press, or the damper pulls."""
    apart: float
    """Share of the time out of contact."""
    behind: float
    """Share of the time on the back flanks."""

    @property
    def equivalent_amplitude(self) -> float:
        """√ΣA_r² of the first three harmonics of s [mm]; the rms of such a motion is 1/√2 of it."""
        return float(np.linalg.norm(self.total[:IN_RMS]))

    @property
    def elastic_equivalent_amplitude(self) -> float:
        """The same of s − e [mm]."""
        return float(np.linalg.norm(self.elastic[:IN_RMS]))


def response(model: TorsionalModel, period: float, state: Floats, repeats: int = 1) -> Response:
    """Of the motion from a state (2,) at phase 0, over the mesh periods [s] after which it repeats."""
    wanted = np.arange(SAMPLES) / SAMPLES
    paths: list[History] = []
    for _ in range(repeats):
        paths.append(history(model, period, state, wanted))
        state = np.array([paths[-1].displacement[-1], paths[-1].velocity[-1]])
    at = np.searchsorted(paths[0].phases, wanted - 1e-12)
    total, error, force = (
        np.concatenate([getattr(path, name)[at] for path in paths]) for name in ("displacement", "error", "force")
    )
    forces = np.concatenate([path.force for path in paths])
    s, x, F = (_amplitudes(values, repeats) for values in (total, total - error, force))
    apart, behind = (float(np.mean([getattr(path, name) for path in paths])) for name in ("apart", "behind"))
    return Response(s, x, F, float(forces.max()), float(forces.min()), apart, behind)


def _amplitudes(values: Floats, repeats: int) -> Floats:
    """(5,) of the mesh harmonics of values that repeat after so many meshes."""
    return np.abs(np.fft.rfft(values)[repeats : HARMONICS * repeats + 1 : repeats]) * (2.0 / len(values))
