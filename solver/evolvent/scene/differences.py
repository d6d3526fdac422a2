"""In which keys two scenes differ, as far as results depend on them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from evolvent.scene.scene import GEARS, Scene
from evolvent.scene.schema.errors import shown
from evolvent.scene.schema.output import OutputSection, SkipSection
from evolvent.scene.skips import OF_OUTPUT, with_deflected_flanks

MOST = 3
"""Keys that are named."""
NOT_GIVEN = "not given"


def essence(scene: Scene) -> Scene:
    """The scene without its title, what says what else is written, and where its charts lie."""
    ways = SkipSection(off=tuple(name for name in scene.skip.off if name not in OF_OUTPUT))
    bare: dict[str, Any] = {name: getattr(scene, name).model_copy(update={"flank_csv": None}) for name in GEARS}
    return scene.model_copy(update={"title": "", "output": OutputSection(), "skip": ways, **bare})


def charts(scene: Scene) -> list[str]:
    """What the flank charts of both gears say, empty where there is none."""
    return [chart.text() if (chart := scene.flank_chart(name)) else "" for name in GEARS]


def differences(kept: Scene, wanted: Scene) -> str:
    """The keys in which `wanted` differs from the scene that was kept, with both values, the first `MOST` of them;
    empty if there is none. A run that has come to deflected flanks has kept that, which is no difference."""
    found = min((_differing(kept, other) for other in (wanted, with_deflected_flanks(wanted))), key=len)
    more = [f"{len(found) - MOST} more"] if len(found) > MOST else []
    return ", ".join([*found[:MOST], *more])


def _differing(kept: Scene, wanted: Scene) -> list[str]:
    there, here = (_flat(essence(scene).model_dump()) for scene in (kept, wanted))
    keys = [key for key in {**there, **here} if there.get(key) != here.get(key)]
    values = [f"{key} = {_said(here.get(key))} (kept: {_said(there.get(key))})" for key in keys]
    both = zip(GEARS, charts(kept), charts(wanted))
    return values + [f"another chart as {name}.flank_csv" for name, one, other in both if one != other]


def _flat(section: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Dotted key -> value."""
    flat: dict[str, Any] = {}
    for name, value in section.items():
        flat |= _flat(value, f"{prefix}{name}.") if isinstance(value, Mapping) else {f"{prefix}{name}": value}
    return flat


def _said(value: Any) -> str:
    return NOT_GIVEN if value is None else shown(value)
