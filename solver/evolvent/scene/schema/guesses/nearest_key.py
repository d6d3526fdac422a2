"""Suggestion of the key that is spelled most like an unknown one."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from evolvent.scene.schema.guesses.units import are_of_one_quantity, stem_of

ALIKE = 0.85
"""Least similarity of two keys without their units (difflib's ratio)."""
ALIKE_WORDS = 0.7
"""Least similarity of each pair of words of two keys: `root_relief` is no `end_relief`."""
SHORT = 3
"""Words of at most so many letters are alike only where they are equal, or one is the other without a letter."""
LONGEST = 60
"""Longest key that is compared [characters]."""


def nearest_key(name: str, keys: Iterable[str]) -> str:
    """The dotted key that is spelled most alike, empty where none is alike enough."""
    if len(name) > LONGEST:
        return ""
    alike = {key: likeness(name, key) for key in keys if are_of_one_quantity(name, key)}
    best = max(alike, key=lambda key: alike[key], default="")
    return best if alike.get(best) else ""


def likeness(name: str, key: str) -> float:
    """Similarity of two keys, from `ALIKE` to 1; 0 where they are not similar enough."""
    one, other = stem_of(name), stem_of(key)
    if one == other:
        return 1.0 + (name.lower() == key.rpartition(".")[2].lower())
    joined = one.replace("_", ""), other.replace("_", "")
    if joined[0] == joined[1]:
        return 1.0
    whole, words = _ratio(*joined), (one.split("_"), other.split("_"))
    if len(words[0]) != len(words[1]):
        return whole if whole >= ALIKE and "_" not in one else 0.0
    return whole if whole >= ALIKE and all(_alike(*pair) for pair in zip(*words)) else 0.0


def _alike(one: str, other: str) -> bool:
    """Whether two words may be one word, misspelled."""
    if one == other:
        return True
    return min(len(one), len(other)) > SHORT and _ratio(one, other) >= ALIKE_WORDS


def _ratio(one: str, other: str) -> float:
    """Similarity of two texts; letters that are swapped do not count."""
    swapped = len(one) > SHORT and one[0] == other[0] and sorted(one) == sorted(other)
    return ALIKE if swapped else difflib.SequenceMatcher(None, one, other).ratio()
