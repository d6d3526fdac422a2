"""Keys in which two scenes differ, among those that results depend on."""

from __future__ import annotations

from typing import Any

from evolvent.scene.scene import GEARS, Scene, derived_values
from evolvent.scene.scene_text import flat_keys
from evolvent.scene.schema.errors import shown
from evolvent.scene.schema.old_names import first_names
from evolvent.scene.schema.output import ExactSection, OutputSection
from evolvent.scene.skips import OF_OUTPUT, with_deflected_flanks

MOST = 3
"""Largest number of keys that a message names."""
NOT_GIVEN = "not given"
PERCENTS = "load.percents"


def essence(scene: Scene) -> Scene:
    """The scene without the parts that its results do not depend on: title, output, the paths of flank charts, the
    other loads of a list, and variants of its flanks."""
    exact = ExactSection(parts=tuple(name for name in scene.exact.parts if name not in OF_OUTPUT))
    alone = scene.model_copy(update={"load_case": ()})
    bare = alone.changed("load", percents=()).changed("pinion", flank_csv=None).changed("wheel", flank_csv=None)
    return bare.model_copy(update={"title": "", "output": OutputSection(), "exact": exact, "design": None})


def identity(scene: Scene) -> list[Any]:
    """All that the results of a scene depend on, as JSON has it: its values, those derived from them, and its flank
    charts. Keys have their first names, so that it is the same in all versions."""
    bare = essence(scene)
    of_load = {"percents"} if bare.load.driving == "wheel" else {"percents", "driving"}
    later: dict[str, bool | set[str]] = {"load": of_load, "design": True, "load_case": True}
    values = bare.model_dump(mode="json", exclude=later)  # as the first versions had none of them
    return [first_names(values), derived_values(bare), *charts(scene)]


def charts(scene: Scene) -> list[str]:
    """Contents of both gears' flank charts, empty where there is none."""
    return [chart.text() if (chart := scene.flank_chart(name)) else "" for name in GEARS]


def differences(kept: Scene, wanted: Scene) -> str:
    """The first `MOST` keys in which `wanted` differs from the archived scene `kept`, with both values.

    Empty where no key differs. That a run has switched to deflected flanks by itself is no difference.
    """
    differing = min((_differing(kept, other) for other in (wanted, with_deflected_flanks(wanted))), key=len)
    more = [f"{len(differing) - MOST} more"] if len(differing) > MOST else []
    return ", ".join([*differing[:MOST], *more])


def _differing(kept: Scene, wanted: Scene) -> list[str]:
    """Each differing key with both values."""
    there, here = (flat_keys(essence(scene).model_dump()) for scene in (kept, wanted))
    if (of_kept := _listed(kept)) and (of_wanted := _listed(wanted)):  # of commands that solve a list of loads
        there, here = there | of_kept, here | of_wanted
    keys = [key for key in {**there, **here} if there.get(key) != here.get(key)]
    values = [f"{key} = {_said(here.get(key))} (kept: {_said(there.get(key))})" for key in keys]
    both = zip(GEARS, charts(kept), charts(wanted))
    return values + [f"another chart as {name}.flank_csv" for name, one, other in both if one != other]


def _listed(scene: Scene) -> dict[str, Any]:
    """Each key of the list of loads that a scene gives, none where it gives no list."""
    cases = [(number, each.model_dump(exclude_none=True)) for number, each in enumerate(scene.load_case)]
    found = {f"load_case[{number}].{name}": value for number, values in cases for name, value in values.items()}
    return found | ({PERCENTS: scene.load.percents} if scene.load.percents else {})


def _said(value: Any) -> str:
    return NOT_GIVEN if value is None else shown(value)
