"""Bodies that cannot be: each rule on a web, by the key that its error names."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from evolvent_meshes.gears.errors import GeometryError
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.gears.form.web import Web
from tests.support.paper_pairs import he_gear

WRONG_WEBS: list[tuple[str, dict[str, Any], str]] = [
    ("no web", {"web": 8.0}, "web"),
    ("text", {"web": Web("8", 6.0)}, "web_thickness"),  # type: ignore[arg-type]
    ("wider than the face", {"web": Web(20.5, 6.0)}, "web_thickness"),
    ("foil", {"web": Web(0.9, 6.0)}, "web_thickness"),
    ("not a number", {"web": Web(math.nan, 6.0)}, "web_thickness"),
    ("beside the face", {"web": Web(8.0, 6.0, offset=-6.5)}, "web_offset"),
    ("offset that is not a number", {"web": Web(8.0, 6.0, offset=math.nan)}, "web_offset"),
    ("rim of less than a module", {"web": Web(8.0, 2.9)}, "rim_thickness"),
    ("rim down to the bore", {"web": Web(8.0, 36.0)}, "rim_thickness"),
    ("rim down to the hub", {"web": Web(8.0, 20.0, 100.0)}, "rim_thickness"),
    ("hub within the bore", {"web": Web(8.0, 6.0, 70.0)}, "hub_diameter"),
    ("hub up to the teeth", {"web": Web(8.0, 6.0, 140.0)}, "hub_diameter"),
    ("support of a web", {"web": Web(8.0, 6.0), "support": Support(5.0)}, "support_width"),
]


@pytest.mark.parametrize(("change", "key"), [e[1:] for e in WRONG_WEBS], ids=[e[0] for e in WRONG_WEBS])
def test_impossible_webs(change: dict[str, Any], key: str) -> None:
    """He's gear, b = 20, bore 70, d_f = 142.5 mm: the error names the key, what was found, what is allowed and the
    remedy."""
    with pytest.raises(GeometryError) as caught:
        replace(he_gear(), **change)
    assert caught.value.key == key
    assert all([caught.value.found, caught.value.allowed, caught.value.remedy])


def test_body_of_a_web() -> None:
    """s_R is the web's rim, its diameters d_f − 2 s_R and the hub's or the bore's; of a web as wide as the face all are
    those of the full ring."""
    gear, hub, bored, full = (
        he_gear(), *(replace(he_gear(), web=each) for each in (Web(8.0, 6.0, 90.0, 1.0), Web(8.0, 6.0), Web(20.0, 6.0)))
    )
    assert hub.web is not None and hub.web.ends == (-3.0, 5.0)
    assert (hub.rim_thickness, hub.web_diameters, hub.has_rim) == (6.0, (130.5, 90.0), True)
    assert bored.web_diameters == (130.5, 70.0)
    for each in (gear, full):
        assert (each.rim_thickness, each.web_diameters, each.has_rim) == (36.25, (70.0, 70.0), False)
