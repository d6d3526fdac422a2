"""Internal dynamic factor K_v of ISO 6336-1:2006, clause 6, Method B: the pair as a mass on a spring, by its resonance
ratio N, with terms from measurements.

    N ≤ N_S            K_v = 1 + N (C_v1 B_p + C_v2 B_f + C_v3 B_k)        subcritical       (Eqs 13, 14)
    N_S < N ≤ 1.15     K_v = 1 + C_v1 B_p + C_v2 B_f + C_v4 B_k            main resonance    (Eq. 20)
    1.15 < N < 1.5     linear between both                                 intermediate      (Eq. 22)
    N ≥ 1.5            K_v = C_v5 B_p + C_v6 B_f + C_v7                    supercritical     (Eq. 21)

B_p and B_f are effective base pitch and profile deviations times c' over the line load, B_k the part of the
deflection that tip relief leaves. No motion is computed: damping and the stiffness over the pitch do not enter,
superharmonic resonances are in no range of their own, and for the main resonance the standard itself sends to
Method A, as the true factor may be 40 % away.
Method B is meant for (v z_1/100) √(u²/(1 + u²)) above 3 m/s; below, K_v is near 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

from evolvent.gears.problem.iso_stiffness import LIGHT, STEEL, line_load, mesh_stiffness, single_stiffness
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import number, one_of, refuse

Surface = Literal["hardened", "through_hardened", "cast_iron"]

MAIN, SUPERCRITICAL = 1.15, 1.5
"""Resonance ratios at which the main resonance ends and the supercritical range begins."""
COARSE_CLASS = 6
"""Tolerance class from which on tip relief is not counted: B_k = 1."""
SLOW, FAST = 5.0, 10.0
"""Pitch line velocities [m/s] above which running-in takes off no more than a limit, and than a lower one."""


@dataclass(frozen=True)
class Accuracy:
    """Flank accuracy for Method B of K_v. Without both deviations there is no K_v: that of perfect gears, which has B_k
    alone, does not hold for real ones."""

    base_pitch_deviation: float | None = None
    """Base pitch deviation f_pb, the larger of both gears [µm]; None where it is not known."""
    profile_deviation: float | None = None
    """Profile form deviation f_fα, the larger of both gears [µm]; None where it is not known."""
    tolerance_class: int | None = None
    """Tolerance class of ISO 1328-1, the coarser of both gears; None: so fine that tip relief counts, below 6."""
    surface: Surface = "hardened"
    """Surface of the teeth: case or surface hardened, or nitrided; through hardened or normalised; cast iron."""
    endurance: float | None = None
    """Allowable contact stress number σ_Hlim [MPa]; None where it is not known."""

    def __post_init__(self) -> None:
        """Raises InputError for an accuracy that no gear has, and for through hardened teeth without σ_Hlim."""
        _check_limit("base_pitch_deviation", self.base_pitch_deviation, 0.0, "µm")
        _check_limit("profile_deviation", self.profile_deviation, 0.0, "µm")
        _check_limit("endurance", self.endurance, 100.0, "MPa")
        one_of("tolerance_class", self.tolerance_class, (None, *range(1, 13)))
        one_of("surface", self.surface, get_args(Surface))
        if self.surface == "through_hardened" and self.endurance is None:
            wanted = "σ_Hlim, in MPa, for the running-in of through hardened teeth"
            refuse("endurance", wanted, None, "ISO 6336-5 has it")


def _check_limit(name: str, value: float | None, least: float, unit: str) -> None:
    """Raises InputError unless the value is None or a number from `least` on."""
    if value is not None:
        wanted = f"None or a number from {least:g} on, in {unit}"
        number(name, value, wanted, "None where it is not known", lambda n: n >= least)


def running_in(deviation: float, accuracy: Accuracy, velocity: float) -> float:
    """Running-in allowance y_α [µm] of a deviation [µm], at a pitch line velocity [m/s] (clause 8; y_p of the base
    pitch and y_f of the profile are estimated alike, clause 6)."""
    if accuracy.surface == "hardened":
        return min(0.075 * deviation, 3.0)
    if accuracy.surface == "cast_iron":
        return _limited(0.275 * deviation, 22.0, velocity)
    endurance = accuracy.endurance or math.inf
    return _limited(min(160.0 / endurance, 1.0) * deviation, 12800.0 / endurance, velocity)


def _limited(allowance: float, limit: float, velocity: float) -> float:
    """Running-in allowance: above 5 m/s at most the limit, above 10 m/s half of it."""
    if velocity <= SLOW:
        return allowance
    return min(allowance, limit if velocity <= FAST else 0.5 * limit)


def worn_relief(endurance: float) -> float:
    """C_ay [µm], tip relief by running-in of teeth without one (Table of clause 6): 1/18 (σ_Hlim/97 − 18.45)² + 1.5.
    endurance: σ_Hlim [MPa]."""
    return (endurance / 97.0 - 18.45) ** 2 / 18.0 + 1.5


def coefficients(total_contact_ratio: float) -> tuple[float, float, float, float, float, float, float]:
    """C_v1 to C_v7 at ε_γ (Table of clause 6), from 1. Raises ValueError below 1."""
    ε = total_contact_ratio
    if ε < 1.0:
        raise ValueError(f"dynamic factor of ISO 6336-1: wanted a total contact ratio from 1, found {ε:.4g}")
    if ε <= 2.0:
        second, third, fourth, sixth = 0.34, 0.23, 0.90, 0.47
    else:
        second, third, sixth = 0.57 / (ε - 0.3), 0.096 / (ε - 1.56), 0.12 / (ε - 1.74)
        fourth = (0.57 - 0.05 * ε) / (ε - 1.44)
    seventh = 0.75 if ε <= 1.5 else 0.125 * math.sin(math.pi * (ε - 2.0)) + 0.875 if ε <= 2.5 else 1.0
    return 0.32, second, third, fourth, 0.47, sixth, seventh


@dataclass(frozen=True)
class MethodB:
    """Stiffness, resonance speed and line load of a loaded pair for Method B of K_v."""

    single_stiffness: float
    """Single stiffness c' [N/(mm µm)]."""
    mesh_stiffness: float
    """Mesh stiffness c_γα [N/(mm µm)]."""
    resonance_speed: float
    """Resonance speed n_E1 of the pinion [r/min] (Eq. 6)."""
    line_load: float
    """Line load K_A F_t/b [N/mm]."""
    total_contact_ratio: float
    """Total contact ratio ε_γ."""
    pitch_diameter: float
    """Reference diameter d_1 of the pinion [mm]."""
    relief: float
    """Tip relief C_a [µm]: the smaller of both gears, as it has to be at both ends of the path of contact."""
    accuracy: Accuracy
    """Accuracy of the flanks."""

    @property
    def has_factor(self) -> bool:
        """Whether K_v is known: both deviations are."""
        return None not in (self.accuracy.base_pitch_deviation, self.accuracy.profile_deviation)

    @property
    def main_resonance(self) -> tuple[float, float]:
        """Resonance ratios N_S and 1.15 between which the main resonance lies (Eqs 11, 12)."""
        return (0.5 + 0.35 * math.sqrt(min(self.line_load / LIGHT, 1.0)), MAIN)

    @property
    def relief_term(self) -> float:
        """Tip relief term B_k = |1 − c' C_a/(K_A F_t/b)| (Eq. 17)."""
        if (self.accuracy.tolerance_class or 0) >= COARSE_CLASS:
            return 1.0
        return abs(1.0 - self.single_stiffness * self.relief / self.line_load)

    def ratio(self, speed: float) -> float:
        """Resonance ratio N = n_1/n_E1 (Eq. 9). speed: of the pinion [r/min]."""
        return speed / self.resonance_speed

    def factor(self, speed: float) -> float:
        """Dynamic factor K_v at a speed of the pinion [r/min]; NaN where a deviation is not known."""
        deviations = self.accuracy.base_pitch_deviation, self.accuracy.profile_deviation
        if deviations[0] is None or deviations[1] is None:
            return math.nan
        N, (begin, end) = self.ratio(speed), self.main_resonance
        velocity = math.pi * self.pitch_diameter * speed / 60e3
        C_v1, C_v2, C_v3, C_v4, C_v5, C_v6, C_v7 = coefficients(self.total_contact_ratio)
        B_p, B_f = (
            self.single_stiffness * (each - running_in(each, self.accuracy, velocity)) / self.line_load
            for each in (deviations[0], deviations[1])
        )
        if begin >= N:
            return 1.0 + N * (C_v1 * B_p + C_v2 * B_f + C_v3 * self.relief_term)
        resonant = 1.0 + C_v1 * B_p + C_v2 * B_f + C_v4 * self.relief_term
        beyond = C_v5 * B_p + C_v6 * B_f + C_v7
        share = min(max((N - end) / (SUPERCRITICAL - end), 0.0), 1.0)
        return resonant + share * (beyond - resonant)


def method_b(
    pair: GearPair, mass: float, force: float, accuracy: Accuracy, moduli: tuple[float, float] = (STEEL, STEEL)
) -> MethodB:
    """Data of Method B for a pair under a force.

    mass: equivalent one along the line of action [t]; over the face width it is m_red (Eq. 7), of whatever turns
        rigidly with the gears.
    force: K_A times the static force along the line of action in the transverse section [N].
    moduli: of both gears [MPa].
    """
    load = line_load(pair, force)
    single = single_stiffness(pair, load, moduli)
    mesh = mesh_stiffness(single, pair.transverse_contact_ratio)
    speed = 30000.0 / (math.pi * pair.pinion.z) * math.sqrt(mesh / (1e3 * mass / pair.face_width))
    relief = min(gear.modifications.tip_relief_um for gear in pair.gears)
    if accuracy.endurance is not None and all(gear.modifications.tip_relief_um == 0.0 for gear in pair.gears):
        relief = worn_relief(accuracy.endurance)
    return MethodB(
        single, mesh, speed, load, pair.total_contact_ratio, pair.pinion.reference_diameter, relief, accuracy
    )
