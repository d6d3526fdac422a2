"""Figures of a line contact in equilibrium: forces of the tooth pairs, load over heights, peak pressure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.hertz import line_half_width, line_peak_pressure
from evolvent.gears.line.line_equilibrium import WIDEST, LineEquilibrium, line_equilibrium
from evolvent.gears.line.line_gears import LinePosition
from evolvent.gears.pressure.relief_starts import ContactWidth, covering, kinks
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import ResultError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

FACE_LOAD_OFF, PRESSURE_OFF = 1e-2, 2e-2
"""Parts by which K_Hβ and p_0 of a line contact are off beside the error of its meshes (docs/line_contact.md)."""
MOST_TOO_WIDE = 1e-2
"""Largest part of the load whose contact may be too wide for the half-ellipse."""


class EdgeContact(ResultError):
    """Error for gears in line contact that bear on edges of tips."""


class TooWide(ResultError):
    """Error for a contact that is too wide for the meshes of a line contact."""


@dataclass(frozen=True, eq=False)
class LineResult:
    """A position of a line contact under one torque; per mm of face width in the plane."""

    position: LinePosition
    """The position, under any torque."""
    equilibrium: LineEquilibrium
    """Loads per length in equilibrium with the torque."""
    cosine: float
    """cos β_b: height over length of the contact lines."""
    friction: float = 0.0
    """Friction coefficient μ."""

    @staticmethod
    def of(
        position: LinePosition, force: float, friction: float = 0.0, holds: Member = Member.PINION
    ) -> LineResult:
        """The position under a torque over the base radius of its gear [N; N/mm in the plane], without friction the
        force along the line of action in the transverse section.

        friction: coefficient μ; where it is not 0 the position is of gears that were prepared with friction.
        holds: gear whose torque is given; without friction it makes no difference.

        Raises NotConverged, TooWide.
        """
        rubbing = position.rubbing(friction, holds)
        there = rubbing.fitted(line_equilibrium(rubbing.system, force).load)
        found, system = line_equilibrium(there.system, force), there.system
        if (part := there.too_wide(found.load)) > MOST_TOO_WIDE:
            raise TooWide(
                f"line contact: wanted a contact of at most {WIDEST:g} times the width on which the meshes carry its "
                f"load, found a wider one under {100 * part:.2g} % of the load; lower the torque, or resolve the "
                'contact (mesh.level = "quick")'
            )
        return LineResult(there, found, float((system.H / system.length)[0]), friction)

    @property
    def forces(self) -> tuple[float, float]:
        """Torques of pinion and wheel over their base radii [N; N/mm in the plane]."""
        q, H, friction = self.equilibrium.load, self.position.system.H, self.position.friction
        if friction is None or self.friction == 0.0:
            return float(H @ q), float(H @ q)
        pinion, wheel = (float((H + self.friction * moment) @ q) for moment in friction.moments)
        return pinion, wheel

    @property
    def friction_power(self) -> float:
        """Power lost to friction per rad/s of pinion speed [N·mm; per mm of width in the plane]."""
        sliding = self.position.friction
        return 0.0 if sliding is None else self.friction * float(sliding.sliding @ self.equilibrium.load)

    @property
    def teeth(self) -> list[int]:
        """Tooth pairs with a contact line, ascending."""
        return [int(tooth) for tooth in np.unique(self.position.stations.tooth)]

    def force(self, tooth: int) -> float:
        """Normal force of a tooth pair [N; N/mm in the plane]."""
        stations = self.position.stations
        return float((stations.lengths * self.equilibrium.load)[stations.tooth == tooth].sum())

    def force_below(self, tooth: int, heights: Floats) -> Floats:
        """Normal force (k,) [N] of a tooth pair below heights (k,) [mm], in space. Exact: loads are linear between the
        stations."""
        stations = self.position.stations
        own = stations.tooth == tooth
        z, q = stations.z[own], self.equilibrium.load[own]
        whole = np.append(0.0, np.cumsum(0.5 * (q[1:] + q[:-1]) * np.diff(z)))
        at = np.clip(heights, z[0], z[-1])
        i = np.clip(np.searchsorted(z, at, side="right") - 1, 0, len(z) - 2)
        slope = (q[i + 1] - q[i]) / (z[i + 1] - z[i])
        step = at - z[i]
        return np.asarray((whole[i] + step * (q[i] + 0.5 * slope * step)) / self.cosine)

    @property
    def peak_pressure(self) -> Floats:
        """Hertz' p_0 (m,) [MPa] of the stations' loads per length, with the relative radii of curvature there."""
        system = self.position.system
        return np.asarray(line_peak_pressure(self.equilibrium.load, system.radius, system.modulus))

    def largest_pressure(self, pair: GearPair) -> float:
        """Largest p_0 [MPa] of stations that neither bear on the edge of a tip nor cover the start of a linear relief,
        whose pressure is not Hertz'; 0 where none is left."""
        position, load = self.position, self.equilibrium.load
        ξ, radius = position.stations.roll_distance, position.profile.radius  # over a kink the fitted one is another
        half = np.asarray(line_half_width(position.at_points(load), radius, position.system.modulus))
        contact = ContactWidth(ξ, half, radius, np.zeros((len(ξ), 2)))
        other = position.bears_on_edge(load) | covering(kinks(pair), contact)
        return float(np.where(position.stations.mean(other.astype(float)) > 0.0, 0.0, self.peak_pressure).max())

    def layer_load(self, layers: Floats | None) -> Floats:
        """Load per face width (l,) of all tooth pairs in layers over that of the whole face. layers: their ends
        (l + 1,) [mm]; None in the plane, which has one."""
        if layers is None:
            return np.ones(1)
        force = np.sum([np.diff(self.force_below(tooth, layers)) for tooth in self.teeth], axis=0)
        return np.asarray(force / np.sum(force) * (layers[-1] - layers[0]) / np.diff(layers))

    @property
    def transmission_error(self) -> float:
        """Transmission error r_b1 φ_1 − r_b2 φ_2 [mm]."""
        return self.equilibrium.approach
