"""Nominal tooth root stress σ_F0 of a gear pair under its static torque: ISO 6336-3, Method B, and Zhang et al. 2023.

No application, dynamic, face and transverse load factor: these multiply it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from evolvent.strength.standard.contact_points import ContactPoint, contact_points
from evolvent.strength.standard.critical_section import CriticalSection, root_section
from evolvent.strength.standard.factors import (
    EDITIONS,
    Edition,
    deep_tooth_factor,
    helix_angle_factor,
    load_distribution_factor,
    rim_thickness_factor,
)
from evolvent.strength.standard.load_sharing import pedrero_share
from evolvent.strength.standard.tooth_form import ToothForm, load_point
from evolvent.strength.standard.virtual_gear import virtual_contact_ratio
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import one_of

TOLERANCE_CLASSES = tuple(range(1, 13))
"""Tolerance classes of ISO 1328-1."""
FINE, ROUNDS = 400, 3
"""Points of the flank among which the largest stress is sought, and how often the best one's surroundings are."""


@dataclass(frozen=True)
class StandardStress:
    """Nominal tooth root stress σ_F0 and its factors."""

    stress: float
    """Nominal tooth root stress σ_F0 [MPa]."""
    form_factor: float
    """Form factor Y_F, in 2019 with f_ε."""
    stress_correction_factor: float
    """Stress correction factor Y_S."""
    helix_angle_factor: float
    """Helix angle factor Y_β."""
    deep_tooth_factor: float
    """Deep tooth factor Y_DT; 1 in 2019."""
    rim_thickness_factor: float
    """Rim thickness factor Y_B; 1 of a gear without a rim."""
    form: ToothForm
    """Tooth form and point of load."""


@dataclass(frozen=True)
class PointStress:
    """Tooth root stress with the load at one point of the flank."""

    name: str
    """Name of the point of load."""
    below_tip: float
    """Distance of the point from the tip along the line of action, in base pitches."""
    share: float
    """Part of the load that the tooth bears."""
    stress: float
    """Nominal tooth root stress [MPa]."""
    form: ToothForm
    """Tooth form and point of load."""


@dataclass(frozen=True)
class RootLoad:
    """Load on the tooth root of one gear of a pair."""

    pair: GearPair
    """Gear pair."""
    member: Member
    """Gear of the root."""
    pinion_torque: float
    """Torque of the pinion [N·mm]."""

    @property
    def section(self) -> CriticalSection:
        """Critical section of the root."""
        return root_section(self.pair.gears[self.member])

    @property
    def contact_ratio(self) -> float:
        """Contact ratio ε_αn of the virtual gears."""
        return virtual_contact_ratio(self.pair)

    @property
    def tangential_force(self) -> float:
        """Tangential force F_t = 2 T_1/d_1 at the reference circle [N]."""
        return 2.0 * self.pinion_torque / self.pair.pinion.reference_diameter

    @property
    def face_stress(self) -> float:
        """Stress F_t/(b m_n) [MPa]; b is the common face width."""
        return self.tangential_force / (self.pair.face_width * self.pair.pinion.normal_module)

    @property
    def outer_point(self) -> ContactPoint:
        """Point next to the tip among those with the fewest pairs in contact: the outer point of single contact, or
        b."""
        points = contact_points(self.contact_ratio)
        return min(points, key=lambda point: (point.pairs, point.below_tip))

    @property
    def rim_factor(self) -> float:
        """Y_B of a gear with a rim, held at its inside or on a web; 1 of others.

        Raises InputError for rims that the standard does not cover.
        """
        gear = self.pair.gears[self.member]
        height = 0.5 * (gear.tip_diameter - gear.root_diameter)
        return rim_thickness_factor(gear.rim_thickness, height, self.member.label) if gear.has_rim else 1.0

    def tooth_rotation(self, below_tip: float) -> float:
        """Pinion rotation [rad] of a spur tooth that is loaded at a point, 0 at the pitch point; NaN for helical gears,
        whose virtual gear is another one. below_tip: as of `form_at`."""
        if self.pair.pinion.helix_angle_deg > 0.0:
            return math.nan
        (start, end), pitch = self.pair.path_of_contact, self.pair.pinion.transverse_base_pitch
        ξ = end - below_tip * pitch if self.member is Member.PINION else start + below_tip * pitch
        return ξ / self.pair.pinion.base_radius

    def form_at(self, below_tip: float) -> ToothForm:
        """Tooth form with the load at a point. below_tip: distance from the tip along the line of action, in base
        pitches."""
        section = self.section
        return ToothForm(section, load_point(section.gear, below_tip * section.gear.base_pitch))


def standard_stress(load: RootLoad, edition: Edition, tolerance_class: int = 6) -> StandardStress:
    """σ_F0 by ISO 6336-3 with all the load at the outer point of single contact of the virtual gear, (ε_αn − 1) p_bn
    below the tip, also where two pairs are always in contact: there Y_DT (2006) or f_ε (2019) say what they share.

    tolerance_class: by ISO 1328-1.

    Raises InputError.
    """
    one_of("edition", edition, EDITIONS)
    one_of("tolerance_class", tolerance_class, TOLERANCE_CLASSES)
    pair, ε = load.pair, load.contact_ratio
    form = load.form_at(ε - 1.0)
    form_factor = form.form_factor * load_distribution_factor(ε, pair.overlap_ratio, edition)
    helix = helix_angle_factor(pair.pinion.helix_angle, pair.overlap_ratio, edition)
    deep = deep_tooth_factor(ε, tolerance_class) if edition == 2006 else 1.0
    rim = load.rim_factor
    stress = load.face_stress * form_factor * form.stress_correction_factor * helix * deep * rim
    return StandardStress(stress, form_factor, form.stress_correction_factor, helix, deep, rim, form)


def boundary_stresses(load: RootLoad) -> tuple[PointStress, ...]:
    """Root stress with equal sharing at the points where pairs of a spur gear pair begin or end to share the load
    (Zhang et al. 2023, Eq. 6), from the tip down. Raises InputError for helical gears."""
    _require_spur(load)
    return tuple(
        _at(load, point.name, point.below_tip, 1.0 / point.pairs) for point in contact_points(load.contact_ratio)
    )


def largest_stress(load: RootLoad) -> PointStress:
    """Largest root stress over the whole path of contact of a spur pair, with Pedrero's sharing. Raises InputError for
    helical gears."""
    _require_spur(load)
    low, high = 0.0, load.contact_ratio
    for _ in range(ROUNDS):
        step = (high - low) / FINE
        tried = [_shared(load, low + i * step) for i in range(FINE + 1)]
        best = max(tried, key=lambda each: each.stress)
        low, high = max(0.0, best.below_tip - step), min(load.contact_ratio, best.below_tip + step)
    return best


def _require_spur(load: RootLoad) -> None:
    angle = load.pair.pinion.helix_angle_deg
    if angle > 0.0:
        raise InputError(
            f"root stress at points of the flank: wanted spur gears, found a helix angle of {angle:g}°; contact lines "
            "of helical gears load many points at once, take the standard's stress or finite elements"
        )


def _shared(load: RootLoad, below_tip: float) -> PointStress:
    share = pedrero_share(load.contact_ratio - below_tip, load.contact_ratio)
    return _at(load, "largest with Pedrero's sharing", below_tip, share)


def _at(load: RootLoad, name: str, below_tip: float, share: float) -> PointStress:
    form = load.form_at(below_tip)
    stress = share * load.face_stress * form.form_factor * form.stress_correction_factor
    return PointStress(name, below_tip, share, stress, form)
