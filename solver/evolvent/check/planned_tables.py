"""Tables of `evolvent check` on the sections that commands beyond `evolvent run` read: [[load_case]], [dynamics],
[transient], [fatigue] and [design]. Each table stands where the scene has its section."""

from __future__ import annotations

from evolvent.check.design_rows import DEVIATES, VARIES, design_rows, tolerance_rows, varying_rows
from evolvent.check.load_rows import LOADS, load_rows
from evolvent.check.text_table import table
from evolvent.check.transient_rows import STEPS, step_lines, transient_lines
from evolvent.scene.scene import GEARS, Scene
from evolvent.scene.skips import wanted_output
from evolvent.strength.fatigue.criterion import criteria_of


def planned_tables(scene: Scene) -> list[str]:
    """Tables on the sections [[load_case]], [dynamics], [transient], [fatigue] and [design], where the scene has
    them."""
    loads = [table(LOADS[0], load_rows(scene), LOADS[1])] if scene.load_case else []
    return [*loads, *_vibration(scene), *_transient(scene), *_fatigue(scene), *_design(scene)]


def _vibration(scene: Scene) -> list[str]:
    if scene.dynamics is None:
        return []
    from evolvent.check.vibration_rows import vibration_lines  # Numba takes a second to import

    return [table("Vibration", vibration_lines(scene, scene.dynamics), GEARS)]


def _transient(scene: Scene) -> list[str]:
    if scene.transient is None:
        return []
    lines = transient_lines(scene, scene.transient, wanted_output(scene).error_bars)
    return [
        table("Transient contact", lines),
        table(STEPS[0], step_lines(scene, scene.transient), STEPS[1]),
    ]


def _fatigue(scene: Scene) -> list[str]:
    """Line on the criteria of [fatigue] and the number of depths at which they are evaluated."""
    if scene.fatigue is None:
        return []
    names = ", ".join(criterion.words for criterion in criteria_of(scene.fatigue.yield_stress_MPa))
    count, deepest = len(scene.fatigue.depths), scene.fatigue.depths[-1]
    return [f"Contact fatigue\n  {count} depths down to {deepest:g} half-widths of the contact: {names}"]


def _design(scene: Scene) -> list[str]:
    """Tables on the variants, on what varies and on tolerances."""
    if scene.design is None:
        return []
    within = tolerance_rows(scene.design)
    return [
        table("Design (variants in line contact)", design_rows(scene, scene.design)),
        table(VARIES[0], varying_rows(scene.design), VARIES[1]),
        *([table(DEVIATES[0], within, DEVIATES[1])] if within else []),
    ]
