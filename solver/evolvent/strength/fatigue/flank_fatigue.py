"""Fatigue criteria over flank and depth.

All slices have half-ellipses of pressure, so that a history is that of one half-ellipse of peak 1, with the ratio of
friction to pressure and the depth over the half-width: there are few different ones. All criteria but that of Fatemi
and Socie grow in proportion to the peak.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from evolvent.strength.fatigue.criteria import (
    dang_van,
    largest_shear,
    normals_at,
    orthogonal_shear_range,
    plane_amplitudes,
    plane_angles,
    von_mises,
)
from evolvent.strength.fatigue.criterion import (
    BELOW,
    CONTACT_PRESSURE,
    DANG_VAN,
    DEEP,
    FATEMI_SOCIE,
    MAXIMUM_SHEAR,
    ORTHOGONAL_SHEAR,
    SHALLOW,
    TENSION,
    VON_MISES,
    Criterion,
    criteria_of,
)
from evolvent.strength.fatigue.flank_loads import FlankLoads
from evolvent.strength.fatigue.half_plane import HertzTractions, plane_strain
from evolvent_meshes.arrays import Bools, Floats

INNER, OUTER, REACH = 721, 360, 10.0
"""Instants of a history while the point is below the contact, and before as after, up to this distance in half-widths.
With a third of them the criterion of Dang Van, which is the most sensitive, is 0.1 % off."""
COARSER = 3
"""Stride of a history's instants for the criterion of Fatemi and Socie, which is evaluated on many planes."""
RATIOS = 32
"""Steps between no friction and μ, to which the friction of slices that stick in part is rounded."""


@dataclass(frozen=True)
class FatigueMaterial:
    """Material data of a flank for the criteria."""

    poissons_ratio: float
    """Poisson's ratio ν."""
    shear_modulus: float
    """Shear modulus G [MPa]."""
    yield_stress: float | None
    """Yield stress σ_y of the criterion of Fatemi and Socie [MPa]; None leaves it out."""
    tension_factor: float
    """Factor a of the criterion of Dang Van under hydrostatic tension."""
    compression_factor: float
    """Factor a of the criterion of Dang Van under hydrostatic compression."""
    normal_factor: float
    """Factor k of the criterion of Fatemi and Socie."""


@dataclass(frozen=True)
class FlankFatigue:
    """Criteria at n points of a flank and m depths below each."""

    loads: FlankLoads
    """Pressure and friction at the n points."""
    depths: Floats
    """Depths (m,) over the half-width of the contact."""
    values: dict[Criterion, Floats]
    """Values (n, m) of each criterion, in its unit."""

    @property
    def depths_mm(self) -> Floats:
        """Depths (n, m) [mm]."""
        return np.outer(self.loads.half_width, self.depths)

    def at(self, place: str) -> Bools:
        """Whether each depth (m,) belongs to a place. No depth does where `depths` lacks it."""
        if place == BELOW:
            return np.asarray(self.depths >= DEEP)
        return np.isclose(self.depths, SHALLOW.get(place, 0.0), rtol=0.0, atol=1e-9)


def fatigue_of_both(
    loads: FlankLoads, friction: float, depths: Sequence[float], materials: tuple[FatigueMaterial, FatigueMaterial]
) -> tuple[FlankFatigue, FlankFatigue]:
    """Fatigue criteria of the flanks of pinion and wheel, which bear the same tractions, see `flank_fatigue`."""
    pinion, wheel = materials
    first = flank_fatigue(loads, friction, depths, pinion)
    return first, first if wheel == pinion else flank_fatigue(loads, friction, depths, wheel)


def flank_fatigue(
    loads: FlankLoads, friction: float, depths: Sequence[float], material: FatigueMaterial
) -> FlankFatigue:
    """Fatigue criteria of the flank of one gear. friction: μ of the contact solution. depths: over the half-width, 0
    the surface."""
    steps = np.minimum(np.round(loads.friction / max(friction, 1e-300) * RATIOS), RATIOS)
    values = {each: np.zeros((len(loads.peak), len(depths))) for each in criteria_of(material.yield_stress)}
    for step in np.unique(steps):
        here = np.flatnonzero(steps == step)
        for column, depth in enumerate(depths):
            found = _criteria(float(step / RATIOS * friction), depth, loads.peak[here], material)
            for criterion, value in found.items():
                values[criterion][here, column] = value
    return FlankFatigue(loads, np.array(depths), values)


def passage() -> Floats:
    """Places (k,) of the contact over the point, in half-widths: dense where the point enters and leaves it."""
    inside = -np.cos(np.linspace(0.0, np.pi, INNER))
    outside = 1.0 + (REACH - 1.0) * np.linspace(0.0, 1.0, OUTER + 1)[1:] ** 2
    return np.concatenate([-outside[::-1], inside, outside])


def _criteria(ratio: float, depth: float, peaks: Floats, material: FatigueMaterial) -> dict[Criterion, Floats]:
    """Criteria (p,) below contacts of different peaks (p,) [MPa]."""
    unit, shear, normal = _unit_passage(ratio, depth, material)
    values = {criterion: value * peaks for criterion, value in unit.items()}
    if material.yield_stress is not None:
        opened = 1.0 + material.normal_factor * peaks[:, None] * normal / material.yield_stress
        values[FATEMI_SOCIE] = (peaks[:, None] * shear / material.shear_modulus * opened).max(axis=1)
    return values


@lru_cache(maxsize=4096)  # a coarse companion has the same ones again
def _unit_passage(
    ratio: float, depth: float, material: FatigueMaterial
) -> tuple[dict[Criterion, float], Floats, Floats]:
    """Criteria below a contact of peak 1 that grow with the peak; amplitude of shear and tension on planes (a,), empty
    where they are not needed."""
    x, nothing = passage(), np.zeros(0)
    history = plane_strain(HertzTractions(1.0, 1.0, ratio).stress(x, np.full_like(x, depth)), material.poissons_ratio)
    unit = {
        CONTACT_PRESSURE: 1.0 if depth == 0.0 else 0.0,
        ORTHOGONAL_SHEAR: orthogonal_shear_range(history),
        MAXIMUM_SHEAR: float(largest_shear(history).max()),
        VON_MISES: float(von_mises(history).max()),
        DANG_VAN: dang_van(history, material.tension_factor, material.compression_factor),
        TENSION: max(float(history[:, 0, 0].max()), 0.0),
    }
    if material.yield_stress is None:
        return unit, nothing, nothing
    return unit, *plane_amplitudes(history[::COARSER], normals_at(plane_angles()))
