"""The table of abilities is what the tests have found.

Problem: reports of pytest. Exact: an ability is there if its test passed, and the kept table has each test of
tests/solver/run/kinds/test_abilities.py for each computation.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from evidence.checkout import DOCS
from evidence.pages.abilities import KEPT, abilities
from evidence.tables import read_csv
from evolvent.run.kinds.all import KINDS
from tests.support.checkout import ROOT

FILE = "tests.solver.run.kinds.test_abilities"
CASE = f'<testcase classname="{FILE}" name="test_it_is_resumed[{{kind}}]">{{outcome}}</testcase>'


def report(folder: Path, **outcomes: str) -> Path:
    path = folder / "junit.xml"
    cases = "".join(CASE.format(kind=kind, outcome=outcome) for kind, outcome in outcomes.items())
    path.write_text(f"<testsuites><testsuite>{cases}</testsuite></testsuites>", encoding="utf-8")
    return path


@pytest.mark.parametrize("outcome", ["<failure/>", "<error/>", "<skipped/>"])
def test_only_what_passed_is_an_ability(tmp_path: Path, outcome: str) -> None:
    """A test that failed, broke or was skipped shows no ability; one with an output only does."""
    found = abilities(report(tmp_path, run=outcome, wear="<system-out>said</system-out>"))
    assert found == [{"ability": "it is resumed", "run": "no", "wear": "yes"}]


def test_another_report_is_refused(tmp_path: Path) -> None:
    """A report without these tests."""
    with pytest.raises(ValueError, match="wanted a report of the tests"):
        abilities(report(tmp_path))


def test_table_is_whole() -> None:
    """The kept table names each test that goes through the computations, and each computation."""
    text = (ROOT / "tests/solver/run/kinds/test_abilities.py").read_text(encoding="utf-8")
    functions = {node.name for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)}
    rows = read_csv(DOCS / KEPT)
    tests = {name for name in functions if name.startswith("test_")}
    assert {f"test_{row['ability'].replace(' ', '_')}" for row in rows} == tests
    assert all(set(row) == {"ability", *(kind.name for kind in KINDS)} for row in rows)
    assert all(cell == "yes" for row in rows for name, cell in row.items() if name != "ability")
