"""Start of a resolved position from the line contact of the same condensed gears.

A position is solved by Newton's method on the points in contact, and its flanks are searched at rotations of the gears
that have to be those of the equilibrium. Line contact gives both beforehand, without the position before: the rotation
from the transmission error, the points from Hertz' half-width b at each load per length. The flanks carry the loads on
a half-ellipse that their meshes carry; flanks in levels do so on their coarse sector.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from evolvent.contact.hertz import line_half_width
from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.line.flank_compliance import FlankCompliance
from evolvent.gears.line.line_gears import MOST_ON_EDGES, LineGears
from evolvent.gears.line.line_result import LineResult, TooWide
from evolvent.gears.problem.hertz_estimate import HertzEstimate
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.unloaded_error import RigidFlanks
from evolvent_meshes.arrays import Bools, Floats, Ints

MOST_NODES = 4500
"""Largest number of nodes of a flank whose compliance along the normals is kept: 160 MB a gear and rank."""
WIDER = 2.0
"""Least half-width of the half-ellipse over Hertz' under evenly spread load. Where meshes are finer, the contact would
be wider than it."""
FAINT = 0.2
"""Half-width of the contact over the largest one below which a point is taken not to bear at first, as at the ends of
lines: of Yang's pair at level standard, Newton's method takes 7.0 iterations in the mean so, 8.0 from all points."""
SURELY = 0.8
"""Part of its distance from the nominal line to which a contact surely reaches. It reaches 0.76 to 1.0 of it, as loads
turn the flanks, so that contacts lie up to a fifth of their width beside the least gap."""


@dataclass(frozen=True, eq=False)
class LineStart:
    """Line contact of a position as a guess of the resolved one (`PositionStart`)."""

    result: LineResult
    """Line contact under the torque of the position."""
    beyond_nominal: tuple[float, float]
    """Rotations of pinion and wheel beyond the nominal ones [rad]."""

    @property
    def reach(self) -> float:
        """Distance from the contact lines of flanks without modifications to which the contact reaches, with some
        certainty [mm of profile arc]."""
        position = self.result.position
        half = position.half_width(self.result.equilibrium.load)
        return SURELY * float(np.max(np.where(half > 0.0, np.abs(position.gap.shift) + half, 0.0)))

    def pressed(self, tooth: Ints, z: Floats, across: Floats) -> Bools:
        """Points (q,) bool within Hertz' half-width of the place where the gap across the line is least, see
        `PositionStart.pressed`."""
        half, centre = np.zeros(len(tooth)), np.zeros(len(tooth))
        for line in self.result.teeth:
            on = tooth == line
            half[on], centre[on] = self._half_widths(line, z[on])
        return np.asarray((half > FAINT * half.max()) & (np.abs(across - centre) < half))

    def _half_widths(self, tooth: int, z: Floats) -> tuple[Floats, Floats]:
        """Half-width of the contact of a tooth pair, 0 beyond the ends of its line, and distance of its centre from the
        line of flanks without modifications (q,) [mm of profile arc], at heights (q,) [mm]."""
        position, load = self.result.position, self.result.equilibrium.load
        stations, gap = position.stations, position.gap
        of, at = stations.tooth == tooth, stations.point_tooth == tooth
        q = np.interp(z, stations.z[of], load[of], left=0.0, right=0.0)
        shift, radius = (np.interp(z, stations.point_z[at], values[at]) for values in (gap.shift, gap.radius))
        return np.asarray(line_half_width(q, radius, position.system.modulus)), shift


class LineStarts:
    """Starts of positions of a gear pair.

    bodies: condensed pinion and wheel, for resolved contact.
    """

    def __init__(self, bodies: tuple[GearBody, GearBody]) -> None:
        self._bodies = bodies

    def __call__(self, model: GearModel, angle: float) -> LineStart | None:
        """Start of a position at a rotation of the pinion [rad], under the load of the model.

        model: of the same condensed gears, under any load and misalignment.

        None where the contact is none along lines, as edges of tips bear or it is too wide, and where flanks have worn.
        """
        if any(body.worn is not own.worn for body, own in zip(model.bodies, self._bodies)):
            return None
        try:
            result = LineResult.of(self._gears(model, angle).position(angle), model.load.at(angle) / model.base_radius)
        except (NotConverged, TooWide):
            return None
        if result.position.on_edges(result.equilibrium.load) > MOST_ON_EDGES:
            return None
        on = model.load.on
        stand = PairRotation(model.pair, angle).turned(on, result.transmission_error / model.base_radius)
        return LineStart(result, stand.beyond_nominal)

    def _gears(self, model: GearModel, angle: float) -> LineGears:
        materials = self._bodies[0].material, self._bodies[1].material
        torque = model.load.at(angle) * model.width_factor * model.pair.pinion.base_radius / model.base_radius
        estimate = HertzEstimate.of(model.pair, materials, torque)
        widest = float(np.max(estimate.half_width(np.linspace(*model.pair.path_of_contact, 20))))
        return LineGears(
            RigidFlanks(model.pair, model.charts), self._compliances, materials, model.load.on,
            WIDER * widest,
        )

    @cached_property
    def _compliances(self) -> tuple[FlankCompliance, FlankCompliance]:
        pinion, wheel = (FlankCompliance.of(body.coarse) for body in self._bodies)
        return pinion, wheel


def with_line_starts(model: GearModel) -> GearModel:
    """The gears, with positions that start from line contact where it is resolved and their flanks can carry loads per
    length: on cells of second order in rows and layers, `MOST_NODES` nodes at most."""
    if model.is_line or not all(map(_carries, model.bodies)):
        return model
    return replace(model, starts=LineStarts(model.bodies))


def _carries(body: GearBody) -> bool:
    body = body.coarse
    rows_and_layers = (body.flank.shape, body.flank.order) in (("interval", 2), ("quadrilateral", 2))
    return rows_and_layers and isinstance(body.chain, ChainedCompliance) and len(body.flank.points) <= MOST_NODES
