"""A gear pair, frozen and validated."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent_meshes.gears.pair_geometry import PairGeometry
from evolvent_meshes.gears.pair_limits import check_pair


@dataclass(frozen=True)
class GearPair(PairGeometry):
    """A pinion that drives a wheel: keys and derived quantities are PairGeometry's.

    Raises GeometryError if the two can't run together.
    """

    def __post_init__(self) -> None:
        check_pair(self)
