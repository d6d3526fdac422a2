"""Strains of the gauges of a scene, over the rotation of the tooth that they are on."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.fem.material import Material
from evolvent.results.error_bars.compared import Curve
from evolvent.results.tables.table import Table
from evolvent.strength.results.root_curves import value_errors
from evolvent.strength.results.tables import FrictionRoots
from evolvent.strength.strain_gauges import Gauge, gauge_strain
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class GaugeRow:
    """A line of gauges.csv: a gauge at a rotation of its tooth."""

    gauge: int
    """Number of the gauge in the scene, from 1."""
    gear: str
    """pinion or wheel."""
    side: str
    """Flank above the gauge: loaded or back."""
    friction: float
    """Friction coefficient."""
    tooth_rotation_deg: float
    """Pinion rotation of the tooth; 0 where its flanks touch at the pitch point of the mid-face section, above 0 later
    in the engagement."""
    strain_um_per_m: float
    """Mean strain along the profile over the length of the gauge."""
    strain_um_per_m_error: float
    """Estimated error of the strain by the mesh; NaN without a coarse companion."""


GAUGES = Table("gauges.csv", GaugeRow)


def gauge_rows(
    gauges: Sequence[Gauge], found: Sequence[FrictionRoots], materials: tuple[Material, Material]
) -> Iterator[GaugeRow]:
    """Rows of gauges.csv of all gauges at all friction coefficients. Raises InputError where a gauge does not lie on a
    root."""
    for number, gauge in enumerate(gauges, 1):
        material, side = materials[gauge.member], "loaded" if gauge.loaded_side else "back"
        for each in found:
            roots = each.gears[gauge.member]
            strain = 1e6 * gauge_strain(gauge, roots, material)
            errors = _errors(gauge, each, strain, material)
            for angle, value, error in zip(roots.loaded_side.angles, strain, errors):
                yield GaugeRow(
                    gauge=number, gear=gauge.member.label, side=side, friction=each.friction,
                    tooth_rotation_deg=math.degrees(angle), strain_um_per_m=float(value),
                    strain_um_per_m_error=float(error),
                )


def _errors(gauge: Gauge, roots: FrictionRoots, strain: Floats, material: Material) -> Floats:
    if roots.coarse is None:
        return np.full(len(strain), np.nan)
    coarse = roots.coarse[gauge.member]
    rough = Curve(coarse.loaded_side.angles, 1e6 * gauge_strain(gauge, coarse, material))
    return value_errors(Curve(roots.gears[gauge.member].loaded_side.angles, strain), rough, roots.order)
