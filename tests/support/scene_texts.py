"""Scenes of the papers as text, to be read, changed or broken by tests."""

from __future__ import annotations

import re

from tests.support.checkout import ROOT

DEMOS = ROOT / "demos"
YANG = (DEMOS / "yang2022.toml").read_text(encoding="utf-8")
"""A helical pair."""
HE = (DEMOS / "he2022.toml").read_text(encoding="utf-8")
"""A spur pair."""
FIRST = (DEMOS / "first_pair.toml").read_text(encoding="utf-8")
"""A helical pair with tip relief, without a given centre distance."""
WEAR = ["wear.cycles=1e6", "wear.pinion_mm2_per_N=1e-10"]
"""Overrides with which the flanks of a scene wear."""


def without(text: str, start: str) -> str:
    """The scene without the first line that begins with `start`."""
    return re.sub(rf"^{re.escape(start)}.*\n", "", text, count=1, flags=re.MULTILINE)
