"""How the body of a gear is held."""

from __future__ import annotations

from dataclasses import dataclass


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
