"""`python -m evidence.pages.abilities JUNIT.xml`: which computation has which ability, by a report of the tests.

The tests are those of tests/solver/run/kinds/test_abilities.py, which go through every entry of `KINDS`; the report is
that of `pytest --junitxml`. Keeps docs/abilities.csv, from which `make pages` writes the table of docs/computation.md.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from xml.etree import ElementTree

from evidence.checkout import DOCS
from evidence.tables import markdown, read_csv, write_csv

KEPT = Path("abilities.csv")
TESTS = "solver.run.kinds.test_abilities"
NAME = re.compile(r"test_(?P<ability>\w+)\[(?P<kind>\w+)\]")


def abilities(report: Path) -> list[dict[str, str]]:
    """A row per ability: computation -> "yes" where its test passed, "no" where it failed or was skipped. Raises
    ValueError where the report has no such test, OSError, ElementTree.ParseError."""
    rows: dict[str, dict[str, str]] = {}
    for case in ElementTree.parse(report).iter("testcase"):
        if case.attrib["classname"].endswith(TESTS) and (found := NAME.fullmatch(case.attrib["name"])):
            ability = found["ability"].replace("_", " ")
            failed = any(case.find(outcome) is not None for outcome in ("failure", "error", "skipped"))
            rows.setdefault(ability, {"ability": ability})[found["kind"]] = "no" if failed else "yes"
    if not rows:
        raise ValueError(f"{report}: wanted a report of the tests {TESTS}, found none of them")
    return list(rows.values())


def table(docs: Path = DOCS) -> str:
    """The table of docs/computation.md."""
    rows = read_csv(docs / KEPT)
    return markdown(list(rows[0]), [list(row.values()) for row in rows], ())


if __name__ == "__main__":
    found = abilities(Path(sys.argv[1]))
    write_csv(DOCS / KEPT, list(found[0]), [[row.get(name, "no") for name in found[0]] for row in found])
