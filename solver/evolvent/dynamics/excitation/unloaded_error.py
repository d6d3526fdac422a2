"""Unloaded transmission error of a gear pair, by the geometry of its exact flanks alone.

One gear stands at its nominal rotation, the other is turned until the flanks just touch. A point of the standing flank
that lies at a distance h along the normal outside of the other one's helicoid (`Flank.project`) touches it after a
rotation by (h − h*)/(r_b cos β_b), because a rotated involute helicoid is a parallel surface: h* = −c(foot) is where
the modified flank lies below the foot. The least rotation of all points is sought on grids over roll length and height,
each around the best point of the one before. Tip edges count, so that contact beyond the path of contact is found.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from evolvent.gears.kinematics import Stand
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

POINTS, LAYERS = 161, 41
"""Of the first grid, along roll length and height."""
ZOOM_POINTS, ZOOMS = 13, 8
"""Of the following grids, each way, and how many there are: each is four times finer than the one before. At a kink of
the relief the error is its slope times the last spacing, 1e-3 times 1e-6 mm."""
FEET, FOUND = 12, 1e-12
"""Steps in which the foot on the modified flank is found, at most, and the change [mm] after which it is: each error is
that before times the flank's slope, below 0.02."""
STEEPEST = 0.1
"""Slope that no gap has near its least value. Tooth pairs whose gap on the first grid exceeds the least one by more
than this times the grid's spacing touch nowhere between its points."""


@dataclass(frozen=True, eq=False)
class RigidFlanks:
    """Both loaded flanks as they are made, measured or worn, without deflection."""

    pair: GearPair
    """Both gears and their axes."""
    charts: tuple[FlankChart | None, FlankChart | None] = (None, None)
    """Deviations of pinion and wheel; None: as designed."""

    @property
    def varies_over_the_face(self) -> bool:
        """Whether transverse sections differ in more than rotation, or are rotated."""
        gears = self.pair.gears
        designed = any(gear.helix_angle or gear.modifications.lead_crowning_um for gear in gears)
        charted = any(chart is not None and chart.varies_over_the_face for chart in self.charts)
        return bool(designed or charted or self.pair.misalignment_um)

    def depth(self, member: Member, roll_length: Floats, z: Floats) -> Floats:
        """Material missing from the helicoid (…), along its normal [mm], at roll lengths and heights (…)."""
        gear, chart = self.pair.gears[member], self.charts[member]
        missing = Flank(gear).modification(roll_length, z)
        if chart is None:
            return missing
        return missing + chart.at(gear, roll_length.ravel(), z.ravel()).reshape(roll_length.shape)

    def points(self, member: Member, roll_length: Floats, z: Floats) -> Floats:
        """Points (…, 3) [mm] of tooth 0's flank in the gear's frame."""
        flank = Flank(self.pair.gears[member])
        normal = flank.helicoid_normal(roll_length, z)
        return flank.helicoid_point(roll_length, z) - self.depth(member, roll_length, z)[..., None] * normal

    def gap(self, stand: Stand, tooth: int, free: Member, roll_length: Floats, z: Floats) -> Floats:
        """Gap (…) [mm] along the line of action, in the transverse section, that turning the `free` gear closes, at
        points (…) of the other gear's flank; infinite where these do not face the free gear's flank."""
        standing, flank = free.mate, Flank(self.pair.gears[free])
        R, other = stand.rotation(standing, 3, tooth), stand.rotation(free, 3, tooth)
        space = self.points(standing, roll_length, z) @ R.T + stand.centre(standing, 3)
        foot, foot_z, distance = flank.project((space - stand.centre(free, 3)) @ other)
        height = distance - flank.modification(foot, foot_z)
        cosine, sine = np.cos(flank.gear.base_helix_angle), flank.gear.hand * np.sin(flank.gear.base_helix_angle)
        radial, axial = foot + height * cosine, foot_z - height * sine  # of the point itself: it stays
        (low, high), half = flank.roll_lengths, 0.5 * flank.gear.face_width
        with np.errstate(invalid="ignore"):
            below, at, at_z = np.zeros_like(height), radial, axial
            for _ in range(FEET):
                last, below = below, -self.depth(free, np.clip(at, low, high), at_z)
                at, at_z = radial - below * cosine, axial + below * sine
                if np.nanmax(np.abs(below - last), initial=0.0) < FOUND:
                    break
            facing = (at >= low) & (at <= high) & (np.abs(at_z) <= half)
        return np.where(facing, (height - below) / cosine, np.inf)


def unloaded_error(flanks: RigidFlanks, angles: Floats, free: Member = Member.PINION) -> Floats:
    """e (n,) [mm] at pinion rotations (n,) [rad]: r_b φ that the free gear turns beyond its nominal rotation until the
    flanks just touch; positive where material is missing. NaN where no flanks face each other."""
    return np.array([_least_gap(flanks, Stand(flanks.pair, float(angle)), free) for angle in angles])


def _least_gap(flanks: RigidFlanks, stand: Stand, free: Member) -> float:
    """At one stand, of all tooth pairs."""
    pair = flanks.pair
    touching = pair.teeth_in_contact(stand.angle)
    searches = [_Search(flanks, stand, tooth, free) for tooth in range(min(touching) - 1, max(touching) + 2)]
    first = [search.coarse() for search in searches]
    near = min(first) + STEEPEST * searches[0].spacing
    least = min(search.refined() for search, gap in zip(searches, first) if gap <= near)
    return least if np.isfinite(least) else np.nan


class _Search:
    """The least gap of one tooth pair, on grids each finer than the one before."""

    def __init__(self, flanks: RigidFlanks, stand: Stand, tooth: int, free: Member) -> None:
        low, high = Flank(flanks.pair.gears[free.mate]).roll_lengths
        half = 0.5 * flanks.pair.face_width if flanks.varies_over_the_face else 0.0
        self.limits, self.zoom = np.array([[low, high], [-half, half]]), [ZOOM_POINTS, ZOOM_POINTS if half else 1]
        self.spacing = (high - low) / (POINTS - 1)
        self.ranges, self.counts, self.best = self.limits.copy(), [POINTS, LAYERS if half else 1], np.inf
        self._gap = partial(flanks.gap, stand, tooth, free)

    def coarse(self) -> float:
        """On the first grid [mm]; infinite where the flanks do not face each other."""
        self._step()
        return self.best

    def refined(self) -> float:
        """On all others [mm], until two of them have not made it less."""
        alike = 0
        for _ in range(ZOOMS if np.isfinite(self.best) else 0):
            last = self.best
            self._step()
            alike = alike + 1 if last - self.best < FOUND else 0
            if alike == 2:
                break
        return self.best

    def _step(self) -> None:
        """One grid; the next one lies around its best point."""
        axes = [np.linspace(ends[0], ends[1], count) for ends, count in zip(self.ranges, self.counts)]
        gap = self._gap(*np.meshgrid(*axes, indexing="ij"))
        self.best = min(self.best, float(gap.min()))
        i, j = np.unravel_index(int(np.argmin(gap)), gap.shape)
        spacing = np.array([np.ptp(axis) / max(len(axis) - 1, 1) for axis in axes])
        around = np.array([axes[0][i], axes[1][j]])[:, None] + 1.5 * spacing[:, None] * np.array([-1.0, 1.0])
        self.ranges, self.counts = np.clip(around, self.limits[:, :1], self.limits[:, 1:]), self.zoom
