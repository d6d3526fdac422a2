"""The examples in docstrings run and print what they say, and the main public names have one."""

from __future__ import annotations

import doctest
from importlib import import_module
from pathlib import Path

import pytest

import evolvent
import evolvent.gears
import evolvent.wear
from tests.support.checkout import ROOT

SOURCES = (ROOT / "solver", ROOT / "meshes")
ALL = [(root, path) for root in SOURCES for path in sorted(root.rglob("*.py"))]
FILES = [path.relative_to(root) for root, path in ALL if ">>> " in path.read_text(encoding="utf-8")]
SHOWN = (
    evolvent.Body, evolvent.Material, evolvent.MeshData, evolvent.Problem, evolvent.Contact, evolvent.Step,
    evolvent.read_msh, evolvent.solve, evolvent.sweep, evolvent.gears.GearParameters.from_rack, evolvent.gears.GearPair,
    evolvent.gears.GearProblem, evolvent.gears.condense, evolvent.wear.Archard, evolvent.wear.BlockSettings,
)


@pytest.mark.parametrize("path", FILES, ids=lambda path: ".".join(path.with_suffix("").parts))
def test_examples_print_what_they_say(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All examples of a module, in an empty folder, in which none leaves a file."""
    monkeypatch.chdir(tmp_path)
    done = doctest.testmod(import_module(".".join(path.with_suffix("").parts)))
    assert done.attempted > 0 and done.failed == 0
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("shown", SHOWN, ids=lambda shown: shown.__qualname__)
def test_main_names_have_an_example(shown: object) -> None:
    """A docstring of a main public name shows how it is used."""
    assert ">>> " in str(shown.__doc__)
