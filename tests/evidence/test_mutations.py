"""Mutations: what counts as a failure that was seen, and that a tree is left as it was."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from evidence import mutations
from evidence.mutations import Mutation, failures

PROGRAM = "def half(x: float) -> float:\n    return x / 2.0\n"
TESTS = """
import pytest
from program import half

@pytest.mark.parametrize("x", [0.0, 3.0])
def test_half(x): assert half(x) == 0.5 * x
def test_of_nothing(): assert half(0.0) == 0.0
def test_other_name(): half(third)
"""
HALF = Mutation("half", "", "program.py", "x / 2.0", "x / 4.0", ("test_program::test_half",))


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A program and its tests."""
    (tmp_path / "program.py").write_text(PROGRAM)
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests/test_program.py").write_text(TESTS)
    return tmp_path


def test_mutation_fails_the_tests_that_see_it(tree: Path) -> None:
    """Of a program that divides by 4: a test fails if one of its cases does; one that cannot see it passes, one that
    fails for another reason (NameError) does not count. The program is as before."""
    tests = "test_half", "test_half[0.0]", "test_half[3.0]", "test_of_nothing", "test_other_name"
    found, last = failures(replace(HALF, tests=tuple(f"test_program::{test}" for test in tests)), tree)
    assert set(found) == {"test_program::test_half", "test_program::test_half[3.0]"}
    assert "0.75 ==" in found["test_program::test_half"]
    assert last.startswith("2 failed, 2 passed")
    assert (tree / "program.py").read_text() == PROGRAM
    assert sorted(path.name for path in tree.iterdir() if path.is_file()) == ["program.py"]


def test_a_program_that_cannot_be_imported_is_no_failure(tree: Path) -> None:
    """A mutation that breaks the import: its test is not seen to fail."""
    assert failures(replace(HALF, new="import"), tree)[0] == {}


@pytest.mark.parametrize("before", [(), ("test_program::test_half",)])
def test_what_fails_anyway_is_not_seen(before: tuple[str, ...], tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A test that fails with the mutation is kept as seen, but not where it fails on the program as it is, too."""
    kept: list[str] = []
    monkeypatch.setattr(mutations, "keep", lambda mutation, failed: kept.extend(failed))
    assert mutations.see(HALF, tree, before) == len(before)
    assert kept == [test for test in HALF.tests if test not in before]


def test_the_old_text_stands_once(tree: Path) -> None:
    """Text that is not there, or there twice, is refused with its count."""
    for old, count in (("x / 3.0", 0), ("x", 2)):
        with pytest.raises(ValueError, match=rf"half: wanted its `old` once in program\.py, found it {count} times"):
            replace(HALF, old=old).applied(tree)


def test_a_changed_mutation_was_not_seen() -> None:
    """Its fingerprint is another one; other words for it, or other tests, change nothing."""
    assert replace(HALF, new="x / 3.0").fingerprint != HALF.fingerprint
    assert replace(HALF, when="x is quartered", tests=()).fingerprint == HALF.fingerprint
