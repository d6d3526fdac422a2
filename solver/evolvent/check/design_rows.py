"""Rows of `evolvent check` on [design]: variants, torques and positions, what varies and how it is searched."""

from __future__ import annotations

from evolvent.check.text_table import Row
from evolvent.scene.line_level import LINE
from evolvent.scene.load_cases import load_cases, with_list
from evolvent.scene.scene import Scene
from evolvent.scene.schema.design import LOSS, PERCENTS, DesignSection
from evolvent.scene.schema.errors import InputProblem, shown

VARIES = "What varies", ("from", "to", "step", "values")
"""Title of the table of `varying_rows`, and the heads of its columns."""
DEVIATES = "Tolerances", ("±",)
"""Title of the table of `tolerance_rows`, and the head of its column."""


def design_rows(scene: Scene, section: DesignSection) -> list[Row]:
    """Rows on the variants of a scene with [design], and on what is computed of each."""
    loads, positions = load_cases(with_list(scene, default=PERCENTS)), scene.sweep.positions
    search, count = _search(section)
    solved = (1 + count) * positions * len(loads)
    limits = [f"{figure} {most:g}" for figure, most in section.limits]
    resolved = f"{section.verified} at level {scene.mesh.level}" if scene.mesh.level != LINE else "none at level line"
    within = section.deviations
    return [
        Row("combinations of what varies", "", "", (f"{section.size:,}",)),
        Row("searched by", "", "", (search,)),
        Row("variants computed, beside the scene", "", "", (f"{'' if count == section.size else 'about '}{count:,}",)),
        Row("loads", "", "", (", ".join(each.name for each in loads),)),
        Row("positions of the pitch", "", "", (str(positions),)),
        Row("positions × torques × variants", "", "", (f"{solved:,}",)),
        *([Row("  again with friction, for the loss", "", "", (f"{solved:,}",))] if LOSS in section.asked else []),
        Row("targets", "", "", (", ".join(section.targets),)),
        *([Row("limits", "", "", (", ".join(limits),))] if limits else []),
        *([Row("variants within tolerances, of each best one", "", "", (str(within),))] if within else []),
        Row("best ones with the contact resolved", "", "", (resolved,)),
    ]


def varying_rows(section: DesignSection) -> list[Row]:
    """Rows on what varies: lowest and highest value, step, number of values."""
    return [
        Row(row.key, "", _unit(row.key), (f"{row.lowest:g}", f"{row.highest:g}", f"{row.step:g}", str(row.size)))
        for row in section.vary
    ]


def tolerance_rows(section: DesignSection) -> list[Row]:
    """Rows on what deviates in production, with its amount; none without tolerances."""
    return [Row(row.key, "", _unit(row.key), (f"{row.amount:g}",)) for row in section.tolerances]


def design_refusals(scene: Scene, section: DesignSection) -> list[InputProblem]:
    """Problem of a friction loss without one friction coefficient above 0; none where it is not asked for."""
    friction = scene.contact.friction
    if LOSS not in section.asked or (len(friction) == 1 and friction[0] > 0.0):
        return []
    allowed = f"one coefficient above 0, as [design] has the target or limit {LOSS}"
    remedy = f"give one, 0.05 is usual for lubricated steel; or leave {LOSS} out"
    return [InputProblem("contact.friction", shown(friction), allowed, remedy)]


def design_warnings(scene: Scene) -> list[str]:
    """Reasons why `evolvent design` would refuse a scene with [design]; none where it would not."""
    if scene.design is None:
        return []
    return [f"`evolvent design` would refuse this scene: {each}." for each in design_refusals(scene, scene.design)]


def _search(section: DesignSection) -> tuple[str, int]:
    """How variants are chosen, in words, and about how many."""
    if section.size <= section.samples:
        return "computing all of them", section.size
    words = "an even sample (Sobol)" if section.search == "sobol" else "differential evolution, then by neighbours"
    return words, section.samples


def _unit(key: str) -> str:
    return "µm" if key.endswith("_um") else "mm"
