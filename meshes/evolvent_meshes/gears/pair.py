"""A gear pair whose data have been checked."""

from __future__ import annotations

from dataclasses import dataclass

from evolvent_meshes.gears.pair_geometry import PairGeometry
from evolvent_meshes.gears.pair_limits import check_pair


@dataclass(frozen=True)
class GearPair(PairGeometry):
    """A pinion and a wheel that can run together; fields and properties are those of `PairGeometry`.

    Raises GeometryError if the two cannot run together.

    >>> from evolvent_meshes.gears.gear import GearParameters
    >>> gear = GearParameters.from_rack(
    ...     z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=60.0
    ... )
    >>> pair = GearPair(pinion=gear, wheel=gear, centre_distance=150.0)
    >>> print(f"transverse contact ratio {pair.transverse_contact_ratio:.3f}")
    transverse contact ratio 1.755
    """

    def __post_init__(self) -> None:
        check_pair(self)
