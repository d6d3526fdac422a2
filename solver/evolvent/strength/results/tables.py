"""Root stress of both gears by each way side by side, and over the rotation of a tooth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.results.tables.table import Table
from evolvent.strength.results.root_curves import compression_curve, curve_errors, tension_curve
from evolvent.strength.root_passage import GearRoots, RootPeak
from evolvent.strength.standard.factors import Edition
from evolvent.strength.standard.root_stress import (
    PointStress,
    RootLoad,
    boundary_stresses,
    largest_stress,
    standard_stress,
)
from evolvent.strength.standard.tooth_form import NOTCH
from evolvent_meshes.gears.member import Member

STANDARD, TENSION, COMPRESSION = "ISO 6336-3:", "finite elements, tension", "finite elements, compression"
"""Methods of strength.csv: the standard, with its edition behind; the largest of the loaded side, and of the back."""
UNKNOWN = math.nan


@dataclass(frozen=True, eq=False)
class FrictionRoots:
    """Roots of both gears at one friction coefficient."""

    friction: float
    """Friction coefficient μ."""
    gears: tuple[GearRoots, GearRoots]
    """Root stress of pinion and wheel."""
    coarse: tuple[GearRoots, GearRoots] | None
    """Root stress on elements of twice the size; None where it is not known."""
    order: int
    """Polynomial order of the cells."""


@dataclass(frozen=True)
class StrengthRow:
    """A line of strength.csv: a stress of a gear's root by one method. Without load factors."""

    gear: str
    """pinion or wheel."""
    method: str
    """The standard with its edition, a formula with its point of load, or finite elements."""
    friction: float
    """Friction coefficient of finite elements; NaN for formulas, which have none."""
    stress_MPa: float
    """Nominal stress of the formula; largest principal stress of the loaded side, or smallest of the back side."""
    stress_MPa_error: float
    """Estimated error of the stress by the mesh and the spacing of positions; NaN for formulas, and without a coarse
    companion (`output.error_bars`)."""
    tooth_rotation_deg: float
    """Pinion rotation of the tooth at which the stress occurs; 0 where its flanks touch at the pitch point of the
    mid-face section, above 0 later in the engagement. NaN for the standard's virtual gear of helical ones."""
    radius_mm: float
    """Radius of the place; of formulas that of the critical section, as far above the reference circle of the gear as
    it lies above that of its virtual gear."""
    height_mm: float
    """Axial position of the place, 0 at mid-face."""
    tangent_angle_deg: float
    """Angle of the profile at the place to the tooth's centre line in the transverse section; of formulas 30, in the
    normal one."""
    load_share: float
    """Part of the load on the tooth: that a formula takes; of finite elements that of the normal force at this
    rotation. Deflected teeth share the load where rigid ones do not, at the outer point of single contact above all."""
    whole_load_MPa: float
    """The stress at this rotation with the whole load on this tooth, as the standard's stress has it: of formulas
    stress_MPa / load_share; of finite elements under the forces on this tooth alone, over load_share. The forces on its
    neighbours, which stress_MPa has too, may pull the root a little."""
    form_factor: float
    """Form factor Y_F, in the edition of 2019 with f_ε; NaN for finite elements."""
    stress_correction_factor: float
    """Stress correction factor Y_S; NaN for finite elements."""
    notch_parameter: float
    """Notch parameter q_s, for which Y_S was fitted from 1 to below 8; NaN for finite elements."""
    other_factors: float
    """Y_β Y_DT Y_B of the standard, 1 of other formulas; NaN for finite elements. The stress of a formula is
    load_share · form_factor · stress_correction_factor · other_factors · F_t/(b m_n), b the common face width."""
    mean_MPa: float
    """Mean of largest and smallest stress at the place over a passage, in the direction of this one; NaN for
    formulas."""
    amplitude_MPa: float
    """Half of the difference of largest and smallest stress at the place over a passage; NaN for formulas."""


@dataclass(frozen=True)
class RootStressRow:
    """A line of root_stress.csv: a tooth of a gear at a rotation."""

    gear: str
    """pinion or wheel."""
    friction: float
    """Friction coefficient."""
    tooth_rotation_deg: float
    """Pinion rotation of the tooth; 0 where its flanks touch at the pitch point of the mid-face section, above 0 later
    in the engagement."""
    tension_MPa: float
    """Largest principal stress at the root of the loaded side."""
    tension_MPa_error: float
    """Estimated error of the tension by the mesh; NaN without a coarse companion."""
    compression_MPa: float
    """Smallest principal stress at the root of the back side."""
    compression_MPa_error: float
    """Estimated error of the compression by the mesh; NaN without a coarse companion."""


STRENGTH, ROOT_STRESS = Table("strength.csv", StrengthRow), Table("root_stress.csv", RootStressRow)


def strength_rows(
    load: RootLoad, found: Sequence[FrictionRoots], editions: Sequence[Edition], tolerance_class: int
) -> Iterator[StrengthRow]:
    """Rows of strength.csv of one gear, formulas first. editions: of the standard. tolerance_class: by ISO 1328-1, for
    Y_DT."""
    yield from formula_rows(load, editions, tolerance_class)
    for each in found:
        own, coarse = each.gears[load.member], None if each.coarse is None else each.coarse[load.member]
        bars = [curve_errors(curve, own, coarse, each.order) for curve in (tension_curve, compression_curve)]
        peaks = own.loaded_side.tension, own.back_side.compression
        for method, peak, bar in zip((TENSION, COMPRESSION), peaks, bars):
            yield _of_peak(load, method, each.friction, peak, bar.peak)
        if load.pair.pinion.helix_angle_deg == 0.0:
            angle, name = load.tooth_rotation(load.outer_point.below_tip), load.outer_point.name
            k = int(np.argmin(np.abs(own.loaded_side.angles - angle)))
            peak, error = own.loaded_side.tension_at(k), float(bars[0].values[k])
            yield _of_peak(load, f"{TENSION}, {name}", each.friction, peak, error)


def formula_rows(load: RootLoad, editions: Sequence[Edition], tolerance_class: int) -> Iterator[StrengthRow]:
    """Rows by the standard, in each edition; of spur gears also at the points where pairs begin or end to share the
    load, and largest over the path of contact."""
    for edition in editions:
        found = standard_stress(load, edition, tolerance_class)
        point = PointStress("", load.contact_ratio - 1.0, 1.0, found.stress, found.form)
        others = found.helix_angle_factor * found.deep_tooth_factor * found.rim_thickness_factor
        yield _of_point(load, f"{STANDARD}{edition}", point, found.form_factor, others)
    if load.pair.pinion.helix_angle_deg == 0.0:
        for point in boundary_stresses(load):
            yield _of_point(load, f"equal shares, {point.name}", point)
        yield _of_point(load, "Pedrero's shares, largest over the path", largest_stress(load))


def _of_point(
    load: RootLoad, method: str, point: PointStress, form_factor: float | None = None, others: float = 1.0
) -> StrengthRow:
    form, section, gear = point.form, point.form.section, load.pair.gears[load.member]
    above = math.hypot(section.height, 0.5 * section.chord) - 0.5 * section.gear.reference_diameter
    return StrengthRow(
        gear=load.member.label, method=method, friction=UNKNOWN, stress_MPa=point.stress, stress_MPa_error=UNKNOWN,
        tooth_rotation_deg=math.degrees(load.tooth_rotation(point.below_tip)),
        radius_mm=0.5 * gear.reference_diameter + above, height_mm=0.0, tangent_angle_deg=30.0, load_share=point.share,
        whole_load_MPa=point.stress / point.share, form_factor=form.form_factor if form_factor is None else form_factor,
        stress_correction_factor=form.stress_correction_factor, notch_parameter=form.notch_parameter,
        other_factors=others, mean_MPa=UNKNOWN, amplitude_MPa=UNKNOWN,
    )


def _of_peak(load: RootLoad, method: str, friction: float, peak: RootPeak, error: float) -> StrengthRow:
    return StrengthRow(
        gear=load.member.label, method=method, friction=friction, stress_MPa=peak.stress, stress_MPa_error=error,
        tooth_rotation_deg=math.degrees(peak.angle), radius_mm=peak.radius, height_mm=peak.height,
        tangent_angle_deg=math.degrees(peak.tangent_angle), load_share=peak.load_share, whole_load_MPa=peak.whole_load,
        form_factor=UNKNOWN, stress_correction_factor=UNKNOWN, notch_parameter=UNKNOWN, other_factors=UNKNOWN,
        mean_MPa=peak.mean, amplitude_MPa=peak.amplitude,
    )


def formula_warnings(loads: Sequence[RootLoad]) -> Iterator[str]:
    """Sentences on gears whose Y_S lies beyond what it was fitted for, or whose Y_B stands for what finite elements
    leave out."""
    for load in loads:
        if load.rim_factor > 1.0 and load.pair.gears[load.member].support.is_rim:
            yield (
                f"{load.member.label}: the inside of its rim is held rigidly, so that finite elements leave out how it "
                "bends: with a thinner rim their stress does not rise as the standard's does, here by Y_B = "
                f"{load.rim_factor:.3g}; give web_thickness_mm for a rim that bends."
            )
        form = load.form_at(load.contact_ratio - 1.0)
        if not form.is_in_range:
            low, high = NOTCH
            yield (
                f"{load.member.label}: Y_S is extrapolated, as its notch parameter q_s = {form.notch_parameter:.3g} is "
                f"outside {low:g} to {high:g}; stresses of formulas are too low below, and not proven above."
            )


def root_stress_rows(found: Sequence[FrictionRoots]) -> Iterator[RootStressRow]:
    """Rows of root_stress.csv of both gears at all friction coefficients."""
    for each in found:
        for member, own in zip(Member, each.gears):
            coarse, angles = None if each.coarse is None else each.coarse[member], own.loaded_side.angles
            curves = tension_curve, compression_curve
            columns = [curve(own).values for curve in curves]
            bars = [curve_errors(curve, own, coarse, each.order).values for curve in curves]
            for angle, tension, compression, of_tension, of_compression in zip(angles, *columns, *bars):
                yield RootStressRow(
                    gear=member.label, friction=each.friction, tooth_rotation_deg=math.degrees(angle),
                    tension_MPa=float(tension), tension_MPa_error=float(of_tension), compression_MPa=float(compression),
                    compression_MPa_error=float(of_compression),
                )

