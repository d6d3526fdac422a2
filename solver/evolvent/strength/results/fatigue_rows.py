"""Rows of the tables of contact fatigue: largest values, all over the flank, and below its most loaded point."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.results.tables.table import Table


@dataclass(frozen=True)
class FatigueRow:
    """A line of fatigue.csv: where a criterion is largest on a gear."""

    gear: str
    """pinion or wheel. Both flanks bear the same tractions: with one material the values are the same."""
    friction: float
    """Friction coefficient μ."""
    criterion: str
    """Name of the criterion."""
    place: str
    """Depth: surface; 0.02, 0.05 and 0.1 half-widths of the contact below it; below, from 0.2 half-widths down."""
    value: float
    """Largest value over the flank at this depth, and for below over these depths. NaN where nothing was evaluated."""
    unit: str
    """Unit of the value: MPa; empty for Fatemi-Socie, which is a strain."""
    value_error: float
    """Estimated error of the value by the contact pressure: that of the largest pressure over itself times the value,
    twice that of Fatemi-Socie. NaN without a coarse companion (`output.error_bars`)."""
    diameter_mm: float
    """Diameter of the gear at which the value is largest."""
    height_mm: float
    """Axial position of the largest value, 0 at mid-face."""
    depth_um: float
    """Depth of the largest value below the flank."""
    roll_distance_mm: float
    """Distance of the contact from the pitch point along the path of contact, negative towards the pinion's root."""
    pressure_MPa: float
    """Contact pressure above the point of the largest value."""
    at_zone_end: bool
    """Whether the largest value lies beside the zone of a tip edge, which is left out: it may be larger further in, and
    where it lies is no prediction of where damage begins."""
    near_friction_reversal: bool
    """Whether the contact passes the pitch line while it is within two half-widths of the point, or does not slide as a
    whole there: friction changes then while the contact passes, and the history, which has that of one position, does
    not hold. Always false for contact pressure."""
    at_depth_limit: bool
    """Whether the value, of place below, is largest at the first or the last depth: it is no maximum over the depth
    then."""
    point_roll_distance_mm: float
    """Roll distance of the point at which friction coefficients are compared: where the criterion is largest at the
    first one, of the points that both have. NaN where the criterion is below 1e-4 of the contact pressure there."""
    point_value: float
    """Value at the point of comparison, and for below largest over the depths."""
    point_depth_um: float
    """Depth of the value at the point of comparison."""
    point_at_zone_end: bool
    """Whether the point of comparison lies beside the zone of a tip edge."""
    point_near_friction_reversal: bool
    """Whether friction reverses near the point of comparison at this friction coefficient or at the first one: the
    change rests on both histories."""
    change_percent: float
    """Change of the value at the point of comparison over that at the first friction coefficient; NaN without such a
    point: where the first coefficient is 0, shear and tension at the surface are 0, the contact pressure is not."""
    change_percent_error: float
    """Difference of `change_percent` from the coarse companion's; NaN without one."""
    change_at_points_percent: float
    """Median over the points of the flank of the change of each point's value at this place over that at the first
    friction coefficient; NaN where the criterion is negligible at all of them."""
    change_at_points_percent_error: float
    """Difference of `change_at_points_percent` from the coarse companion's; NaN without one."""


@dataclass(frozen=True)
class FatigueLifeRow:
    """A line of fatigue_life.csv: a life, in passages of the contact, over that at the first friction coefficient,
    N ∝ value^−m."""

    gear: str
    """pinion or wheel."""
    friction: float
    """Friction coefficient μ."""
    criterion: str
    """Name of the criterion."""
    place: str
    """Depth, as in fatigue.csv."""
    exponent: float
    """Exponent m of the S-N line."""
    source: str
    """Source of the exponent; empty for those of fatigue.exponents."""
    life_ratio: float
    """Ratio of lives at one point of the flank, `point_roll_distance_mm` of fatigue.csv, which may lie beside a
    tip-edge zone (`point_at_zone_end` there). NaN where the criterion is negligible at the first
    coefficient, and of orthogonal shear and tension at the surface, which are multiples of μ p0: such lives would be
    those of the friction coefficients alone. Infinite where it is negligible at this coefficient alone."""
    life_ratio_at_points: float
    """Ratio of lives by the median change at the points of the flank, each compared with itself; quote both."""


@dataclass(frozen=True)
class FatigueMapRow:
    """A line of fatigue_map.csv: a criterion at a point of a flank."""

    gear: str
    """pinion or wheel."""
    friction: float
    """Friction coefficient μ."""
    diameter_mm: float
    """Diameter of the gear at the point."""
    height_mm: float
    """Axial position of the point, 0 at mid-face."""
    roll_distance_mm: float
    """Distance of the contact from the pitch point along the path of contact, negative towards the pinion's root."""
    pressure_MPa: float
    """Peak contact pressure when the contact passes."""
    half_width_mm: float
    """Half-width of the contact when it passes."""
    traction_coefficient: float
    """Net tangential force over normal force when the contact passes: μ where it slides, less where it sticks or the
    pitch line crosses the slice."""
    near_friction_reversal: bool
    """Whether friction reverses near the point, as in fatigue.csv."""
    criterion: str
    """Name of the criterion."""
    at_surface: float
    """Value at the surface, in the unit of fatigue.csv."""
    at_0_02: float
    """Value at 0.02 half-widths below the surface; NaN for contact pressure."""
    at_0_05: float
    """Value at 0.05 half-widths below the surface; NaN for contact pressure."""
    at_0_1: float
    """Value at 0.1 half-widths below the surface; NaN for contact pressure."""
    below: float
    """Largest value from 0.2 half-widths down; NaN for contact pressure and tensile stress."""
    depth_um: float
    """Depth of the largest value from 0.2 half-widths down; NaN for contact pressure and tensile stress."""


@dataclass(frozen=True)
class FatigueDepthRow:
    """A line of fatigue_depth.csv: a criterion below the point of a flank with the largest contact pressure, of those
    that friction does not reverse near (near_friction_reversal of fatigue.csv); and of fatigue_section.csv, Dang Van's
    below the points of a flank at the height nearest to mid-face."""

    gear: str
    """pinion or wheel."""
    friction: float
    """Friction coefficient μ."""
    diameter_mm: float
    """Diameter of the gear at the point."""
    height_mm: float
    """Axial position of the point, 0 at mid-face."""
    criterion: str
    """Name of the criterion."""
    depth_um: float
    """Depth below the flank."""
    depth_over_half_width: float
    """Depth below the flank, over the half-width of the contact."""
    value: float
    """Value of the criterion, in the unit of fatigue.csv."""


FATIGUE, FATIGUE_LIFE = Table("fatigue.csv", FatigueRow), Table("fatigue_life.csv", FatigueLifeRow)
FATIGUE_MAP = Table("fatigue_map.csv", FatigueMapRow)
FATIGUE_DEPTH = Table("fatigue_depth.csv", FatigueDepthRow)
FATIGUE_SECTION = Table("fatigue_section.csv", FatigueDepthRow)
