"""What pictures call the tooth pairs of a pitch: by their numbers in teeth.csv, or as a published study does."""

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
"""The three teeth of Yang et al. 2022 as tooth pairs over the pitch from φ = 0."""
AT_PITCH_POINT = "at the pitch point, φ = 0"


def compares_yang(scene: Scene) -> bool:
    """Whether Yang et al. 2022 is to stand beside the results."""
    return scene.output.compare == "yang2022"


def short_name(run: RunData, tooth: int) -> str:
    """Of a tooth pair: "pair +1" is ahead of pair 0, which passes the pitch point at φ = 0."""
    if compares_yang(run.scene):
        return f"tooth {2 - tooth}"
    return "pair 0" if tooth == 0 else f"pair {signed(tooth, 0)}"


def long_name(run: RunData, tooth: int) -> str:
    """The same with where it is."""
    if compares_yang(run.scene):
        return YANG.get(tooth, short_name(run, tooth))
    where = AT_PITCH_POINT if tooth == 0 else "ahead" if tooth > 0 else "follows"
    return f"{short_name(run, tooth)} ({where})"


def shown_teeth(run: RunData, curves: Sequence[Engagement]) -> list[int]:
    """The tooth pairs with a contact stress in this pitch at every friction coefficient, the one ahead first; of a
    study only its own."""
    candidates = YANG if compares_yang(run.scene) else sorted(np.unique(curves[0].tooth).tolist(), reverse=True)
    return [tooth for tooth in candidates if all(_is_stressed(curve, tooth) for curve in curves)]


def _is_stressed(curve: Engagement, tooth: int) -> bool:
    here = curve.tooth == tooth
    return bool(np.isfinite(curve.max_pressure[here]).any() and np.isfinite(curve.mean_pressure[here]).any())
