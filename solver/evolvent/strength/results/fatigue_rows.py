"""Lines of the tables of contact fatigue: largest values, all over the flank, and below its most loaded point."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.results.tables.table import Table


@dataclass(frozen=True)
class FatigueRow:
    """A line of fatigue.csv: where a criterion is largest on a gear."""

    gear: str
    """pinion or wheel. Both flanks bear the same tractions: with one material the values are the same."""
    friction: float
    """μ."""
    criterion: str
    """Its name."""
    place: str
    """surface; 0.02, 0.05 and 0.1 half-widths of the contact below it; below, from 0.2 half-widths down."""
    value: float
    """Largest over the flank at this depth, and for below over these depths. NaN where nothing was evaluated."""
    unit: str
    """MPa; empty for Fatemi-Socie, which is a strain."""
    value_error: float
    """Its estimated error by the contact pressure: that of the largest one over itself times the value, twice that of
    Fatemi-Socie. NaN without a coarse companion (`output.error_bars`)."""
    diameter_mm: float
    """Where it is largest: diameter of the gear."""
    height_mm: float
    """Axial position there, 0 at mid-face."""
    depth_um: float
    """Depth below the flank there."""
    roll_distance_mm: float
    """Distance of the contact from the pitch point along the path of contact, negative towards the pinion's root."""
    pressure_MPa: float
    """Contact pressure above that point."""
    at_zone_end: bool
    """Whether it lies beside the zone of a tip edge, which is left out: it may be larger further in, and where it lies
    is no prediction of where damage begins."""
    near_friction_reversal: bool
    """Whether the contact passes the pitch line while it is within two half-widths of the point, or does not slide as a
    whole there: friction changes then while the contact passes, and the history, which has that of one position, does
    not hold. Never of contact pressure."""
    at_depth_limit: bool
    """Whether, below, it is largest at the first or the last depth: it is no maximum over the depth then."""
    point_roll_distance_mm: float
    """Where friction coefficients are compared: the point of the flank at which the criterion is largest at the first
    one, of those that both have. NaN where the criterion is below 1e-4 of the contact pressure there."""
    point_value: float
    """Value at this point, and for below largest over the depths."""
    point_depth_um: float
    """Depth of that."""
    point_at_zone_end: bool
    """Whether this point lies beside the zone of a tip edge."""
    point_near_friction_reversal: bool
    """Whether friction reverses near this point, as above, at this friction coefficient or at the first one: the change
    rests on both histories."""
    change_percent: float
    """Of the value at this point over that at the first friction coefficient; NaN as above."""
    change_percent_error: float
    """How far the coarse companion's is from it; NaN without one."""
    change_at_points_percent: float
    """Median over the points of the flank of the same change, of each point's value at this place; NaN as above."""
    change_at_points_percent_error: float
    """How far the coarse companion's is from it; NaN without one."""


@dataclass(frozen=True)
class FatigueLifeRow:
    """A line of fatigue_life.csv: a life, in passages of the contact, over that at the first friction coefficient,
    N ∝ value^−m."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    criterion: str
    """Its name."""
    place: str
    """As in fatigue.csv."""
    exponent: float
    """m."""
    source: str
    """Of the exponent; empty for those of fatigue.exponents."""
    life_ratio: float
    """At one point of the flank, `point_roll_distance_mm` of fatigue.csv, which may lie beside a tip-edge zone
    (`point_at_zone_end` there). NaN where the criterion is negligible at the first coefficient, and where it is the
    friction coefficient times the pressure by definition: range of orthogonal shear and tension at the surface;
    infinite where it is negligible at this coefficient alone."""
    life_ratio_at_points: float
    """By the median change at the points of the flank, each compared with itself; quote both."""


@dataclass(frozen=True)
class FatigueMapRow:
    """A line of fatigue_map.csv: a criterion at a point of a flank."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    diameter_mm: float
    """Of the point."""
    height_mm: float
    """Axial position, 0 at mid-face."""
    roll_distance_mm: float
    """Distance of the contact from the pitch point along the path of contact, negative towards the pinion's root."""
    pressure_MPa: float
    """Peak contact pressure when the contact passes."""
    half_width_mm: float
    """Of the contact then."""
    traction_coefficient: float
    """Net tangential force over normal force then: μ where the contact slides, less where it sticks or the pitch line
    crosses the slice."""
    near_friction_reversal: bool
    """As in fatigue.csv."""
    criterion: str
    """Its name."""
    at_surface: float
    """Value at the surface, in the unit of fatigue.csv."""
    at_0_02: float
    """At 0.02 half-widths below it; NaN for contact pressure."""
    at_0_05: float
    """At 0.05 half-widths, likewise."""
    at_0_1: float
    """At 0.1 half-widths, likewise."""
    below: float
    """Largest from 0.2 half-widths down; NaN for contact pressure and tensile stress."""
    depth_um: float
    """Depth of that, likewise."""


@dataclass(frozen=True)
class FatigueDepthRow:
    """A line of fatigue_depth.csv: a criterion below the point of a flank with the largest contact pressure; and of
    fatigue_section.csv, Dang Van's below the points of a flank at the height nearest to mid-face."""

    gear: str
    """pinion or wheel."""
    friction: float
    """μ."""
    diameter_mm: float
    """Of the point."""
    height_mm: float
    """Its axial position, 0 at mid-face."""
    criterion: str
    """Its name."""
    depth_um: float
    """Below the flank."""
    depth_over_half_width: float
    """The same, over the half-width of the contact."""
    value: float
    """In the unit of fatigue.csv."""


FATIGUE, FATIGUE_LIFE = Table("fatigue.csv", FatigueRow), Table("fatigue_life.csv", FatigueLifeRow)
FATIGUE_MAP = Table("fatigue_map.csv", FatigueMapRow)
FATIGUE_DEPTH = Table("fatigue_depth.csv", FatigueDepthRow)
FATIGUE_SECTION = Table("fatigue_section.csv", FatigueDepthRow)
