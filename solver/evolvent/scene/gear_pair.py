"""From the scene's sections to a GearPair, with the defaults that depend on the geometry."""

from __future__ import annotations

import math

from scipy.optimize import brentq

from evolvent.scene.schema.core import ALTERNATIVES, Gear, Pair
from evolvent.scene.schema.errors import NOTHING, Problem, shown
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.errors import GeometryError
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.gear_geometry import Modifications, involute_function
from evolvent_meshes.gears.pair import GearPair

ADDENDUM, DEDENDUM, RACK_TIP_RADIUS = 1.0, 1.25, 0.38
"""ISO 53 profile A, in normal modules."""
HANDS = {"right": 1, "left": -1}

SHARED_KEYS = {
    "normal_module": "normal_module_mm",
    "normal_pressure_angle_deg": "normal_pressure_angle_deg",
    "helix_angle_deg": "helix_angle_deg",
    "centre_distance": "centre_distance_mm",
    "contact ratio": "centre_distance_mm",
    "misalignment_um": "misalignment_um",
}
GEAR_KEYS = {
    "z": "teeth",
    "hand": "hand",
    "face_width": "face_width_mm",
    "profile_shift": "profile_shift",
    "tip_diameter": "tip_diameter_mm",
    "root_diameter": "root_diameter_mm",
    "rack_tip_radius": "rack_tip_radius_mm",
    "bore_diameter": "bore_diameter_mm",
    "tip_relief_um": "tip_relief_um",
    "tip_relief_start_diameter": "tip_relief_start_diameter_mm",
    "lead_crowning_um": "lead_crowning_um",
}


class ImpossibleGears(InputError):
    """The gears of a scene can't exist or can't mesh; carries the Problem in the scene's own keys."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(str(problem))
        self.problem = problem


def make_pair(pair: Pair, pinion: Gear, wheel: Gear) -> GearPair:
    """The gear pair of a scene. Raises ImpossibleGears."""
    sections = {"pinion": pinion, "wheel": wheel}
    distance = centre_distance(pair, pinion, wheel)
    hand = HANDS[pinion.hand or "right"]
    gears: dict[str, GearParameters] = {}
    for name, gear, turn in (("pinion", pinion, hand), ("wheel", wheel, -hand)):
        try:
            gears[name] = make_gear(pair, gear, turn, tip_shortening(pair, pinion, wheel, distance))
        except GeometryError as error:
            raise ImpossibleGears(_in_scene_keys(error, f"{name}.", pair, sections)) from error
    try:
        return GearPair(gears["pinion"], gears["wheel"], distance, pair.misalignment_um)
    except GeometryError as error:
        raise ImpossibleGears(_in_scene_keys(error, "wheel.", pair, sections)) from error


def make_gear(pair: Pair, gear: Gear, hand: int, shortening: float) -> GearParameters:
    """One gear; hand is +1 (right) or −1 (left), shortening Δy in normal modules. Raises GeometryError."""
    module = pair.normal_module_mm
    reference = _reference_diameter(pair, gear)
    addendum = gear.profile_shift + _or(gear.addendum_coefficient, ADDENDUM) - shortening
    dedendum = _or(gear.dedendum_coefficient, DEDENDUM) - gear.profile_shift
    tip = _or(gear.tip_diameter_mm, reference + 2 * module * addendum)
    root = _or(gear.root_diameter_mm, reference - 2 * module * dedendum)
    return GearParameters(
        z=gear.teeth,
        normal_module=module,
        normal_pressure_angle_deg=pair.normal_pressure_angle_deg,
        helix_angle_deg=pair.helix_angle_deg,
        profile_shift=gear.profile_shift,
        face_width=gear.face_width_mm,
        tip_diameter=tip,
        root_diameter=root,
        rack_tip_radius=_or(gear.rack_tip_radius_mm, _usual_rack_tip(pair, gear, (reference - root) / 2)),
        hand=hand,
        bore_diameter=_or(gear.bore_diameter_mm, root / 2),
        modifications=Modifications(
            tip_relief_um=gear.tip_relief_um,
            tip_relief_start_diameter=_or(gear.tip_relief_start_diameter_mm, tip - module),
            tip_relief_parabolic=gear.tip_relief_form == "parabolic",
            lead_crowning_um=gear.lead_crowning_um,
        ),
    )


def centre_distance(pair: Pair, pinion: Gear, wheel: Gear) -> float:
    """a [mm] as given, else that without backlash. Raises ImpossibleGears if there is none."""
    if pair.centre_distance_mm is not None:
        return pair.centre_distance_mm
    normal, helix = math.radians(pair.normal_pressure_angle_deg), math.radians(pair.helix_angle_deg)
    angle, shift = math.atan(math.tan(normal) / math.cos(helix)), pinion.profile_shift + wheel.profile_shift
    try:
        working = working_angle(normal, angle, shift / (pinion.teeth + wheel.teeth))
    except ValueError as error:
        allowed = "profile shifts with which the flanks can touch without backlash"
        remedy = "bring the sum of pinion.profile_shift and wheel.profile_shift nearer to 0"
        raise ImpossibleGears(Problem("wheel.profile_shift", f"a sum of {shift:g}", allowed, remedy)) from error
    reference = (_reference_diameter(pair, pinion) + _reference_diameter(pair, wheel)) / 2
    return reference * math.cos(angle) / math.cos(working)


def working_angle(normal: float, transverse: float, shift_per_tooth: float) -> float:
    """α_wt [rad] without backlash: inv α_wt = inv α_t + 2 tan α_n (x1 + x2)/(z1 + z2) (ISO 21771, 5.5).

    normal α_n and transverse α_t pressure angle [rad]. Raises ValueError if no angle from 0 to 60° satisfies that.
    """
    wanted, steepest = involute_function(transverse) + 2 * math.tan(normal) * shift_per_tooth, math.radians(60)
    return float(brentq(lambda angle: involute_function(angle) - wanted, 0.0, steepest, xtol=1e-15))


def working_angle_of(pinion: GearParameters, wheel: GearParameters) -> float:
    """α_wt [rad] of two gears without backlash."""
    shift = (pinion.profile_shift + wheel.profile_shift) / (pinion.z + wheel.z)
    return working_angle(pinion.normal_pressure_angle, pinion.transverse_pressure_angle, shift)


def tip_shortening(pair: Pair, pinion: Gear, wheel: Gear, distance: float) -> float:
    """Δy = x1 + x2 − (a − a0)/m_n ≥ 0: by how many modules the tips stay short so that the clearance is the racks'."""
    reference = (_reference_diameter(pair, pinion) + _reference_diameter(pair, wheel)) / 2
    shift = pinion.profile_shift + wheel.profile_shift
    return max(0.0, shift - (distance - reference) / pair.normal_module_mm)


def _usual_rack_tip(pair: Pair, gear: Gear, depth: float) -> float:
    """0.38 m_n, or the full round of a rack tooth of this depth [mm] below the pitch line."""
    angle = math.radians(pair.normal_pressure_angle_deg)
    half_space = pair.normal_module_mm * (math.pi / 4 - gear.profile_shift * math.tan(angle))
    full_round = (half_space - depth * math.tan(angle)) * math.cos(angle) / (1 - math.sin(angle))
    return max(0.0, min(RACK_TIP_RADIUS * pair.normal_module_mm, (1 - 1e-9) * full_round))


def _reference_diameter(pair: Pair, gear: Gear) -> float:
    return gear.teeth * pair.normal_module_mm / math.cos(math.radians(pair.helix_angle_deg))


def _or(value: float | None, default: float) -> float:
    return default if value is None else value


def _in_scene_keys(error: GeometryError, prefix: str, pair: Pair, sections: dict[str, Gear]) -> Problem:
    """A GeometryError in the words of the scene: its keys, and its values where the found one was derived."""
    remedy = error.remedy[0].lower() + error.remedy[1:].rstrip(".")
    name = error.key
    if name in SHARED_KEYS:
        return _named(f"pair.{SHARED_KEYS[name]}", getattr(pair, SHARED_KEYS[name]), name, error, remedy)
    if "." in name:
        prefix, name = f"{name.split('.')[0]}.", name.split(".")[1]
    gear, own = sections[prefix[:-1]], GEAR_KEYS[name]
    if getattr(gear, own) is None and getattr(gear, ALTERNATIVES.get(own, own)) is not None:
        own = ALTERNATIVES[own]
    return _named(prefix + own, getattr(gear, own), name, error, remedy)


def _named(key: str, given: object, name: str, error: GeometryError, remedy: str) -> Problem:
    """The given value is what was found; a derived one is added behind it with its name."""
    same = isinstance(given, (int, float)) and f"{given:.6g}" == error.found
    derived = f"{name.replace('_', ' ')} {error.found}"
    found = shown(given) if same else f"{NOTHING if given is None else shown(given)} (so {derived})"
    return Problem(key, found, error.allowed, remedy)
