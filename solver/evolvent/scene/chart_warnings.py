"""Warnings on a scene's flank charts, which every command gives: input that is not used as it stands."""

from __future__ import annotations

from pathlib import Path

from evolvent.gears.problem.flank_deviations import shown_path
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene


def chart_warnings(scene: Scene) -> list[str]:
    """A sentence on each chart that does not end where the face of its gear does."""
    found = gear_problem(scene).extended_charts
    names = {gear: Path(getattr(scene, gear.label).flank_csv).name for gear in found}
    return [f"{gear.label}.flank_csv, {shown_path(names[gear])}: {words}." for gear, words in found.items()]
