"""Which key was meant by one that does not exist: one that is written alike, or one that means it."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping

NEAR, NEARLY_THE_SAME = 0.7, 0.85
"""How alike keys are (`difflib`) for the one to be meant by the other; where the other may be something unsupported."""
LONGEST = 60
GREEK = {"alpha": "α", "beta": "β", "mu": "μ", "nu": "ν", "rho": "ρ"}


def nearest_key(name: str, here: Mapping[str, str], everywhere: Mapping[str, str], strict: bool = False) -> str:
    """The dotted key that was meant, looked for in its own section first; empty if there is none.

    here, everywhere: dotted keys and what they mean. strict: only one that is written nearly the same.
    """
    if len(name) > LONGEST:
        return ""
    for keys in (here, everywhere):
        if same := [key for key in keys if key.rsplit(".", 1)[-1].lower() == name.lower()]:
            return same[0]
    for keys in (here, everywhere):
        stems = {_stem(key): key for key in reversed(list(keys))}
        if match := difflib.get_close_matches(_stem(name), stems, n=1, cutoff=NEARLY_THE_SAME if strict else NEAR):
            return stems[match[0]]
    wanted = {GREEK.get(word, word) for word in _words(_stem(name))}
    if strict or not wanted:
        return ""
    return next((key for keys in (here, everywhere) for key in keys if wanted <= _meaning(key, keys[key])), "")


def _meaning(key: str, text: str) -> set[str]:
    """The words of a key and of the first phrase of what it means, whose last one is its symbol."""
    phrase = re.split(r"[,;:]", text)[0]
    return _words(f"{_stem(key)} {phrase}") - {"a", "the", "of"} | set(phrase.lower().split()[-1:])


def _stem(key: str) -> str:
    """The last part of a key without its unit, in small letters."""
    return re.sub(r"_(mm|um|deg|Nm|GPa|m|mm2_per_N|Pa|MPa|N)$", "", key.rsplit(".", 1)[-1]).lower()


def _words(text: str) -> set[str]:
    """In small letters, without apostrophes and signs."""
    return set(re.findall(r"[^\W_]+", text.replace("'", "").lower()))
