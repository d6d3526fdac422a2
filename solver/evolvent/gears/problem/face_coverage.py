"""Part of a face that the heights of a flank chart cover, and where their middle lies.

Heights count from mid-face. A measured helix ends before the face does: ISO 1328-1 evaluates it without 5 % of the face
width at either end, or without one module there. So a chart may be shorter than the face, to which it is extended by
the depths at its ends. One that is much shorter, or whose middle is not at mid-face, is of something else: most often
its heights count from an end of the face.
"""

from __future__ import annotations

from dataclasses import dataclass

from evolvent_meshes.arrays import Floats

LEAST_COVERED = 0.8
"""Least length of a chart [face widths] that is extended to the face."""
MOST_OFF_CENTRE = 0.05
"""Largest distance of a chart's middle from mid-face [face widths]."""
LONGEST = 2.0
"""Largest length of a chart [face widths]: beyond it heights are of another gear, or in another unit."""
SAME = 1e-6
"""Heights that differ by less are one [mm]."""


@dataclass(frozen=True)
class FaceCoverage:
    """Heights of a chart beside a face; a single height stands for the whole face."""

    low: float
    """Lowest height [mm]."""
    high: float
    """Highest height [mm]."""
    face_width: float
    """Face width of the gear [mm]."""

    @staticmethod
    def of(heights: Floats, face_width: float) -> FaceCoverage:
        """Coverage of a face by the heights of a chart. heights: ascending [mm]. face_width: of the gear [mm]."""
        return FaceCoverage(float(heights[0]), float(heights[-1]), face_width)

    @property
    def share(self) -> float:
        """Covered part of the face, 0 to 1."""
        half = 0.5 * self.face_width
        return max(min(self.high, half) - max(self.low, -half), 0.0) / self.face_width

    @property
    def problem(self) -> tuple[str, str, str] | None:
        """Phrases on what is wanted, what was found and what to do, where the heights do not suit the face."""
        b, length, middle = self.face_width, self.high - self.low, 0.5 * (self.low + self.high)
        found = f"z = {self.low:g} to {self.high:g} mm"
        if length < SAME:
            wanted = f"a height on the face, where z is 0 at mid-face, {_range(b)}"
            return None if abs(middle) <= 0.5 * b + SAME else (wanted, f"z = {middle:g} mm", "leave z_mm out")
        if self._is_centred(middle) and LEAST_COVERED * b - SAME <= length <= LONGEST * b + SAME:
            return None
        wanted = (
            f"heights on the face, where z is 0 at mid-face, {_range(b)} for a face width of {b:g} mm: over "
            f"{100.0 * LEAST_COVERED:g} % of it at least, and their middle within {100.0 * MOST_OFF_CENTRE:g} %, "
            f"{MOST_OFF_CENTRE * b:g} mm, of z = 0"
        )
        return wanted, f"{found}, {100.0 * self.share:.3g} % of the face", self._remedy(length, middle)

    def _is_centred(self, middle: float) -> bool:
        return abs(middle) <= MOST_OFF_CENTRE * self.face_width + SAME

    def _remedy(self, length: float, middle: float) -> str:
        b = self.face_width
        if length < LEAST_COVERED * b - SAME:
            return "measure further; or leave z_mm out of one profile, which then holds over the whole face"
        if length > LONGEST * b + SAME:
            return "mind that z is in mm, and which gear the chart is of"
        for end, origin in ((0.5 * b, f"0 to {b:g} mm"), (-0.5 * b, f"{-b:g} to 0 mm")):
            if self._is_centred(middle - end):
                return f"z looks as if counted from one end of the face, {origin}: subtract {end:g} mm from it"
        return f"where mid-face is the chart's middle, z = {middle:g} mm, subtract {middle:g} mm from z"

    @property
    def words(self) -> str:
        """A phrase on heights that suit the face but do not end where it does; else empty."""
        half = 0.5 * self.face_width
        short, beyond = max(half - self.high, half + self.low), max(self.high - half, -half - self.low)
        if self.high - self.low < SAME or max(short, beyond) <= SAME:
            return ""
        said = ["it is extended to the whole face by the depths at its ends"] * (short > SAME)
        said += ["what lies beyond the face is left out"] * (beyond > SAME)
        covered = f"heights z = {self.low:g} to {self.high:g} mm cover {100.0 * self.share:.3g} % of the face"
        return f"{covered}, {_range(self.face_width)}: {', and '.join(said)}"


def _range(face_width: float) -> str:
    """The heights of a face."""
    return f"{-0.5 * face_width:g} to {0.5 * face_width:g} mm"
