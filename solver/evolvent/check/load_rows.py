"""Rows of `evolvent check` on [[load_case]]: the loads, and what commands that take them would refuse."""

from __future__ import annotations

from collections.abc import Iterator

from evolvent.check.text_table import Row
from evolvent.scene.load_cases import in_space_sentence, load_cases, misalignment_refusal, under_cases
from evolvent.scene.scene import Scene, SceneError

LOADS = "Load cases (loads, losses, excitation, design)", ("torque N·m", "r/min", "life", "opening µm")
"""Title of the table of `load_rows`, and the heads of its columns."""


def load_rows(scene: Scene) -> list[Row]:
    """A row for each load case, the lightest first: torque, speed of the pinion, share of the life, misalignment."""
    return [
        Row(each.name, "", "", (
            f"{each.torque_Nm:g}", _known(each.speed_rpm), _known(each.share_of_life), f"{each.misalignment_um:g}"
        )) for each in load_cases(scene)
    ]


def load_warnings(scene: Scene) -> Iterator[str]:
    """Sentences on what the other figures of the check are for, and on load cases that are refused or in space."""
    if not scene.load_case:
        return
    own, cases = scene.load.torque_Nm, load_cases(scene)
    yield (
        f"Figures are for load.torque_Nm, {own:g} N·m, and pair.misalignment_um; load cases go up to "
        f"{cases[-1].torque_Nm:g} N·m."
    )
    try:
        yield from in_space_sentence(scene, under_cases(scene).values())
    except SceneError as error:
        yield f"`evolvent loads` would refuse this scene: {error}."
    if problem := misalignment_refusal(cases):
        yield f"`evolvent excitation` and `design` would refuse this scene: {problem}."


def _known(value: float | None) -> str:
    return "" if value is None else f"{value:g}"
