"""Suggestions for a line that is no TOML: numbers and texts as they are written elsewhere."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass

NUMBER = r"\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?"
WORDS = {"True": "true", "TRUE": "true", "False": "false", "FALSE": "false", "yes": "true", "no": "false"}
MINUS = "−–—﹣－"
"""Characters that look like a minus sign."""
QUOTES = "“”„‟«»‘’‚`´"
"""Characters that look like quotation marks."""
CONTROL = re.compile(r"[\x00-\x08\x0a-\x1f\x7f]")
QUOTED = re.compile(r"\"(?:\\.|[^\"\\])*\"|'[^']*'")


@dataclass(frozen=True)
class WrittenOtherwise:
    """Error in a text that is no TOML, and its form in TOML."""

    found: str
    """Part of the text that is no TOML, and its description."""
    remedy: str
    """Remedy: how to write the part in TOML."""


@dataclass(frozen=True)
class _Habit:
    """A way of writing that TOML does not have."""

    pattern: str
    """Regular expression for the part, in a value without its quoted texts."""
    name: str
    """Description of the part."""
    written: Callable[[str], str]
    """Function from the part to the remedy."""


HABITS: tuple[_Habit, ...] = (
    _Habit(r"[\d.)]\s*(?:\*\*?|/|\^)\s*[\d.(][^,\]]*", "a calculation",
           lambda _: "write its result: TOML does not calculate"),
    _Habit(rf"[{MINUS}]\s*[\d.]+", "a dash that is no minus sign of TOML, U+{code}", lambda part: _write(
        "-" + part[1:].strip(), "with the hyphen of the keyboard")),
    _Habit(rf"[{QUOTES}][^{QUOTES}]*[{QUOTES}]", "a text in other quotation marks", lambda part: _write(
        f'"{part[1:-1]}"')),
    _Habit(r"(?<![\w.])[-+]?\.\d+(?:[eE][-+]?\d+)?", "a number without a digit before its point", lambda part: _write(
        part.replace(".", "0.", 1).lstrip("+"))),
    _Habit(r"(?<![\w.])[-+]?\d+\.(?![\d\w])", "a number without a digit behind its point", lambda part: _write(
        f"{part}0")),
    _Habit(rf"(?<![\w.])[-+]?{NUMBER}[dD][-+]?\d+", "an exponent with d", lambda part: _write(
        part.replace("d", "e").replace("D", "e"))),
    _Habit(r"(?<![\w.\[,])[-+]?\d+,\d[\d,.]*\s*$", "a comma in a number",
           lambda _: "a decimal point, not a comma, and nothing between thousands"),
    _Habit(r"(?<![\w.])\d{1,3}(?:Cr|Mn|Ni)[\w.+-]*", "the name of a material",
           lambda _: "no list of materials: give E_GPa and nu in [material]"),
    _Habit(rf"(?<![\w.])[-+]?{NUMBER}\s*(?:[^\W\d_]|[°%])[^\s,\]]*", "a number with a unit", lambda part: _write(
        re.match(rf"[-+]?{NUMBER}", part)[0],  # type: ignore[index]
        "no unit after a number")),
    _Habit(r"(?<![\w.])[-+]?0\d+(?![\w.])", "a number with zeros in front", lambda part: _write(
        re.sub(r"0+(?=\d)", "", part, count=1))),
    _Habit(r"[\u00a0\u2007\u2009\u202f]", "a space that is no space of TOML, U+{code}",
           lambda _: "write a plain space, or none"),
    _Habit(r"(?<=\s)(?://|;|%|!)\s.*$", "a comment", lambda _: "begin comments with #"),
    _Habit(r"^\s*[^\W\d][\w-]*(?: [\w-]+)*\s*$", "a text without quotes", lambda part: _write(
        WORDS.get(part.strip(), f'"{part.strip()}"'),
        "" if part.strip() in WORDS else 'texts stand in "quotes"')),
)


def written_otherwise(line: str) -> WrittenOtherwise | None:
    """Error in a line `key = value` that is no TOML, with a remedy; None where it is not known."""
    _, equals, value = line.partition("=")
    if not equals:
        yaml = re.fullmatch(r"\s*[\w.-]+\s*:\s.*", line)
        return WrittenOtherwise(f"{line.strip()}, a colon", "write = between a key and its value") if yaml else None
    return value_written_otherwise(value)


def value_written_otherwise(value: str) -> WrittenOtherwise | None:
    """Error in a value that is no TOML, with a remedy; None where it is not known, is TOML or has control characters.
    """
    if _is_toml(value) or CONTROL.search(value):
        return None
    plain = QUOTED.sub('""', value).partition("#")[0]
    for habit in HABITS:
        if found := re.search(habit.pattern, plain):
            part = found[0].strip() or found[0]
            name = habit.name.format(code=f"{ord(part[0]):04X}")
            return WrittenOtherwise(f"{part}, {name}" if part.isprintable() else name, habit.written(part))
    return None


def _is_toml(value: str) -> bool:
    try:
        tomllib.loads(f"value = {value}")
    except (ValueError, RecursionError):
        return False
    return True


def _write(text: str, more: str = "") -> str:
    return f"write {text}{more and '; '}{more}"
