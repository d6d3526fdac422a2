"""Key figures of a worn pair in words, printed at the end of its study."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from evolvent.results.tables.headlines import figure_texts
from evolvent.scene.plain_text import cycles_label
from evolvent.scene.scene import GEARS, Scene


def load_words(scene: Scene) -> str:
    """The load under which a scene's contact is computed, for titles and lines."""
    given = scene.dynamics
    if given is not None and given.operating_rpm is not None:
        return f"under the mesh force of the vibration at {given.operating_rpm:g} r/min"
    return f"under {scene.load.torque_Nm:g} N·m on the {scene.load.on}"


def worn_lines(report: Path, unworn: list[str], scene: Scene) -> list[str]:
    """Lines on the pair before the study and after its last block. report: wear.json; unworn: lines of the pair before.
    """
    worn = json.loads(report.read_text(encoding="utf-8"))["reports"][-1]
    depths = ", ".join(_depth(worn[gear], gear) for gear in GEARS if worn[gear]["deepest_um"] > 0.0)
    figures = ", ".join([f"worn off at most {depths}" if depths else "nothing worn off", *figure_texts(worn, {})])
    after = f"after {cycles_label(worn['cycles'])} cycles: {figures}; without error bars; wear.json has all reports"
    return [f"{load_words(scene)}:", *(f"unworn, {line}" for line in unworn), after]


def _depth(gear: Mapping[str, Any], name: str) -> str:
    return f"{gear['deepest_um']:.3g} µm ({name}, d = {gear['at_diameter_mm']:.2f} mm)"
