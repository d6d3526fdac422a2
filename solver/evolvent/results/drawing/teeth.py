"""Names of tooth pairs in pictures: their index in teeth.csv."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evolvent.results.engagement import Engagement
from evolvent.scene.plain_text import signed

AT_PITCH_POINT = "at the pitch point, φ = 0"
"""Place of tooth pair 0."""


def short_name(tooth: int) -> str:
    """Name of a tooth pair, such as "pair +1", the pair ahead of pair 0, which passes the pitch point at φ = 0."""
    return "pair 0" if tooth == 0 else f"pair {signed(tooth, 0)}"


def long_name(tooth: int) -> str:
    """Name of a tooth pair with its place in the mesh."""
    where = AT_PITCH_POINT if tooth == 0 else "ahead" if tooth > 0 else "behind"
    return f"{short_name(tooth)} ({where})"


def shown_teeth(curves: Sequence[Engagement]) -> list[int]:
    """Tooth pairs with a contact stress in this pitch at every friction coefficient, the leading pair first."""
    candidates = sorted(np.unique(curves[0].tooth).tolist(), reverse=True)
    return [tooth for tooth in candidates if all(_is_stressed(curve, tooth) for curve in curves)]


def _is_stressed(curve: Engagement, tooth: int) -> bool:
    """Whether the contact stress of a tooth pair is known at some position."""
    here = curve.tooth == tooth
    return bool(np.isfinite(curve.max_pressure[here]).any() and np.isfinite(curve.mean_pressure[here]).any())
