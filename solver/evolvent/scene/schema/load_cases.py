"""The sections [[load_case]]: a list of loads, each with all that belongs to it."""

from __future__ import annotations

from collections.abc import Sequence

from evolvent.scene.schema.errors import InputProblem, shown
from evolvent.scene.schema.loading import MOST_TORQUES
from evolvent.scene.schema.section import SceneSection, key

NAME = "a text of up to 40 letters, digits, points, hyphens and underscores, a letter or digit first"
ROUNDING = 1e-6
"""Largest amount by which shares of the life may miss 1."""


class LoadCaseSection(SceneSection):
    """[[load_case]]: a load."""

    name: str = key(
        "name of the load case, in tables and of its folder", NAME, "write for example name = \"start\"",
        pattern=r"^[^\W_][\w.-]{0,39}$",
    )
    torque_Nm: float = key(
        "torque that is held constant, on the gear that load.on names", "a number above 0 up to 1e7, in N·m", gt=0,
        le=1e7,
    )
    speed_rpm: float | None = key(
        "speed of the pinion, for the power in losses.csv", "a number above 0 up to 1e6, in r/min",
        "delete the key where no power is asked for", default=None, gt=0, le=1e6,
    )
    share_of_life: float | None = key(
        "share of the life under this load; of all load cases together 1", "a number above 0 up to 1",
        "give the share of 1, not of 100 %; or delete the key in all load cases", default=None, gt=0, le=1,
    )
    misalignment_um: float | None = key(
        "opening of the flanks under this load, as pair.misalignment_um, which it is by default",
        "a number from -1000 to 1000, in µm over the face width", default=None, ge=-1000, le=1000,
    )


def list_problem(cases: Sequence[LoadCaseSection], percents: Sequence[float]) -> InputProblem | None:
    """The problem with a list of load cases; None where there is none. percents: load.percents beside it."""
    if not cases:
        return None
    if percents:
        found = f"load cases, and load.percents = {shown(percents)} beside them"
        return InputProblem("load_case", found, "one list of loads", "delete load.percents, or all load cases")
    if len(cases) > MOST_TORQUES:
        found, allowed = f"{len(cases)} load cases", f"up to {MOST_TORQUES}, each of which costs a run"
        return InputProblem("load_case", found, allowed, "give what is more in another scene")
    return _name_problem(cases) or _share_problem(cases)


def _name_problem(cases: Sequence[LoadCaseSection]) -> InputProblem | None:
    """The problem of names that are the same, or one folder where upper and lower case count as one."""
    names = [each.name.casefold() for each in cases]
    for number, name in enumerate(names):
        if (first := names.index(name)) < number:
            found = f"{shown(cases[number].name)}, which load_case[{first}] is called, too"
            allowed = "different names, also but for upper and lower case"
            return InputProblem(f"load_case[{number}].name", found, allowed, "give each load case a name of its own")
    return None


def _share_problem(cases: Sequence[LoadCaseSection]) -> InputProblem | None:
    """The problem of shares that some load cases are without, or that do not add up to 1."""
    shares = [each.share_of_life for each in cases]
    if missing := [each.name for each in cases if each.share_of_life is None]:
        if len(missing) == len(cases):
            return None
        found, allowed = f"none in {', '.join(missing)}, but one in others", "a share in all load cases, or in none"
        remedy = "give it in these as well, or delete it in the others"
        return InputProblem("load_case.share_of_life", found, allowed, remedy)
    total = sum(share for share in shares if share is not None)
    if abs(total - 1.0) <= ROUNDING:
        return None
    remedy = f"divide each by {total:.10g}, or mend the wrong one"
    return InputProblem("load_case.share_of_life", f"a sum of {total:.10g}", "shares with a sum of 1", remedy)
