"""Every docstring names its subject, so that it can be read alone in an editor's window."""

from __future__ import annotations

import ast
from pathlib import Path

from tests.project.docstrings import Docstring, docstrings, fragments

SAMPLE = '''"""Module."""

LIMIT = 3
"""Of a list."""


class Gear:
    """Gear of a pair."""

    teeth: int
    """Number of teeth."""

    def _cut(self) -> None:
        """The same on a worn flank."""
'''


def test_no_docstring_is_a_fragment() -> None:
    """None begins with "Of ...", "That ...", "The same ...", "See ...": neither of public nor of private names."""
    assert [f"{each.path}:{each.line}: {each.text.splitlines()[0]}" for each in fragments()] == []


def test_all_docstrings_are_found() -> None:
    """Modules, constants, classes, fields and methods of a sample, two of which are fragments, one of them public."""
    from tests.project import docstrings as module

    found = list(module._of_body(Path("sample.py"), "", ast.parse(SAMPLE).body, describes=""))
    assert [each.name for each in found] == ["", "LIMIT", "Gear", "Gear.teeth", "Gear._cut"]
    assert [(each.name, each.public) for each in found if each.is_fragment] == [("LIMIT", True), ("Gear._cut", False)]


def test_the_packages_have_docstrings() -> None:
    """Several thousand, so that the list of fragments is empty for no other reason."""
    found = list(docstrings())
    assert len(found) > 5000 and all(isinstance(each, Docstring) for each in found)
