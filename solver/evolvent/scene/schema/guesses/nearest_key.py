"""Guesses the key that was meant by an unknown one, from its spelling or from the meaning of keys."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Mapping

NEAR, NEARLY_THE_SAME = 0.7, 0.85
"""Least similarity of two keys (difflib's ratio): usually, and where the unknown key may ask for something that is not
supported."""
LONGEST = 60
"""Longest key that is compared [characters]."""
CONVERSIONS = {
    ("Nmm", "Nm"): "divide by 1000", ("kNm", "Nm"): "multiply by 1000", ("MPa", "GPa"): "divide by 1000",
    ("Pa", "GPa"): "divide by 1e9", ("um", "mm"): "divide by 1000", ("mm", "um"): "multiply by 1000",
    ("m", "mm"): "multiply by 1000", ("cm", "mm"): "multiply by 10", ("rad", "deg"): "multiply by 180/π",
}  # fmt: skip
"""Unit given, unit wanted -> what to do."""
SYNONYMS = {
    "inner_diameter": "bore_diameter", "inside_diameter": "bore_diameter", "hole_diameter": "bore_diameter",
    "outer_diameter": "tip_diameter", "outside_diameter": "tip_diameter", "addendum_diameter": "tip_diameter",
    "dedendum_diameter": "root_diameter",
}  # fmt: skip
"""Other name of a key, without unit -> its own."""
GREEK = {"alpha": "α", "beta": "β", "mu": "μ", "nu": "ν", "rho": "ρ"}


def nearest_key(name: str, here: Mapping[str, str], everywhere: Mapping[str, str], strict: bool = False) -> str:
    """The dotted key that was meant, empty where there is none.

    here:       dotted key -> meaning, of the section that the unknown key is in; nearly the same spelling here goes
                before the same spelling in another section.
    everywhere: the same of all sections.
    strict:     require nearly the same spelling.
    """
    if len(name) > LONGEST:
        return ""
    if meant := SYNONYMS.get(_stem(name)):
        return next((key for keys in (here, everywhere) for key in keys if _stem(key) == meant), "")
    cutoff = NEARLY_THE_SAME if strict else NEAR
    similar = (
        _same(name, here), _close(name, here, NEARLY_THE_SAME, _last), _close(name, here, NEARLY_THE_SAME, _stem),
        _same(name, everywhere), _close(name, here, cutoff, _stem), _close(name, everywhere, cutoff, _stem),
    )  # fmt: skip
    if found := next(filter(None, similar), ""):
        return found
    wanted = {GREEK.get(word, word) for word in _words(_stem(name))}
    if strict or not wanted:
        return ""
    return next((key for keys in (here, everywhere) for key in keys if wanted <= _meaning(key, keys[key])), "")


def _same(name: str, keys: Mapping[str, str]) -> str:
    """The first key of this name, in whatever case; empty where there is none."""
    return next((key for key in keys if _last(key) == name.lower()), "")


def _close(name: str, keys: Mapping[str, str], cutoff: float, part: Callable[[str], str]) -> str:
    """The key of which a part is spelled most alike; empty where none is alike by the cutoff."""
    parts = {part(key): key for key in reversed(list(keys))}
    return next((parts[match] for match in difflib.get_close_matches(part(name), parts, n=1, cutoff=cutoff)), "")


def unit_conversion(name: str, meant: str) -> str:
    """What makes a value in the unit that ends an unknown key one in the unit of the key that was meant.

    Empty where the two name the same unit, or one of them none that is known.
    """
    return CONVERSIONS.get((name.rsplit("_", 1)[-1], meant.rsplit("_", 1)[-1]), "")


def _meaning(key: str, text: str) -> set[str]:
    """The words of a key and of the first phrase of its meaning, the last of which is the symbol."""
    phrase = re.split(r"[,;:]", text)[0]
    return _words(f"{_stem(key)} {phrase}") - {"a", "the", "of"} | set(phrase.lower().split()[-1:])


def _last(key: str) -> str:
    """The last part of a key, in lower case."""
    return key.rsplit(".", 1)[-1].lower()


def _stem(key: str) -> str:
    """The last part of a key without its unit, in lower case."""
    return re.sub(r"_(mm|um|deg|Nm|GPa|m|mm2_per_N|Pa|MPa|N|rpm)$", "", key.rsplit(".", 1)[-1]).lower()


def _words(text: str) -> set[str]:
    """The words of a text in lower case, without apostrophes and punctuation."""
    return set(re.findall(r"[^\W_]+", text.replace("'", "").lower()))
