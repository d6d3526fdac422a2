"""Tables of terms: words of users for a quantity, and the keys of a scene for it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

GEARS = ("pinion", "wheel")
GEAR = "gear"
"""Section of either gear in the tables of terms."""


@dataclass(frozen=True)
class Term:
    """Words of users for one quantity."""

    words: str
    """The words, separated by spaces, in lower case, without their unit. A word that has this meaning in one section
    only has the section in front: `pair.a`."""
    keys: tuple[str, ...] = ()
    """Dotted keys of the scene that hold the quantity; `gear.` stands for `pinion.` or `wheel.`. Without any the scene
    has no key for it."""
    note: str = ""
    """Conversion of the value, if not by its unit; or the reason why there is no key."""
    source: str = ""
    """Standard, or kind of program, that uses these words."""


@dataclass(frozen=True)
class Meant:
    """Keys of a scene that an unknown key may stand for."""

    keys: tuple[str, ...]
    """Dotted keys as they are written in the file; none where the scene has no key for it."""
    note: str
    """Conversion of the value, if not by its unit; or the reason why there is no key."""


def meant_by(stem: str, section: str, terms: Iterable[Term]) -> Meant | None:
    """Keys that a word stands for in a section; None where no table has it.

    stem: the word in lower case, without its unit. section: dotted, empty for the top of the file.
    """
    in_table = GEAR if section in GEARS else section.partition(".")[0]
    whole = f"{in_table}.{stem}"
    found = {word: term for term in terms for word in term.words.split() if word in (stem, whole)}
    term = found.get(whole) or found.get(stem)
    if term is None:
        return None
    return Meant(tuple(_written(key, section) for key in _both(term.keys, section)), term.note)


def _both(keys: tuple[str, ...], section: str) -> tuple[str, ...]:
    """The keys, with those of a gear once for each gear where the section is not that of one."""
    of_gears = GEARS if section not in GEARS else (GEAR,)
    return tuple(
        f"{gear}.{key.removeprefix('gear.')}" if key.startswith("gear.") else key
        for key in keys for gear in (of_gears if key.startswith("gear.") else ("",))
    )


def _written(key: str, section: str) -> str:
    """A key as it is written in the file: with the gear of the section in place of `gear.`; others unchanged."""
    return f"{section}.{key.removeprefix('gear.')}" if key.startswith("gear.") else key
