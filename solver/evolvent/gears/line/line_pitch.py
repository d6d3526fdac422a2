"""A pitch in line contact under one torque, and its figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.line.line_gears import LineGears, LinePosition
from evolvent.gears.line.line_result import LineResult
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True, eq=False)
class LinePitch:
    """Equidistant positions of a pitch under one torque, without friction."""

    gears: LineGears
    """Both gears."""
    results: tuple[LineResult, ...]
    """The positions."""

    @staticmethod
    def of(gears: LineGears, positions: Sequence[LinePosition], force: float) -> LinePitch:
        """The pitch under a force along the line of action, in the transverse section [N; N/mm in the plane].

        Raises NotConverged, TooWide.
        """
        return LinePitch(gears, tuple(LineResult.of(position, force) for position in positions))

    @property
    def transmission_error(self) -> Floats:
        """Transmission error (n,) [mm]."""
        return np.array([result.transmission_error for result in self.results])

    @property
    def stiffness(self) -> Floats:
        """Tangent stiffness (n,) of the mesh [N/mm; N/mm² in the plane]."""
        return np.array([result.equilibrium.stiffness for result in self.results])

    @property
    def on_edges(self) -> Floats:
        """Part (n,) of the load that edges of tips bear."""
        return np.array([result.position.on_edges(result.equilibrium.load) for result in self.results])

    @property
    def peak_pressure(self) -> float:
        """Largest of Hertz' p_0 of all positions [MPa], without edges of tips."""
        return max(result.largest_pressure for result in self.results)

    @property
    def face_load_factor(self) -> float:
        """K_Hβ (ISO 6336-1:2006, 7.2.2): largest force per face width in the layers of the mesh over that of the whole
        face, in the mean over the pitch; 1 in the plane."""
        return float(np.mean([result.layer_load(self.gears.layers) for result in self.results], axis=0).max())
