"""Stiffness of tooth pairs by ISO 6336-1:2006, clause 9, Method B: from the tooth form, without computing the gears.

It is a secant at heavy load, of teeth on solid discs or on rims with webs, per mm of face width.
"""

from __future__ import annotations

import math

from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair

CONSTANT = 0.04723
PER_TOOTH = 0.15551, 0.25791
PER_SHIFT = -0.00635, -0.00193
PER_SHIFT_AND_TOOTH = -0.11654, -0.24188
PER_SHIFT_SQUARED = 0.00529, 0.00182
"""Coefficients C_1 to C_9 of q' [mm µm/N], of the smaller and of the larger gear."""
MEASURED = 0.8
"""Correction factor C_M: measured stiffness over that of the theory."""
LIGHT = 100.0
"""Line load [N/mm] below which the stiffness falls with its fourth root."""
STEEL, LIKE_STEEL = 206e3, 0.05
"""Modulus [MPa] of the steel that the formula is for, and the relative difference up to which another metal counts as
steel."""
THINNEST_WEB, THINNEST_RIM = 0.2, 1.0
"""Least b_s/b and s_R/m_n with which C_R is reckoned."""
SHIFTS = -0.5, 2.0
"""Sums of profile shift coefficients for which the formula is made."""


def flexibility(pair: GearPair) -> float:
    """Least flexibility q' of a tooth pair [mm µm/N]: a polynomial of profile shifts and virtual numbers of teeth."""
    total = CONSTANT
    for i, gear in enumerate(by_size(pair)):
        x, z_n = gear.profile_shift, gear.virtual_teeth
        total += PER_TOOTH[i] / z_n + PER_SHIFT[i] * x + PER_SHIFT_AND_TOOTH[i] * x / z_n + PER_SHIFT_SQUARED[i] * x * x
    return total


def rack_factor(gear: GearParameters) -> float:
    """Basic rack factor C_B = [1 + 0.5 (1.2 − h_fP/m_n)] [1 − 0.02 (20° − α_n)]."""
    return (1.0 + 0.5 * (1.2 - gear.dedendum_coefficient)) * (1.0 - 0.02 * (20.0 - gear.normal_pressure_angle_deg))


def blank_factor(gear: GearParameters) -> float:
    """Gear blank factor C_R = 1 + ln(b_s/b) / (5 e^(s_R/5m_n)) of a gear with a web; 1 of a full ring."""
    if (web := gear.thin_web) is None:
        return 1.0
    width = max(web.thickness / gear.face_width, THINNEST_WEB)
    rim = max(web.rim_thickness / gear.normal_module, THINNEST_RIM)
    return 1.0 + math.log(width) / (5.0 * math.exp(rim / 5.0))


def single_stiffness(pair: GearPair, line_load: float, moduli: tuple[float, float] = (STEEL, STEEL)) -> float:
    """Single stiffness c' = C_M C_R C_B cos β / q' of a tooth pair [N/(mm µm)], C_B the mean of both gears, C_R the
    smaller one: it is meant for a mate that is as stiff or stiffer.

    line_load: K_A F_t/b [N/mm]; below 100 c' is less by (line_load/100)^0.25.
    moduli: of both gears [MPa]. Other metals than steel have c' in proportion to 2 E_1 E_2/(E_1 + E_2).
    """
    racks = 0.5 * (rack_factor(pair.pinion) + rack_factor(pair.wheel))
    blanks = min(blank_factor(pair.pinion), blank_factor(pair.wheel))
    steel = MEASURED * blanks * racks * math.cos(pair.pinion.helix_angle) / flexibility(pair)
    light = min(line_load / LIGHT, 1.0) ** 0.25
    if all(abs(modulus / STEEL - 1.0) <= LIKE_STEEL for modulus in moduli):
        return steel * light
    return steel * light * 2.0 * moduli[0] * moduli[1] / (moduli[0] + moduli[1]) / STEEL


def mesh_stiffness(single: float, transverse_contact_ratio: float) -> float:
    """Mesh stiffness c_γα = c' (0.75 ε_α + 0.25) [N/(mm µm)], mean over the mesh; up to 10 % too much where ε_α is
    below 1.2."""
    return single * (0.75 * transverse_contact_ratio + 0.25)


def line_load(pair: GearPair, force: float) -> float:
    """Line load K_A F_t/b [N/mm], F_t at the reference circle. force: K_A times the static force along the line of
    action in the transverse section [N]."""
    return force * math.cos(pair.pinion.transverse_pressure_angle) / pair.face_width


def stiffnesses(pair: GearPair, force: float, moduli: tuple[float, float]) -> tuple[float, float] | None:
    """Single and mesh stiffness c', c_γα [N/(mm µm)] of a pair under a force, as of `line_load`; None for a pair that
    the formula is not made for."""
    if outside_range(pair) is not None:
        return None
    single = single_stiffness(pair, line_load(pair, force), moduli)
    return single, mesh_stiffness(single, pair.transverse_contact_ratio)


def by_size(pair: GearPair) -> tuple[GearParameters, GearParameters]:
    """The standard's pinion and wheel: the gear with fewer teeth first, of equal ones that with the larger shift."""
    smaller, larger = sorted(pair.gears, key=lambda gear: (gear.z, -gear.profile_shift))
    return smaller, larger


def outside_range(pair: GearPair) -> str | None:
    """Sentence on a profile shift for which the formula of q' is not made, as found and wanted; None where there is
    none."""
    smaller, larger = (gear.profile_shift for gear in by_size(pair))
    if smaller < larger:
        return f"profile shifts {smaller:.3g} of the smaller and {larger:.3g} of the larger gear, wanted not less on it"
    if not SHIFTS[0] <= smaller + larger <= SHIFTS[1]:
        return f"a sum of profile shifts of {smaller + larger:.3g}, wanted {SHIFTS[0]} to {SHIFTS[1]}"
    return None
