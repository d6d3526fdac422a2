"""Names of tooth pairs in pictures: their index in teeth.csv, or the name in a published study."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evolvent.results.engagement import Engagement
from evolvent.results.run_data import RunData
from evolvent.scene.plain_text import signed
from evolvent.scene.scene import Scene

YANG = {
    1: "tooth 1 (ahead, leaves the mesh)",
    0: "tooth 2 (through the pitch point)",
    -1: "tooth 3 (enters, near the root)",
}
"""Index of a tooth pair over the pitch from φ = 0 -> name of that tooth in Yang et al. 2022."""
AT_PITCH_POINT = "at the pitch point, φ = 0"
"""Place of tooth pair 0."""


def compares_yang(scene: Scene) -> bool:
    """Whether results are compared with Yang et al. 2022."""
    return scene.output.compare == "yang2022"


def short_name(run: RunData, tooth: int) -> str:
    """Name of a tooth pair, such as "pair +1", the pair ahead of pair 0, which passes the pitch point at φ = 0."""
    if compares_yang(run.scene):
        return f"tooth {2 - tooth}"
    return "pair 0" if tooth == 0 else f"pair {signed(tooth, 0)}"


def long_name(run: RunData, tooth: int) -> str:
    """Name of a tooth pair with its place in the mesh."""
    if compares_yang(run.scene):
        return YANG.get(tooth, short_name(run, tooth))
    where = AT_PITCH_POINT if tooth == 0 else "ahead" if tooth > 0 else "behind"
    return f"{short_name(run, tooth)} ({where})"


def shown_teeth(run: RunData, curves: Sequence[Engagement]) -> list[int]:
    """Tooth pairs with a contact stress in this pitch at every friction coefficient, the leading pair first; in a
    comparison with a study, its teeth only."""
    candidates = YANG if compares_yang(run.scene) else sorted(np.unique(curves[0].tooth).tolist(), reverse=True)
    return [tooth for tooth in candidates if all(_is_stressed(curve, tooth) for curve in curves)]


def _is_stressed(curve: Engagement, tooth: int) -> bool:
    """Whether the contact stress of a tooth pair is known at some position."""
    here = curve.tooth == tooth
    return bool(np.isfinite(curve.max_pressure[here]).any() and np.isfinite(curve.mean_pressure[here]).any())
