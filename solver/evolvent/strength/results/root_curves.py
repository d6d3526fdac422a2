"""Root stress over the rotation of a tooth, and the error bars of its curves and of their largest values.

The errors of the mesh are estimated as those of a run (`results.error_bars.estimation`), from the same positions on
elements of twice the size, with a factor for root stress. A largest value may lie between two positions: by how much it
may be higher there is added to its bar.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from evolvent.results.error_bars.estimation import Curve, difference, relative_difference
from evolvent.strength.peak_bounds import beside_largest
from evolvent.strength.root_passage import GearRoots
from evolvent_meshes.arrays import Floats

ROOT_FACTOR = {1: 2.0, 2: 1.0 / 3.0}
"""Order of the cells -> 1/(2^p − 1) for stress at roots of twelve elements around a fillet and more; p = 0.6 and 2. How
many bars hold: docs/strength.md."""


def tension_curve(roots: GearRoots) -> Curve:
    """Largest principal stress of the loaded side over the rotation [MPa]."""
    return Curve(roots.loaded_side.angles, roots.loaded_side.largest)


def compression_curve(roots: GearRoots) -> Curve:
    """Smallest principal stress of the back side over the rotation [MPa]."""
    return Curve(roots.back_side.angles, roots.back_side.smallest)


@dataclass(frozen=True, eq=False)
class CurveErrors:
    """Error bars of a curve; NaN where there is no coarse companion."""

    values: Floats
    """(k,) of its values, by the mesh [MPa]."""
    peak: float
    """Of the largest value of its amount, by the mesh and the spacing of positions [MPa]."""


def curve_errors(
    curve: Callable[[GearRoots], Curve], own: GearRoots, coarse: GearRoots | None, order: int
) -> CurveErrors:
    """Of one of the curves above. coarse: the same on elements of twice the size. order: of the cells."""
    fine = curve(own)
    if coarse is None:
        return CurveErrors(np.full(len(fine.values), np.nan), np.nan)
    rough, factor = curve(coarse), ROOT_FACTOR[order]
    amount, less = (replace(each, values=np.abs(each.values)) for each in (fine, rough))
    peak = factor * difference(np.max, amount, less) + _spacing_error(amount)
    return CurveErrors(value_errors(fine, rough, order), peak)


def value_errors(fine: Curve, rough: Curve, order: int) -> Floats:
    """Error bars (k,) of the values of a curve by the mesh.

    rough: on elements of twice the size, at the same rotations. order: of the cells.
    """
    # curves cross, and errors do not scale with values
    least = np.abs(fine.values).max() * relative_difference(fine, rough)
    return np.asarray(ROOT_FACTOR[order] * np.maximum(np.abs(fine.values - rough.values), least))


def _spacing_error(curve: Curve) -> float:
    """By how much the curve may be higher between its positions than at the highest of them."""
    largest = float(curve.values.max())
    return max([0.0, *(each.height - largest for each in beside_largest(curve.angle, curve.values))])
