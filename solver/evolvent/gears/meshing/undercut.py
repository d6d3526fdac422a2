"""Warnings of gears whose rack takes a part of the involute away."""

from __future__ import annotations

from collections.abc import Iterator

from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.member import Member


def undercut_warnings(problem: GearProblem) -> Iterator[str]:
    """A sentence on each gear that its rack undercuts."""
    for member, gear in zip(Member, problem.pair.gears):
        if gear.is_undercut:
            active = problem.pair.active_start_diameters[member]
            yield (
                f"The rack undercuts the {member.label}: its involute begins at the root form diameter "
                f"{gear.root_form_diameter:.4f} mm, where it meets the fillet in a corner (base circle "
                f"{gear.base_diameter:.4f} mm, start of active profile {active:.4f} mm); more profile shift or teeth "
                "avoid it."
            )
