"""Suggestions for an unknown key or section: by tables of words, by its spelling, by its name elsewhere."""

from __future__ import annotations

from collections.abc import Collection

from evolvent.scene.schema.guesses.gear_terms import GEAR_TERMS
from evolvent.scene.schema.guesses.nearest_key import nearest_key
from evolvent.scene.schema.guesses.other_terms import LIST_TERMS, OTHER_TERMS, SECTION_TERMS, STUDY_TERMS
from evolvent.scene.schema.guesses.terms import Meant, meant_by
from evolvent.scene.schema.guesses.units import are_of_one_quantity, stem_of

KEY_TERMS = {"scene": (*GEAR_TERMS, *OTHER_TERMS), "study": STUDY_TERMS}
"""Kind of file -> terms for its keys."""
DEEP = 2
"""Number of dots of keys that are not suggested in other sections: those of gauges and of the materials of single
gears."""


def meant_key(name: str, section: str, here: Collection[str], everywhere: Collection[str], kind: str) -> Meant | None:
    """Probable meaning of an unknown key; None where there is none.

    section:    dotted, that it is in; empty for the top of the file.
    here:       dotted keys of this section.
    everywhere: those of all sections.
    kind:       of the file, of `KEY_TERMS`.
    """
    stem = stem_of(name)
    if same := [key for key in here if stem_of(key) == stem and are_of_one_quantity(name, key)]:
        return Meant((nearest_key(name, same) or same[0],), "")
    for word in (name.lower(), stem):  # m_n ends with no unit
        if meant := meant_by(word, section, KEY_TERMS[kind]):
            return meant
    if near := nearest_key(name, here):
        return Meant((near,), "")
    named = [key for key in everywhere if key.count(".") < DEEP and key.rpartition(".")[2].lower() == name.lower()]
    return Meant(tuple(named), "") if "_" in name and named else None  # single words name other things elsewhere


def meant_section(
    name: str, parent: str, here: Collection[str], kind: str, is_listed: bool = False
) -> Meant | None:
    """Probable meaning of an unknown section; None where there is none. Parameters as of `meant_key`, with sections in
    place of keys. is_listed: whether it is a list of sections."""
    terms = (*SECTION_TERMS, *(LIST_TERMS if is_listed else ())) if kind == "scene" else STUDY_TERMS
    if meant := meant_by(name.lower().replace(" ", "_"), parent, terms):
        return meant
    near = nearest_key(name, here)
    return Meant((near,), "") if near else None
