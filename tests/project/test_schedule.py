"""Workers of pytest-xdist get the files that take longest first."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from tests.support.checkout import ROOT
from tests.support.running.schedule import durations, longest_files_first, update


def test_longest_files_come_first() -> None:
    """Files are ordered by their seconds; one without an entry stands at the median, and a file's tests keep their
    order."""
    seconds = {"test_brief.py": 0.1, "test_long.py": 90.0, "test_medium.py": 4.0, "test_other.py": 5.0}
    collected = [("test_brief.py", 0), ("test_new.py", 0), ("test_other.py", 0), ("test_long.py", 1),
                 ("test_long.py", 0), ("test_medium.py", 0)]
    items: list[Any] = [SimpleNamespace(path=ROOT / file, number=number) for file, number in collected]
    longest_files_first(items, ROOT, seconds)
    assert [(item.path.name, item.number) for item in items] == [
        ("test_long.py", 1), ("test_long.py", 0), ("test_other.py", 0), ("test_new.py", 0), ("test_medium.py", 0),
        ("test_brief.py", 0),
    ]


def test_durations_are_those_of_reports(tmp_path: Path) -> None:
    """Two reports of pytest are added up; a file that was not measured keeps its seconds, one that is gone has none."""
    (tmp_path / "tests").mkdir()
    for name in ("test_a.py", "test_b.py"):
        (tmp_path / "tests" / name).touch()
    table = tmp_path / "durations.csv"
    table.write_text("file,seconds\ntests/test_a.py,9.0\ntests/test_b.py,7.0\ntests/test_gone.py,8.0\n")
    reports = []
    for number, times in enumerate([(1.0, 0.5), (2.0,)]):
        cases = "".join(f'<testcase classname="tests.test_a" name="test_x" time="{time}" />' for time in times)
        reports.append(tmp_path / f"{number}.xml")
        reports[-1].write_text(f"<testsuites><testsuite>{cases}</testsuite></testsuites>")
    update(reports, tmp_path, table)
    assert durations(table) == {"tests/test_a.py": 3.5, "tests/test_b.py": 7.0}


def test_most_files_have_a_duration() -> None:
    """At least nine in ten test files stand in the table: where fewer do, it has to be measured again."""
    files = {path.relative_to(ROOT).as_posix() for path in (ROOT / "tests").rglob("test_*.py")}
    assert len(files & durations().keys()) >= 0.9 * len(files)
