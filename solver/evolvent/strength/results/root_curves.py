"""Root stress over the rotation of a tooth, and the error bars of its curves and of their largest values.

The errors of the mesh are estimated as those of a run (`results.error_bars.compared`), from the same positions on
elements of twice the size, with a factor for root stress. A largest value may lie between two positions: by how much it
may be higher there is added to its bar.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from evolvent.results.error_bars.compared import ROOT_STRESS, Compared, Curve
from evolvent.results.error_bars.peak_bounds import peak_bounds
from evolvent.strength.root_passage import GearRoots
from evolvent_meshes.arrays import Floats


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
    """Error bars (k,) of the values of a curve, by the mesh [MPa]."""
    peak: float
    """Error bar of the largest amount of a curve, by the mesh and the spacing of positions [MPa]."""


def curve_errors(
    curve: Callable[[GearRoots], Curve], own: GearRoots, coarse: GearRoots | None, order: int
) -> CurveErrors:
    """Error bars of a curve of root stress. coarse: roots on elements of twice the size. order: of the cells."""
    fine = curve(own)
    if coarse is None:
        return CurveErrors(np.full(len(fine.values), np.nan), np.nan)
    rough = curve(coarse)
    amount, less = (replace(each, values=np.abs(each.values)) for each in (fine, rough))
    peak = Compared(amount, less, ROOT_STRESS[order]).of_figure(np.max) + _spacing_error(amount)
    return CurveErrors(value_errors(fine, rough, order), peak)


def value_errors(fine: Curve, rough: Curve, order: int) -> Floats:
    """Error bars (k,) of the values of a curve by the mesh.

    rough: on elements of twice the size, at the same rotations. order: of the cells.
    """
    largest = np.full(len(fine.values), np.abs(fine.values).max())  # curves cross, and errors do not scale with values
    return Compared(fine, rough, ROOT_STRESS[order]).of_each(largest)


def _spacing_error(curve: Curve) -> float:
    """Amount by which the curve may be higher between its positions than at the highest of them."""
    largest = float(curve.values.max())
    return max([0.0, *(each.height - largest for each in peak_bounds(curve.angle, curve.values))])
