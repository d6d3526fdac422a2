"""Factors of ISO 6336-3: values that can be worked by hand, and where they must not jump."""

from __future__ import annotations

import math
from typing import Literal

import pytest

from evolvent.strength.standard.factors import (
    deep_tooth_factor,
    helix_angle_factor,
    load_distribution_factor,
    rim_thickness_factor,
)
from evolvent_meshes.errors import InputError

STEP = 1e-9


def test_helix_angle_factor() -> None:
    """β = 12°, ε_β = 0.5: 1 − 0.05 in 2006, over cos³ 12° in 2019; constant from ε_β = 1 and from β = 30° on."""
    assert helix_angle_factor(math.radians(12.0), 0.5, 2006) == pytest.approx(0.95, rel=1e-12)
    assert helix_angle_factor(math.radians(12.0), 0.5, 2019) == pytest.approx(0.95 / math.cos(math.radians(12.0)) ** 3)
    assert helix_angle_factor(math.radians(40.0), 3.0, 2006) == pytest.approx(0.75, rel=1e-12)


def test_rim_thickness_factor() -> None:
    """1 from 1.2 tooth heights on, without a jump beyond the digits of the standard's 2.242 (3e-5); 1.6 ln 2.242 at one
    height; thinner than half a height is refused."""
    assert rim_thickness_factor(1.2, 1.0) == 1.0
    assert rim_thickness_factor(1.2 - STEP, 1.0) == pytest.approx(1.0, abs=1e-4)
    assert rim_thickness_factor(5.0, 5.0) == pytest.approx(1.6 * math.log(2.242), rel=1e-12)
    said = r"wheel\.rim_thickness_mm: found 2 mm, 0\.4 tooth heights; allowed: above 2\.5 mm, half a tooth height"
    with pytest.raises(InputError, match=said):
        rim_thickness_factor(2.0, 5.0, "wheel")


def test_deep_tooth_factor() -> None:
    """0.7 above ε_αn = 2.5, 1 up to 2.05, a line between that meets both within the digits of the standard, 1e-3; 1 for
    coarser tolerance classes."""
    assert deep_tooth_factor(2.2, 4) == pytest.approx(2.366 - 0.666 * 2.2)
    assert deep_tooth_factor(2.05 + STEP, 4) == pytest.approx(1.0, abs=1e-3)
    assert deep_tooth_factor(2.5, 4) == pytest.approx(deep_tooth_factor(2.5 + STEP, 4), abs=2e-3)
    assert deep_tooth_factor(2.2, 5) == 1.0


@pytest.mark.parametrize("ratio", [1.2, 1.7, 2.0, 2.6])
def test_load_distribution_factor_in_the_overlap(ratio: float) -> None:
    """No jump at ε_β = 1, where it is ε_αn^(−1/2), nor at 0, but for the standard's own 0.7 instead of √½."""
    assert load_distribution_factor(ratio, 1.0 - STEP, 2019) == pytest.approx(ratio**-0.5, rel=1e-8)
    assert load_distribution_factor(ratio, 2.0, 2019) == pytest.approx(ratio**-0.5, rel=1e-12)
    spur, nearly = (load_distribution_factor(ratio, overlap, 2019) for overlap in (0.0, STEP))
    assert nearly == pytest.approx(spur, rel=1e-8 if ratio < 2.0 else 0.0103)


@pytest.mark.parametrize("edition", [2006, 2019])
def test_load_distribution_factor_at_two_pairs(edition: Literal[2006, 2019]) -> None:
    """At ε_αn = 2 no jump with a whole overlap; without one the standard of 2019 falls from 1 to 0.7."""
    below, above = (load_distribution_factor(ratio, 1.0, edition) for ratio in (2.0 - STEP, 2.0))
    assert above == pytest.approx(below, rel=1e-8)
    spur = [load_distribution_factor(ratio, 0.0, edition) for ratio in (2.0 - STEP, 2.0)]
    assert spur == ([1.0, 1.0] if edition == 2006 else [1.0, 0.7])
