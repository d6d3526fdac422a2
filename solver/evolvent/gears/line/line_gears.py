"""Condensed gears in line contact: from a position of the pinion to the system of its loads per length."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.hertz import line_half_width
from evolvent.fem.material import Material, contact_modulus
from evolvent.gears.gear_model import GearModel
from evolvent.gears.line.face_ends import FaceEnds
from evolvent.gears.line.flank_compliance import FlankCompliance
from evolvent.gears.line.kinked_gap import with_kinks
from evolvent.gears.line.line_compliance import friction_compliance, line_compliance
from evolvent.gears.line.line_equilibrium import WIDEST, LineSystem
from evolvent.gears.line.line_friction import LineFriction, line_friction, sliding_direction
from evolvent.gears.line.line_gap import GapProfile, LineGap, nominal_arcs
from evolvent.gears.line.stations import Stations, stations_at
from evolvent.gears.unloaded_error import RigidFlanks
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

PER_LAYER = 3
"""Stations in the height of a layer of the mesh. Yang's pair with a relief of 60 µm, transmission error off in the
mean by 0.13 % with 2, 0.06 % with 3."""
ROWS = 1.7
"""Half-width w of the half-ellipse over the mean row of the flank's mesh. A narrower one is not carried by the mesh."""
NARROWEST = 0.3
"""Least half-width w near the end of a flank, over that elsewhere."""
LEAST_SHARE = 0.5
"""Least height of a layer at an end of the common face over that of the others."""
MOST_ON_EDGES = 1e-2
"""Largest part of the load that the edges of tips may bear in line contact. Where they bear 3.5 % of it (Yang's pair
without relief), the transmission error is 0.6 % off."""
FITS = 3
"""Fits about the vertex of the one before, over the width of the contact: at a kink the first one moves it."""
LEAST_REACH = 2e-3
"""Least distance between the points through which the gap is fitted, over the relative radius of curvature."""
EDGE_REACH = 2.0
"""Half-widths of the contact from the edge of a tip within which a load counts as borne by it. Resolved contacts have
pressure in the last row of cells before the edge there."""


@dataclass(frozen=True, eq=False)
class LinePosition:
    """A position of a line contact."""

    stations: Stations
    """Stations on the lines."""
    profile: GapProfile
    """Gap across the lines, at the points of the stations."""
    gap: LineGap
    """Least gap at the points of the stations."""
    system: LineSystem
    """Equations for the loads per length."""
    place: Floats
    """(p,) distance of the half-ellipse from the line of flanks without modifications [mm of profile arc], as of
    `LineGap.shift`."""
    width: Floats
    """(p,) half-width w of the half-ellipse at the points [mm]."""
    to_tip: Floats
    """(p,) distance of the points from the nearest edge of a tip [mm of profile arc]."""
    friction: LineFriction | None = None
    """Friction for each unit of its coefficient; None where the gears were prepared without."""

    def rubbing(self, friction: float, holds: Member) -> LinePosition:
        """The position with a friction coefficient. holds: gear whose torque is given."""
        if friction == 0.0:
            return self
        assert self.friction is not None
        B, moment = self.friction.compliance, self.friction.moments[holds]
        system = replace(self.system, B=self.system.B + friction * B, moment=self.system.H + friction * moment)
        return replace(self, system=system)

    def fitted(self, load: Floats) -> LinePosition:
        """The position with gap and curvature fitted over the width of the contact under loads per length (m,)
        [N/mm]."""
        at_points, modulus = self.at_points(load), self.system.modulus
        reach = np.maximum(self.half_width(load), LEAST_REACH * self.profile.radius)
        gap, mean = self.gap, self.stations.mean
        for _ in range(FITS):
            gap = self.profile.fitted(gap.shift, reach)
        nominal = np.asarray(line_half_width(at_points, self.profile.radius, modulus))
        gap = with_kinks(self.profile, gap, self.gap.shift, at_points, nominal, modulus)
        return replace(self, gap=gap, system=replace(self.system, gap=mean(gap.gap), radius=mean(gap.radius)))

    def on_edges(self, load: Floats) -> float:
        """Part of the loads per length (m,) [N/mm] that bear on edges of tips or near to them."""
        return self._part(load, self.bears_on_edge(load))

    def bears_on_edge(self, load: Floats) -> Bools:
        """Points (p,) that bear on the edge of a tip or near to it under loads per length (m,) [N/mm]."""
        half = self.half_width(load)
        return np.asarray((half > 0.0) & (self.gap.edge | (EDGE_REACH * half > self.to_tip)))

    def too_wide(self, load: Floats) -> float:
        """Part of the loads per length (m,) [N/mm] whose contact is wider than the half-ellipse allows, away from edges
        of tips."""
        return self._part(load, (self.half_width(load) > WIDEST * self.width) & ~self.bears_on_edge(load))

    def half_width(self, load: Floats) -> Floats:
        """Half-width b (p,) of the contact at the points [mm], under loads per length (m,) [N/mm]."""
        return np.asarray(line_half_width(self.at_points(load), self.gap.radius, self.system.modulus))

    def at_points(self, load: Floats) -> Floats:
        """Loads per length (p,) at the points [N/mm]. load: (m,) of the stations."""
        return np.asarray((self.stations.hats @ load) / self.stations.point_lengths)

    def _part(self, load: Floats, points: Bools) -> float:
        force = self.stations.hats @ load
        return float(force[points].sum() / force.sum())


@dataclass(frozen=True, eq=False)
class LineGears:
    """Both gears of a pair in line contact."""

    flanks: RigidFlanks
    """Exact flanks of both gears."""
    gears: tuple[FlankCompliance, FlankCompliance]
    """Compliance of pinion and wheel along the flanks' normals."""
    materials: tuple[Material, Material]
    """Materials of pinion and wheel."""
    free: Member
    """Gear that turns under its torque."""
    least_half_width: float = 0.0
    """Least half-width w of the half-ellipse away from the ends of flanks [mm]."""
    driving: Member = Member.PINION
    """Gear that drives."""

    @staticmethod
    def of(model: GearModel, friction: bool = False) -> LineGears:
        """The gears of a model that was condensed for line contact. friction: whether positions are to have some."""
        pinion, wheel = (FlankCompliance.of(body, friction) for body in model.bodies)
        materials, load = (model.bodies[0].material, model.bodies[1].material), model.load
        flanks = RigidFlanks(model.pair, model.charts)
        return LineGears(flanks, (pinion, wheel), materials, load.on, driving=load.driving)

    @property
    def pair(self) -> GearPair:
        """Geometry of the gear pair."""
        return self.flanks.pair

    @property
    def base_radius(self) -> float:
        """Base radius of the gear that turns under its torque [mm]."""
        return self.pair.gears[self.free].base_radius

    @property
    def width_factor(self) -> float:
        """Factor from forces and torques of the line contact to those of the gears: the face width [mm] in the plane,
        else 1."""
        return self.pair.face_width if self.spacing is None else 1.0

    @property
    def spacing(self) -> float | None:
        """Distance of stations along the face [mm]; None in the plane."""
        if len(self.gears[0].heights) == 1:
            return None
        return float(max(np.diff(gear.heights[::2]).max() for gear in self.gears)) / PER_LAYER

    @property
    def layers(self) -> Floats | None:
        """Ends (l + 1,) of thirds of the narrower gear's layers [mm], ascending; parts of a layer shorter than half of
        it are taken together with the next one. None in the plane."""
        if self.spacing is None:
            return None
        heights = min((gear.heights[::2] for gear in self.gears), key=np.ptp)
        half, shortest = 0.5 * self.pair.face_width, LEAST_SHARE * float(np.diff(heights).max())
        ends = np.array([-half, *heights[np.abs(heights) < half - shortest], half])
        parts = ends[:-1, None] + np.diff(ends)[:, None] * np.arange(PER_LAYER) / PER_LAYER
        return np.append(parts.ravel(), half)

    @property
    def half_width(self) -> float:
        """Half-width w of the half-ellipse [mm]."""
        carried = ROWS * float(max(np.diff(gear.arcs[::2]).mean() for gear in self.gears))
        return max(carried, self.least_half_width)

    def position(self, angle: float) -> LinePosition:
        """The gears at a rotation of the pinion [rad]."""
        stations = stations_at(self.pair, angle, self.spacing)
        profile = GapProfile.of(self.flanks, stations, self.free)
        gap = profile.least()
        shift, width = self._carried(stations, gap.shift)
        B = line_compliance(self.pair, self.gears, stations, shift, width)
        L, mean = stations.lengths, stations.mean
        H = L * math.cos(self.pair.pinion.base_helix_angle)
        ends = None if self.spacing is None else FaceEnds.of(self.pair, self.materials, stations)
        modulus = contact_modulus(*self.materials)
        system = LineSystem(B, L, mean(gap.gap), mean(gap.radius), mean(np.log(width)), H, modulus, ends)
        friction = self._friction(stations, shift, width)
        return LinePosition(stations, profile, gap, system, shift, width, self._to_tip(stations, gap.shift), friction)

    def _friction(self, stations: Stations, shift: Floats, width: Floats) -> LineFriction | None:
        """Friction at a position; None where the gears were prepared without. shift, width: of `line_compliance`."""
        if self.gears[0].by_friction is None:
            return None
        direction = sliding_direction(self.pair, stations, self.driving)
        compliance = friction_compliance(self.pair, self.gears, stations, shift, width, direction)
        return line_friction(self.pair, stations, direction, compliance, self.driving)

    def _to_tip(self, stations: Stations, shift: Floats) -> Floats:
        """Distances (p,) from the nearest edge of a tip [mm]. shift: (p,) as of `LineGap`."""
        below, above = (
            gear.arcs[-1] - nominal_arcs(self.pair, member, stations.roll_distance)
            for member, gear in zip((Member.WHEEL, Member.PINION), self.gears[::-1])
        )
        return np.minimum(above - shift, below + shift)

    def _carried(self, stations: Stations, shift: Floats) -> tuple[Floats, Floats]:
        """Distances (p,) of the half-ellipses from the nominal line, towards the pinion's tip, and their half-widths
        (p,) [mm]: near the end of a flank they are narrower, so that they lie on it."""
        w, below, above = self.half_width, np.full(len(shift), np.inf), np.full(len(shift), np.inf)
        for member, gear in zip(Member, self.gears):
            arc = nominal_arcs(self.pair, member, stations.roll_distance)
            ends = arc - gear.arcs[0], gear.arcs[-1] - arc
            below, above = np.minimum(below, ends[member]), np.minimum(above, ends[member.mate])
        place = np.clip(shift, NARROWEST * w - below, above - NARROWEST * w)
        return place, np.clip(np.minimum(above - place, below + place), NARROWEST * w, w)
