"""Numbers and texts that TOML does not have: the message names the line, the part and what to write."""

from __future__ import annotations

import tomllib

import pytest

from evolvent.scene.scene import SceneError, scene_from_text
from evolvent.scene.schema.guesses.meant_toml import value_written_otherwise
from tests.support.running.scene_effects import BARE

WRITTEN = {
    "−5": ("U+2212", "write -5"), "–5.5": ("U+2013", "write -5.5"), ".5": ("point", "write 0.5"),
    "-.5e3": ("point", "write -0.5e3"), "+.5": ("point", "write 0.5"), "5.": ("point", "write 5.0"),
    "250,5": ("comma", "a decimal point"), "1,000": ("comma", "a decimal point"),
    "250 Nm": ("unit", "write 250; no unit"),
    "250Nm": ("unit", "write 250; no unit"), "20°": ("unit", "write 20; no unit"), "5 %": ("unit", "write 5; no unit"),
    "[1 mm, 2 mm]": ("1 mm", "write 1; no unit"), "007": ("zeros", "write 7"), "1d-3": ("exponent", "write 1e-3"),
    "1.5D2": ("exponent", "write 1.5e2"), "“quick”": ("quotation", 'write "quick"'),
    "quick": ("quotes", 'write "quick"'),
    "True": ("quotes", "write true"), "\u00a05": ("U+00A0", "plain space"), "5 // torque": ("comment", "with #"),
    "18CrNiMo7-6": ("the name of a material", "no list of materials: give E_GPa and nu in [material]"),
    "25.4/8": ("calculation", "write its result"), "[.5, 1.0]": (".5,", "write 0.5"),
}
"""Value that is no TOML -> what the message must have of what was found, and of the remedy."""


@pytest.mark.parametrize("value", WRITTEN)
def test_a_line_that_is_no_toml_is_explained(value: str) -> None:
    """The line with its number, the part, and what to write; none of the words of the library that reads TOML."""
    found, wanted = WRITTEN[value]
    text = BARE.replace("[wear]\n", f"[wear]\ntolerance = {value}\n")
    line = next(n for n, each in enumerate(text.split("\n"), 1) if each.startswith("tolerance"))
    with pytest.raises(SceneError) as caught:
        scene_from_text(text)
    [problem] = caught.value.problems
    assert problem.found.startswith(f"no TOML in line {line}, tolerance =") and found in problem.found
    assert wanted in problem.remedy
    assert not any(words in str(problem) for words in ("Invalid value", "Expected", "column"))


@pytest.mark.parametrize("value", [value for value in WRITTEN if value not in ("quick", "True", "\u00a05")])
def test_overrides_are_explained_alike(value: str) -> None:
    """`--set` has the same remedies; bare words and spaces around a value are allowed there."""
    with pytest.raises(SceneError) as caught:
        scene_from_text(BARE, [f"wear.tolerance={value}"])
    assert WRITTEN[value][1] in caught.value.problems[0].remedy


@pytest.mark.parametrize(
    "value", ['"a − b"', '"5 mm, 1/3"', "'.5'", "[1.0, 2.0]", "1e-3", "-0.5", "+5", "2022-01-01", "0x1F", "1_000"]
)
def test_what_is_toml_is_left_alone(value: str) -> None:
    """Texts in quotes may have anything; numbers of TOML are none of these."""
    assert tomllib.loads(f"a = {value}")
    assert value_written_otherwise(value) is None


def test_a_colon_is_no_equals_sign() -> None:
    """A line as in YAML."""
    with pytest.raises(SceneError, match=r"line \d+, cycles: 3: cycles: 3, a colon;.*remedy: write = between"):
        scene_from_text(BARE + "\ncycles: 3\n")


def test_other_mistakes_keep_the_words_of_the_reader() -> None:
    """Nothing is guessed of a text without an end."""
    assert value_written_otherwise('"abc') is None
    with pytest.raises(SceneError, match=r"no TOML: .*mend that line"):
        scene_from_text(BARE + '\ntitle = "abc\n')
