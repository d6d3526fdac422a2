"""Scenes that must be refused, with what the message must say; test_scene.py and test_malformed.py go through them."""

from __future__ import annotations

from tests.support.malformed.forms import WRONG_FORMS
from tests.support.malformed.gears import IMPOSSIBLE_GEARS
from tests.support.malformed.keys import UNSUPPORTED, WRONG_KEYS
from tests.support.malformed.text import NOT_PARSED
from tests.support.malformed.values import WRONG_VALUES

__all__ = ["MALFORMED", "UNSUPPORTED"]

MALFORMED = WRONG_KEYS | WRONG_VALUES | IMPOSSIBLE_GEARS | WRONG_FORMS | NOT_PARSED
"""Case -> scene, overrides; key, what was found and a part of the remedy that the message must have."""
assert len(MALFORMED) == sum(map(len, (WRONG_KEYS, WRONG_VALUES, IMPOSSIBLE_GEARS, WRONG_FORMS, NOT_PARSED)))
