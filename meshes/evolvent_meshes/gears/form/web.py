"""The web of a gear: a disc thinner than the face that joins rim and hub."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Web:
    """A disc between rim and hub, bounded by two planes across the axis; rim and hub are as wide as the face.

    thickness: b_s, along the axis [mm]; that of the face makes the gear a full ring.
    rim_thickness: s_R, of the rim below the root circle [mm].
    hub_diameter: outer diameter of the hub [mm]; None: there is no hub, the web reaches the bore.
    offset: of the web's middle from mid-face, positive towards +z [mm].
    """

    thickness: float
    rim_thickness: float
    hub_diameter: float | None = None
    offset: float = 0.0

    @property
    def ends(self) -> tuple[float, float]:
        """Heights z of its two faces [mm]."""
        return self.offset - 0.5 * self.thickness, self.offset + 0.5 * self.thickness

    def is_thinner(self, face_width: float) -> bool:
        """Whether it is thinner than the face [mm]: else the body is a full ring."""
        return self.thickness < face_width
