"""The Hertz estimate of a gear pair's contact stress by Yang et al. 2022, Eq. 3 and 4."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from evidence.checkout import DEMOS
from evolvent.gears.problem.hertz_estimate import HertzEstimate
from evolvent.scene.scene import load_scene

PRINTED = 1788.0
"""Contact stress of the paper's Table 4 [MPa]; Eq. 4 yields another value, with and without its factors."""


@dataclass(frozen=True)
class LoadFactors:
    """Load factors of Yang et al. 2022, Eq. 3, with the values printed there; `LoadFactors.none()` sets them to 1.

    application: K_A.
    dynamic: K_v.
    transverse: K_α.
    face: K_β.
    """

    application: float = 1.25
    dynamic: float = 1.293
    transverse: float = 1.1
    face: float = 1.2257

    @classmethod
    def none(cls) -> LoadFactors:
        """All factors 1: the bare Hertz estimate."""
        return cls(1.0, 1.0, 1.0, 1.0)

    @property
    def product(self) -> float:
        """K = K_A K_v K_α K_β."""
        return self.application * self.dynamic * self.transverse * self.face


def yang_estimate(
    *,
    torque: float,
    face_width: float,
    reference_diameter: float,
    contact_ratio: float,
    teeth_ratio: float,
    base_helix: float,
    pressure_angle: float,
    modulus: float,
    factors: LoadFactors,
) -> float:
    """The paper's Hertz estimate σ_H [MPa], Yang et al. 2022, Eq. 4 as printed:

    σ_H = √{ 2KT1/(B d1² ε_α) · (u+1)/u · 2cos β_b/(sin α_t cos α_t) · 1/[π((1−ν1²)/E1 + (1−ν2²)/E2)] }

    torque: T1 on the pinion [N·mm].
    face_width: B [mm].
    reference_diameter: d1 of the pinion [mm].
    contact_ratio: ε_α.
    teeth_ratio: u = z2/z1.
    base_helix: β_b [rad].
    pressure_angle: transverse α_t at the reference circle [rad].
    modulus: E* [MPa].
    factors: whose product is K.

    The length of contact is the mean one, the curvature that at the reference circle. The paper calls α_t the normal
    pressure angle and d1 a radius; with those meanings its numbers cannot be reproduced.
    """
    load = 2 * factors.product * torque / (face_width * reference_diameter**2 * contact_ratio)
    sine_cosine = np.sin(pressure_angle) * np.cos(pressure_angle)
    curvature = (teeth_ratio + 1) / teeth_ratio * 2 * np.cos(base_helix) / sine_cosine
    return float(np.sqrt(load * curvature * modulus / pi))


def of_pair(estimate: HertzEstimate, factors: LoadFactors) -> float:
    """Contact stress of a scene's pair by Eq. 4 [MPa]."""
    pinion = estimate.pair.pinion
    return yang_estimate(
        torque=estimate.pinion_torque,
        face_width=estimate.pair.face_width,
        reference_diameter=pinion.reference_diameter,
        contact_ratio=estimate.pair.transverse_contact_ratio,
        teeth_ratio=estimate.pair.ratio,
        base_helix=pinion.base_helix_angle,
        pressure_angle=pinion.transverse_pressure_angle,
        modulus=estimate.modulus,
        factors=factors,
    )


def estimates() -> dict[str, float]:
    """Name -> contact stress of Yang's pair [MPa]: by Eq. 4 with and without load factors, by Hertz at the pitch point
    on the mean and on the shortest length of contact."""
    hertz = load_scene(DEMOS / "yang2022.toml").hertz_estimate()
    return {
        "eq_4_MPa": of_pair(hertz, LoadFactors()), "eq_4_without_factors_MPa": of_pair(hertz, LoadFactors.none()),
        "hertz_mean_MPa": float(hertz.peak_pressure(0.0)),
        "hertz_shortest_MPa": float(hertz.peak_pressure(0.0, hertz.line_lengths[0])),
    }
