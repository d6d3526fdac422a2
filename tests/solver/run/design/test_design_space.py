"""The variants of a design: lattice, values, scenes, and deviations within tolerances."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.run.design.design_space import DesignSpace
from evolvent.scene.gear_pair import ImpossibleGears
from tests.support.gear_cases import spur_scene

VARY = '[["both.tip_relief_um",0.0,8.0,4.0],["pinion.profile_slope_um",-1.0,1.0,1.0]]'


def space(*settings: str, vary: str = VARY) -> DesignSpace:
    scene = spur_scene(f"design.vary={vary}", *settings)
    assert scene.design is not None
    return DesignSpace(scene, scene.design)


def test_lattice_has_each_combination_once() -> None:
    """0, 4, 8 µm with −1, 0, 1 µm: nine points, pinion and wheel alike in the relief."""
    own = space()
    assert own.keys == ("pinion.tip_relief_um", "wheel.tip_relief_um", "pinion.profile_slope_um")
    assert own.section.size == 9
    found = own.variants(own.lattice())
    assert found.tolist() == [[relief, relief, slope] for relief in (0.0, 4.0, 8.0) for slope in (-1.0, 0.0, 1.0)]


def test_last_value_is_not_lost_to_rounding() -> None:
    """0.1 to 0.7 in steps of 0.1 are seven values, though 0.6/0.1 is below 6 in floating point; none exceeds 0.7."""
    own = space(vary='[["pinion.tip_relief_um",0.1,0.7,0.1]]')
    values = own.variants(own.lattice())[:, 0]
    assert len(values) == 7 and values.max() <= 0.7 and values[-1] == pytest.approx(0.7)


def test_sobol_points_are_different_and_inside() -> None:
    """Seven of nine points: a sequence of length 7 in 3 × 3 cells, repetitions left out."""
    own = space()
    points = own.sobol(7)
    assert 4 <= len(points) <= 7 and len(np.unique(points, axis=0)) == len(points)
    assert (points >= 0).all() and (points < np.array(own.counts)).all()


@pytest.mark.parametrize("count", [0, 1, 3, 6])
def test_number_of_variants_within_tolerances(count: int) -> None:
    """`evolvent check` tells the number of variants that are computed."""
    keys = "tip_relief_um", "profile_crowning_um", "twist_um"
    names = [f"{gear}.{key}" for gear in ("pinion", "wheel") for key in keys]
    rows = ",".join(f'["{name}",2.0]' for name in names[:count])
    own = space(f"design.tolerances=[{rows}]", vary='[["pinion.tip_relief_um",4.0,8.0,4.0]]')
    computed = own.deviating(own.variants(own.lattice())[0])
    assert len(computed) == max(1, own.section.deviations) and (own.section.deviations == 0) == (count == 0)


def test_scene_of_a_variant_has_its_values() -> None:
    """The variant's gear pair has the modifications, all else stays; values that follow from others are the scene's."""
    own = space("pinion.tip_relief_um=0", "pinion.tip_relief_start_diameter_mm=150.0")
    pair = own.scene_of(np.array([4.0, 8.0, -1.0])).gear_pair()
    assert (pair.pinion.modifications.tip_relief_um, pair.wheel.modifications.tip_relief_um) == (4.0, 8.0)
    assert pair.pinion.modifications.profile_slope_um == -1.0
    assert pair.pinion.modifications.tip_relief_start_diameter == 150.0
    start = space(vary='[["wheel.tip_relief_start_diameter_mm",150.0,152.0,1.0]]')
    assert start.as_it_stands.tolist() == [start.scene.gear_pair().wheel.modifications.tip_relief_start_diameter]


def test_impossible_variant_is_refused_by_its_gears() -> None:
    """A relief that starts beyond the tip of 156 mm."""
    own = space("pinion.tip_relief_um=5", vary='[["pinion.tip_relief_start_diameter_mm",150.0,170.0,10.0]]')
    with pytest.raises(ImpossibleGears, match="tip_relief_start_diameter_mm"):
        own.scene_of(np.array([170.0])).gear_pair()


def test_deviations_are_within_the_tolerances() -> None:
    """Tolerances of 3 µm on both reliefs, each by itself, and 5 µm of misalignment, about reliefs of 2 µm: the variant
    first, all 8 corners, reliefs from 0 (none is negative) to 5, misalignments of either sign."""
    own = space('design.tolerances=[["both.tip_relief_um",3.0],["pair.misalignment_um",5.0]]')
    assert own.keys[-1] == "pair.misalignment_um"
    found = own.deviating(np.array([2.0, 2.0, 1.0, 0.0]))
    assert found[0].tolist() == [2.0, 2.0, 1.0, 0.0] and (found[:, 2] == 1.0).all()
    corners = {(a, b, c) for a in (0.0, 5.0) for b in (0.0, 5.0) for c in (-5.0, 5.0)}
    assert corners <= {(a, b, c) for a, b, _, c in found.tolist()}
    assert found[:, :2].min() == 0.0 and found[:, :2].max() == 5.0 and np.abs(found[:, 3]).max() == 5.0
    assert len({tuple(row) for row in found.tolist()}) > 30


def test_small_amounts_within_tolerances_are_none() -> None:
    """A crowning of 0 ± 2 µm: amounts below 0.1 µm would be refused as millimetres, and are 0."""
    own = space('design.tolerances=[["wheel.profile_crowning_um",2.0]]')
    found = own.deviating(np.zeros(4))[:, 3]
    assert ((found == 0.0) | (found >= 0.1)).all() and found.max() == 2.0


def test_without_tolerances_there_is_the_variant_alone() -> None:
    """Nothing deviates."""
    assert space().deviating(np.array([2.0, 2.0, 1.0])).tolist() == [[2.0, 2.0, 1.0]]
