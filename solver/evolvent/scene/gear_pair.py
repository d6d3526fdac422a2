"""The GearPair of a scene, with the defaults that are derived from other keys."""

from __future__ import annotations

import math
from dataclasses import replace

from scipy.optimize import brentq

from evolvent.scene.gear_modifications import amount_in_millimetres, modifications_of
from evolvent.scene.schema.errors import NOTHING, InputProblem, shown
from evolvent.scene.schema.gears import ALTERNATIVES, GearSection, PairSection
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.errors import GeometryError, require
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.gear import GearParameters, usual_rack_tip_radius
from evolvent_meshes.gears.gear_geometry import involute_function, thickness_shift
from evolvent_meshes.gears.modifications.modifications import AMOUNTS
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.gears.pair_geometry import tip_alteration

ADDENDUM, DEDENDUM = 1.0, 1.25
"""Addendum and dedendum of the basic rack of ISO 53, profile A, in normal modules."""
HANDS = {"right": 1, "left": -1}
"""Direction of the helix -> its sign."""

SHARED_KEYS = {
    "normal_module": "normal_module_mm",
    "normal_pressure_angle_deg": "normal_pressure_angle_deg",
    "helix_angle_deg": "helix_angle_deg",
    "centre_distance": "centre_distance_mm",
    "contact ratio": "centre_distance_mm",
    "misalignment_um": "misalignment_um",
}
"""Quantity of a GeometryError -> key of [pair]."""
GEAR_KEYS = {
    "z": "teeth",
    "hand": "hand",
    "face_width": "face_width_mm",
    "profile_shift": "profile_shift",
    "tooth_thickness_allowance_um": "tooth_thickness_allowance_um",
    "tip_diameter": "tip_diameter_mm",
    "tip_chamfer_um": "tip_chamfer_um",
    "tip_rounding_um": "tip_rounding_um",
    "root_diameter": "root_diameter_mm",
    "rack_tip_radius": "rack_tip_radius_mm",
    "protuberance_um": "protuberance_um",
    "bore_diameter": "bore_diameter_mm",
    "support_width": "support_width_mm",
    "support_offset": "support_offset_mm",
    "rim_thickness": "rim_thickness_mm",
    "web_thickness": "web_thickness_mm",
    "web_offset": "web_offset_mm",
    "hub_diameter": "hub_diameter_mm",
    **{amount: amount for amount in AMOUNTS},
    "tip_relief_start_diameter": "tip_relief_start_diameter_mm",
    "root_relief_end_diameter": "root_relief_end_diameter_mm",
    "profile_control_diameter": "profile_control_diameter_mm",
    "end_relief_length": "end_relief_length_mm",
}
"""Quantity of a GeometryError -> key of [pinion] or [wheel]."""


class ImpossibleGears(InputError):
    """Error of gears that cannot exist or cannot mesh. problem: what is wrong, in keys of the scene."""

    def __init__(self, problem: InputProblem) -> None:
        super().__init__(str(problem))
        self.problem = problem


def make_pair(pair: PairSection, pinion: GearSection, wheel: GearSection) -> GearPair:
    """The gear pair of a scene. Raises ImpossibleGears for the first reason that is found. Modifications come last, for
    their defaults follow from the pair."""
    sections = {"pinion": pinion, "wheel": wheel}
    distance = centre_distance(pair, pinion, wheel)
    hand = HANDS[pinion.hand or "right"]
    alteration = tip_alteration_of(pair, pinion, wheel, distance)
    gears: dict[str, GearParameters] = {}
    for name, gear, turn in (("pinion", pinion, hand), ("wheel", wheel, -hand)):
        try:
            gears[name] = make_gear(pair, gear, turn, alteration)
        except GeometryError as error:
            raise ImpossibleGears(_in_scene_keys(error, f"{name}.", pair, sections)) from error
    try:
        unmodified = GearPair(gears["pinion"], gears["wheel"], distance, pair.misalignment_um)
    except GeometryError as error:
        raise ImpossibleGears(_in_scene_keys(error, "wheel.", pair, sections)) from error
    return _modified(unmodified, pair, sections)


def _modified(unmodified: GearPair, pair: PairSection, sections: dict[str, GearSection]) -> GearPair:
    """The pair with the modifications of its flanks. Raises ImpossibleGears."""
    modified: list[GearParameters] = []
    for name, gear, start in zip(sections, unmodified.gears, unmodified.active_start_diameters):
        if problem := amount_in_millimetres(name, sections[name], pair.normal_module_mm):
            raise ImpossibleGears(problem)
        try:
            modified.append(replace(gear, modifications=modifications_of(sections[name], gear, start)))
        except GeometryError as error:
            problem = _in_scene_keys(error, f"{name}.", pair, sections)
            if error.key == "tip_relief_start_diameter" and sections[name].tip_diameter_mm is None:
                why = f"(the tip diameter {gear.tip_diameter:.2f} follows from centre distance and profile shift)"
                problem = replace(problem, allowed=f"{problem.allowed} {why}")
            raise ImpossibleGears(problem) from error
    pinion, wheel = modified
    return replace(unmodified, pinion=pinion, wheel=wheel)


def make_gear(pair: PairSection, gear: GearSection, hand: int, alteration: float) -> GearParameters:
    """One gear of a scene, without modifications.

    hand: +1 right, −1 left. alteration: tip alteration coefficient k ≤ 0. Raises GeometryError.
    """
    module = pair.normal_module_mm
    reference = _reference_diameter(pair, gear)
    dedendum = _or(gear.dedendum_coefficient, DEDENDUM) - _generating_shift(pair, gear)
    tip = tip_diameter(pair, gear, alteration)
    root = _or(gear.root_diameter_mm, reference - 2 * module * dedendum)
    return GearParameters(
        z=gear.teeth,
        normal_module=module,
        normal_pressure_angle_deg=pair.normal_pressure_angle_deg,
        helix_angle_deg=pair.helix_angle_deg,
        profile_shift=gear.profile_shift,
        tooth_thickness_allowance_um=gear.tooth_thickness_allowance_um,
        face_width=gear.face_width_mm,
        tip_diameter=tip,
        tip_chamfer_um=gear.tip_chamfer_um,
        tip_rounding_um=gear.tip_rounding_um,
        root_diameter=root,
        rack_tip_radius=_or(gear.rack_tip_radius_mm, _usual_rack_tip(pair, gear, (reference - root) / 2)),
        protuberance_um=gear.protuberance_um,
        hand=hand,
        bore_diameter=_bore_diameter(gear, root),
        support=Support(gear.support_width_mm, gear.support_offset_mm, _is_held_rim(gear)),
        web=_web(gear),
    )


def _is_held_rim(gear: GearSection) -> bool:
    """Whether the body is a rim that is held at its inside."""
    return gear.rim_thickness_mm is not None and gear.web_thickness_mm is None


def _web(gear: GearSection) -> Web | None:
    thickness, rim = gear.web_thickness_mm, gear.rim_thickness_mm
    if thickness is None or rim is None:
        return None
    return Web(thickness, rim, gear.hub_diameter_mm, gear.web_offset_mm)


def _bore_diameter(gear: GearSection, root: float) -> float:
    """Bore diameter [mm], a rim's inner one; root: diameter [mm]. Raises GeometryError for rims that fill the gear."""
    rim = gear.rim_thickness_mm
    if rim is None or not _is_held_rim(gear):
        return _or(gear.bore_diameter_mm, root / 2)
    allowed, remedy = f"below {root / 2:.6g} mm, half of the root diameter", "Give bore_diameter_mm for a thick body."
    require(2 * rim < root, "rim_thickness", rim, allowed, remedy)
    return root - 2 * rim


def tip_diameter(pair: PairSection, gear: GearSection, alteration: float) -> float:
    """Tip diameter d_a [mm]. alteration: tip alteration coefficient k ≤ 0."""
    addendum = gear.profile_shift + _or(gear.addendum_coefficient, ADDENDUM) + alteration
    return _or(gear.tip_diameter_mm, _reference_diameter(pair, gear) + 2 * pair.normal_module_mm * addendum)


def centre_distance(pair: PairSection, pinion: GearSection, wheel: GearSection) -> float:
    """Centre distance a [mm]: the given one, else that without backlash. Raises ImpossibleGears where none exists."""
    if pair.centre_distance_mm is not None:
        return pair.centre_distance_mm
    normal, helix = math.radians(pair.normal_pressure_angle_deg), math.radians(pair.helix_angle_deg)
    angle, shift = math.atan(math.tan(normal) / math.cos(helix)), pinion.profile_shift + wheel.profile_shift
    try:
        working = working_angle(normal, angle, shift / (pinion.teeth + wheel.teeth))
    except ValueError as error:
        allowed = "profile shifts with which the flanks can touch without backlash"
        remedy = "bring the sum of pinion.profile_shift and wheel.profile_shift nearer to 0"
        raise ImpossibleGears(InputProblem("wheel.profile_shift", f"a sum of {shift:g}", allowed, remedy)) from error
    reference = (_reference_diameter(pair, pinion) + _reference_diameter(pair, wheel)) / 2
    return reference * math.cos(angle) / math.cos(working)


def working_angle(normal: float, transverse: float, shift_per_tooth: float) -> float:
    """Working pressure angle α_wt [rad] without backlash, by the equation of `PairGeometry.tight_pressure_angle`.

    normal, transverse: pressure angles α_n and α_t [rad]. shift_per_tooth: (x1 + x2)/(z1 + z2). Raises ValueError where
    no angle from 0 to 60° satisfies the equation.
    """
    wanted, steepest = involute_function(transverse) + 2 * math.tan(normal) * shift_per_tooth, math.radians(60)
    return float(brentq(lambda angle: involute_function(angle) - wanted, 0.0, steepest, xtol=1e-15))


def working_angle_of(pinion: GearParameters, wheel: GearParameters) -> float:
    """Working pressure angle α_wt [rad] of two gears without backlash."""
    shift = (pinion.profile_shift + wheel.profile_shift) / (pinion.z + wheel.z)
    return working_angle(pinion.normal_pressure_angle, pinion.transverse_pressure_angle, shift)


def tip_alteration_of(pair: PairSection, pinion: GearSection, wheel: GearSection, distance: float) -> float:
    """Tip alteration coefficient k ≤ 0 of a scene at this centre distance [mm], see `tip_alteration`."""
    reference = (_reference_diameter(pair, pinion) + _reference_diameter(pair, wheel)) / 2
    return tip_alteration(pinion.profile_shift + wheel.profile_shift, distance - reference, pair.normal_module_mm)


def _usual_rack_tip(pair: PairSection, gear: GearSection, depth: float) -> float:
    """Default tip radius of the rack [mm]: 0.38 m_n, or the full round of a rack tooth if that is less.

    depth: of the rack tooth below the pitch line [mm].
    """
    angle = math.radians(pair.normal_pressure_angle_deg)
    dedendum = depth / pair.normal_module_mm + _generating_shift(pair, gear)
    return usual_rack_tip_radius(pair.normal_module_mm, angle, dedendum)


def _generating_shift(pair: PairSection, gear: GearSection) -> float:
    angle = math.radians(pair.normal_pressure_angle_deg)
    return gear.profile_shift + thickness_shift(gear.tooth_thickness_allowance_um, pair.normal_module_mm, angle)


def _reference_diameter(pair: PairSection, gear: GearSection) -> float:
    return gear.teeth * pair.normal_module_mm / math.cos(math.radians(pair.helix_angle_deg))


def _or(value: float | None, default: float) -> float:
    return default if value is None else value


def _in_scene_keys(
    error: GeometryError, prefix: str, pair: PairSection, sections: dict[str, GearSection]
) -> InputProblem:
    """A GeometryError in terms of the scene: its keys, and the given values where the one found is derived from them.
    """
    remedy = error.remedy[0].lower() + error.remedy[1:].rstrip(".")
    name = error.key
    if name in SHARED_KEYS:
        return _named(f"pair.{SHARED_KEYS[name]}", getattr(pair, SHARED_KEYS[name]), name, error, remedy)
    if "." in name:
        prefix, name = f"{name.split('.')[0]}.", name.split(".")[1]
    gear, scene_key = sections[prefix[:-1]], GEAR_KEYS[name]
    other = scene_key if scene_key == "bore_diameter_mm" else ALTERNATIVES.get(scene_key, scene_key)
    if getattr(gear, scene_key) is None and getattr(gear, other) is not None:
        scene_key = other
    return _named(prefix + scene_key, getattr(gear, scene_key), name, error, remedy)


def _named(key: str, given: object, name: str, error: GeometryError, remedy: str) -> InputProblem:
    """Problem with a given value; a value derived from it is added with its name."""
    same = isinstance(given, (int, float)) and f"{given:.6g}" == error.found
    derived = f"{name.replace('_', ' ')} {error.found}"
    found = shown(given) if same else f"{NOTHING if given is None else shown(given)} (so {derived})"
    return InputProblem(key, found, error.allowed, remedy)
