"""Strain gauges at the root of a tooth, along the profile, to compare with a measured passage.

A gauge finds the mean strain over its length, not the largest. It lies in a transverse section of the fillet, its
middle where the profile has a given angle to the tooth's centre line.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import LinearNDInterpolator

from evolvent.fem.material import Material
from evolvent.strength.root_passage import GearRoots, RootPassage
from evolvent.strength.root_surface import RootSurface
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member

SAMPLES = 41
"""Points over the length of a gauge."""


@dataclass(frozen=True)
class Gauge:
    """A strain gauge along the profile of a root."""

    member: Member
    """Gear on whose root the gauge is."""
    loaded_side: bool
    """Whether the gauge is below the loaded flank, or below the back."""
    angle: float
    """Angle between the profile's tangent and the tooth's centre line at the middle of the gauge [rad]."""
    height: float
    """Axial position of the gauge, 0 at mid-face [mm]."""
    length: float
    """Length of the gauge along the profile [mm]."""
    number: int = 1
    """Number of the gauge in the scene, from 1, for messages."""


def gauge_strain(gauge: Gauge, roots: GearRoots, material: Material) -> Floats:
    """Mean strain (k,) over the length of a gauge at the rotations of its passage.

    roots: of its gear. Raises InputError where it does not lie on the root's mesh.
    """
    passage = roots.loaded_side if gauge.loaded_side else roots.back_side
    profile = _Profile(passage.root)
    arcs, z = profile.places(gauge), 0.0 if profile.is_plane else gauge.height
    return np.asarray(profile.at(_strain(passage, material), arcs, z).mean(axis=0))


def gauge_places(gauge: Gauge, root: RootSurface) -> Floats:
    """Arc lengths (SAMPLES,) of the points of a gauge from the upper end of a root's profile [mm].

    Raises InputError where it does not lie on the root's mesh.
    """
    return _Profile(root).places(gauge)


@dataclass(frozen=True)
class _Profile:
    """Arc lengths along the profile of a root, from its upper end."""

    root: RootSurface

    @property
    def is_plane(self) -> bool:
        return self.root.surface.points.shape[1] == 2

    @cached_property
    def _arcs(self) -> Floats:
        """Arc lengths (nodes,) [mm] in the transverse sections, which are turned copies of one another: the profile
        falls from the flank, then follows the root circle into the space."""
        x, r = self.root.surface.points, self.root.radii
        θ = np.abs(np.angle(np.exp(1j * (np.arctan2(x[:, 1], x[:, 0]) - self.root.gear.twist * self.root.heights))))
        place, number = np.unique(np.round(np.column_stack([-r, r * θ]), 6), axis=0, return_inverse=True)
        across = place[:, 1] / -place[:, 0]
        points = -place[:, :1] * np.column_stack([np.cos(across), np.sin(across)])
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])[number.ravel()]

    def places(self, gauge: Gauge) -> Floats:
        """Arc lengths (SAMPLES,) of a gauge [mm]. Raises InputError where it leaves the root."""
        order = np.argsort(self._arcs)
        arcs, angles = self._arcs[order], np.maximum.accumulate(self.root.tangent_angles[order])
        middle = float(np.interp(gauge.angle, angles, arcs))
        places = middle + gauge.length * ((np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5)
        low, high = float(self.root.heights.min()), float(self.root.heights.max())
        lies = angles[0] <= gauge.angle <= angles[-1] and places[0] >= 0.0 and places[-1] <= arcs[-1]
        if not lies or not (self.is_plane or low <= gauge.height <= high):
            at, between = f"with angle_deg = {np.degrees(gauge.angle):g}", np.degrees(angles[[0, -1]])
            heights = "" if self.is_plane else f", height_mm from {low:g} to {high:g}"
            raise InputError(
                f"strength.gauges: found strain gauge {gauge.number}, on the {gauge.member.label}, {at}, height_mm = "
                f"{gauge.height:g} and length_mm = {gauge.length:g}; allowed: angle_deg from {between[0]:.1f} to "
                f"{between[1]:.1f}{heights}, all of it on the {arcs[-1]:.2f} mm of the root's mesh; remedy: move it, "
                "or take a shorter one"
            )
        return places

    def at(self, values: Floats, arcs: Floats, z: float) -> Floats:
        """Values (n, k) at arc lengths (n,) and a height, interpolated from nodal ones (nodes, k)."""
        if self.is_plane:
            order = np.argsort(self._arcs)
            return np.stack([np.interp(arcs, self._arcs[order], column[order]) for column in values.T], axis=1)
        between = LinearNDInterpolator(np.column_stack([self._arcs, self.root.heights]), values)
        return np.asarray(between(np.column_stack([arcs, np.full(len(arcs), z)])))


def _strain(passage: RootPassage, material: Material) -> Floats:
    """Strain (nodes, k) along the profile in transverse sections, from the stress of a free surface."""
    n = passage.root.surface.normals[:, :2]
    t = np.zeros((len(n), 3))
    t[:, :2] = np.column_stack([-n[:, 1], n[:, 0]]) / np.linalg.norm(n, axis=1)[:, None]
    E, ν = material.youngs_modulus, material.poissons_ratio
    along = np.einsum("na,knab,nb->nk", t, passage.stress, t)
    trace = np.einsum("knaa->nk", passage.stress)
    return np.asarray(((1.0 + ν) * along - ν * trace) / E)
