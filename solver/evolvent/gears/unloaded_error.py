"""Unloaded transmission error of a gear pair, by the geometry of its exact flanks alone.

One gear stands at its nominal rotation, the other is turned until the flanks just touch. A point of the standing flank
that lies at a distance h along the normal outside of the other one's helicoid (`Flank.project`) touches it after a
rotation by (h − h*)/(r_b cos β_b), because a rotated involute helicoid is a parallel surface: h* = −c(foot) is where
the modified flank lies below the foot. The least rotation of all points is sought on grids over roll length and height,
each around the best point of the one before, for all stands at a time. Tip edges count, so that contact beyond the path
of contact is found.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.kinematics import PairRotation
from evolvent.gears.problem.flank_deviations import FlankCharts
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

POINTS, LAYERS = 161, 41
"""Points of the first search grid, along roll length and height."""
ZOOM_POINTS, ZOOMS = 13, 8
"""Points of each refined search grid along roll length and height, and number of refinements. Each grid is four times
finer than the one before. At a kink of the relief the error is its slope times the last spacing, 1e-3 times 1e-6 mm."""
FEET, FOUND = 12, 1e-12
"""Most steps for the foot on the modified flank, and the change [mm] at which they end: each error is that before times
the flank's slope, below 0.02."""
TEETH, AT_ONCE = 5, 1_000_000
"""Tooth pairs of an angular position, about, and points that are searched at a time."""
STEEPEST = 0.1
"""Largest slope of a gap near its least value. Tooth pairs whose gap on the first grid exceeds the least one by more
than this times the grid's spacing touch nowhere between its points."""


@dataclass(frozen=True, eq=False)
class RigidFlanks:
    """Rigid loaded flanks of both gears, as designed, measured or worn."""

    pair: GearPair
    """Geometry of the gear pair."""
    charts: FlankCharts = (None, None)
    """Deviations of pinion and wheel; None: as designed."""

    @property
    def varies_over_the_face(self) -> bool:
        """Whether transverse sections differ in more than rotation, or are rotated."""
        gears = self.pair.gears
        designed = any(gear.helix_angle or gear.modifications.varies_over_the_face for gear in gears)
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

    def gap(self, facing: Facing, free: Member, roll_length: Floats, z: Floats) -> Floats:
        """Gap (s, p) [mm] along the line of action, in the transverse section, that turning the `free` gear closes, at
        points (s, p) of the other gear's flank; infinite where these do not face the free gear's flank."""
        gap, at, at_z = self.extended_gap(facing, free, roll_length, z)
        flank = Flank(self.pair.gears[free])
        (low, high), half = flank.roll_lengths, 0.5 * flank.gear.face_width
        with np.errstate(invalid="ignore"):
            faces = (at >= low) & (at <= high) & (np.abs(at_z) <= half)
        return np.where(faces, gap, np.inf)

    def extended_gap(
        self, facing: Facing, free: Member, roll_length: Floats, z: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Gap (s, p) [mm] as of `gap`, and roll length and height (s, p) [mm] of the feet on the free gear's flank,
        which goes on beyond its ends with the modification that it has there."""
        flank = Flank(self.pair.gears[free])
        points = self.points(free.mate, roll_length, z) @ facing.turn + facing.shift[:, None]
        foot, foot_z, distance = flank.project(points)
        height = distance - flank.modification(foot, foot_z)
        cosine, sine = np.cos(flank.gear.base_helix_angle), flank.gear.hand * np.sin(flank.gear.base_helix_angle)
        radial, axial = foot + height * cosine, foot_z - height * sine  # of the point itself: it stays
        low, high = flank.roll_lengths
        with np.errstate(invalid="ignore"):
            below, at, at_z = np.zeros_like(height), radial, axial
            for _ in range(FEET):
                last, below = below, -self.depth(free, np.clip(at, low, high), at_z)
                at, at_z = radial - below * cosine, axial + below * sine
                if np.nanmax(np.abs(below - last), initial=0.0) < FOUND:
                    break
        return (height - below) / cosine, at, at_z


def unloaded_error(flanks: RigidFlanks, angles: Floats, free: Member = Member.PINION) -> Floats:
    """Unloaded transmission error e (n,) [mm] at pinion rotations (n,) [rad]: r_b φ that the free gear turns beyond its
    nominal rotation until the flanks just touch; positive where material is missing. NaN where no flanks face each
    other."""
    count = POINTS * (LAYERS if flanks.varies_over_the_face else 1)
    stands = [PairRotation(flanks.pair, float(angle)) for angle in angles]
    size = max(AT_ONCE // (TEETH * count), 1)
    batches = [stands[i : i + size] for i in range(0, len(stands), size)]
    return np.concatenate([_least_gaps(flanks, batch, free) for batch in batches] or [np.zeros(0)])


def _least_gaps(flanks: RigidFlanks, stands: Sequence[PairRotation], free: Member) -> Floats:
    """(n,) least gap [mm] of all tooth pairs at each angular position."""
    number, facing = Facing.of(flanks.pair, stands, free)
    search = _Search(flanks, facing, free)
    least = np.full(len(stands), np.inf)
    np.minimum.at(least, number, search.best)
    search.refine(np.flatnonzero(search.best <= least[number] + STEEPEST * search.spacing))
    np.minimum.at(least, number, search.best)
    return np.where(np.isfinite(least), least, np.nan)


@dataclass(frozen=True, eq=False)
class Facing:
    """Tooth pairs (s,) at some angular positions: transformation from the standing gear's frame to that of the free
    gear."""

    turn: Floats
    """(s, 3, 3) rotation matrices, by which rows of points are multiplied."""
    shift: Floats
    """(s, 3) translations [mm]."""

    @staticmethod
    def of(pair: GearPair, stands: Sequence[PairRotation], free: Member) -> tuple[Ints, Facing]:
        """Tooth pairs (s,) that may touch, with the indices (s,) of their angular positions."""
        touching = [pair.teeth_in_contact(stand.angle) for stand in stands]
        near = [range(min(teeth) - 1, max(teeth) + 2) for teeth in touching]
        parts = [Facing.of_teeth(stand, teeth, free) for stand, teeth in zip(stands, near)]
        turns, shifts = (np.concatenate(each) for each in zip(*((part.turn, part.shift) for part in parts)))
        return np.repeat(np.arange(len(stands)), [len(teeth) for teeth in near]), Facing(turns, shifts)

    @staticmethod
    def of_teeth(stand: PairRotation, teeth: Iterable[int], free: Member) -> Facing:
        """Some tooth pairs at one angular position."""
        offset, turns, shifts = stand.centre(free.mate, 3) - stand.centre(free, 3), [], []
        for tooth in teeth:
            other = stand.rotation(free, 3, tooth)
            turns.append(stand.rotation(free.mate, 3, tooth).T @ other)
            shifts.append(offset @ other)
        return Facing(np.array(turns), np.array(shifts))

    def __getitem__(self, some: Ints) -> Facing:
        return Facing(self.turn[some], self.shift[some])


class _Search:
    """The least gaps of tooth pairs (s,), on grids each finer than the one before; the first is searched at once."""

    def __init__(self, flanks: RigidFlanks, facing: Facing, free: Member) -> None:
        low, high = Flank(flanks.pair.gears[free.mate]).roll_lengths
        half = 0.5 * flanks.pair.face_width if flanks.varies_over_the_face else 0.0
        self.limits, self.zoom = np.array([[low, high], [-half, half]]), (ZOOM_POINTS, ZOOM_POINTS if half else 1)
        self.spacing = (high - low) / (POINTS - 1)
        self._flanks, self._facing, self._free = flanks, facing, free
        every = np.arange(len(facing.shift))
        self._ranges, self.best = np.tile(self.limits, (len(every), 1, 1)), np.full(len(every), np.inf)
        self._step(every, (POINTS, LAYERS if half else 1))

    def refine(self, some: Ints) -> None:
        """Refines the search grids of tooth pairs (t,), each until two grids in a row have not reduced its gap."""
        alike, some = np.zeros(len(self.best), dtype=int), some[np.isfinite(self.best[some])]
        for _ in range(ZOOMS):
            last = self.best[some]
            self._step(some, self.zoom)
            alike[some] = np.where(last - self.best[some] < FOUND, alike[some] + 1, 0)
            some = some[alike[some] < 2]
            if not len(some):
                break

    def _step(self, some: Ints, counts: tuple[int, int]) -> None:
        """Searches one grid of tooth pairs (t,); the next one lies around its best point."""
        low, high = np.moveaxis(self._ranges[some], 2, 0)
        axes = [np.linspace(low[:, i], high[:, i], count, axis=1) for i, count in enumerate(counts)]
        shape = (len(some), *counts)
        grid = [np.broadcast_to(axes[0][:, :, None], shape), np.broadcast_to(axes[1][:, None, :], shape)]
        rho, z = (each.reshape(len(some), -1) for each in grid)
        gap = self._flanks.gap(self._facing[some], self._free, rho, z)
        rows, best = np.arange(len(some)), np.argmin(gap, axis=1)
        self.best[some] = np.minimum(self.best[some], gap[rows, best])
        spacing = np.array([np.ptp(axis, axis=1) / max(count - 1, 1) for axis, count in zip(axes, counts)]).T
        at = np.stack([rho[rows, best], z[rows, best]], axis=-1)
        around = at[:, :, None] + 1.5 * spacing[:, :, None] * np.array([-1.0, 1.0])
        self._ranges[some] = np.clip(around, self.limits[:, :1], self.limits[:, 1:])
