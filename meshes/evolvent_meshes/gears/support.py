"""How the body of a gear is held."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from evolvent_meshes.gears.errors import require, require_numbers

LEAST_WIDTH = 0.05
"""Smallest width of a support over the face width: a narrower one is a line, on which nothing is stiff."""


@dataclass(frozen=True)
class Support:
    """How a gear is held at its bore diameter: rigidly, over its face width or a part of it.

    width: axial length of the part [mm]; None: the whole face width.
    offset: of its middle from mid-face, positive towards +z [mm].
    is_rim: whether the bore diameter is the inner diameter of a rim, and what is within it left out.
    """

    width: float | None = None
    offset: float = 0.0
    is_rim: bool = False

    def ends(self, face_width: float) -> tuple[float, float]:
        """Heights z of both ends [mm], for a face width [mm]."""
        width = face_width if self.width is None else self.width
        return self.offset - 0.5 * width, self.offset + 0.5 * width

    def is_partial(self, face_width: float) -> bool:
        """Whether a part of the face width [mm] is not held."""
        return self.width is not None and self.width < face_width


def check_support(support: Any, face_width: float) -> None:
    """Raises GeometryError unless the support lies within the face width [mm]."""
    require(isinstance(support, Support), "support", support, "Support", "Write Support(width=...).")
    require_numbers(support_offset=support.offset)
    if support.width is None:
        remedy = "Give support_width, too, or leave the offset out."
        require(support.offset == 0.0, "support_offset", support.offset, "0 where the whole face is held", remedy)
        return
    require_numbers(support_width=support.width)
    least = LEAST_WIDTH * face_width
    require(
        least <= support.width <= face_width, "support_width", support.width,
        f"{least:.6g} to {face_width:.6g} mm, the face width",
        "Leave it out where the gear is held over its whole face.",
    )  # fmt: skip
    most = 0.5 * (face_width - support.width)
    require(
        math.isfinite(support.offset) and abs(support.offset) <= most + 1e-9 * face_width,
        "support_offset", support.offset, f"{-most:.6g} to {most:.6g} mm: the support lies within the face",
        "It is the middle of the support, seen from mid-face.",
    )  # fmt: skip
