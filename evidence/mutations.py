"""`python -m evidence.mutations [NAME ...]`: checks that tests fail when a line that they protect is changed.

A mutation of mutations.toml exchanges one line of the program, in a copy of the tree, for one that undoes what a line
of docs/edges.md says. Each test that it names must pass before and fail then. The results are kept in
docs/edges_seen.csv, from which `make pages` writes the table of the page. All mutations take more than an hour on one
core; a name runs those that begin with it.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from evidence.checkout import ROOT, python_path
from evidence.tables import markdown, read_csv, write_csv

LIST, SEEN = Path("evidence/mutations.toml"), Path("docs/edges_seen.csv")
PATIENCE = 900.0  # seconds a test; one that hangs has not failed
NOT_THE_EDGE = ("ImportError", "ModuleNotFoundError", "NameError", "SyntaxError")
Seen = set[tuple[str, str, str]]
"""Name of a mutation, its fingerprint, a test that failed."""


@dataclass(frozen=True)
class Mutation:
    """A line of the program exchanged for one that breaks it.

    when: what the program does then, as the table says it.
    file: below the root.
    old: text that stands there once.
    new: what takes its place.
    tests: which have to fail, as module::test or module::test[case], the module a path below tests.
    """

    name: str
    when: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]

    @property
    def fingerprint(self) -> str:
        """Of what is exchanged, wherever the file lies: a mutation that was changed has not been seen."""
        return hashlib.sha256("\0".join((self.old, self.new)).encode()).hexdigest()[:12]

    def applied(self, root: Path) -> str:
        """The file's text with the exchange. Raises ValueError where `old` does not stand there once."""
        text = (root / self.file).read_text(encoding="utf-8")
        if (count := text.count(self.old)) != 1:
            raise ValueError(f"{LIST}: {self.name}: wanted its `old` once in {self.file}, found it {count} times")
        return text.replace(self.old, self.new)


def mutations(root: Path = ROOT) -> list[Mutation]:
    """All of the list, in its order."""
    entries = tomllib.loads((root / LIST).read_text(encoding="utf-8"))
    return [Mutation(name, **{**entry, "tests": tuple(entry["tests"])}) for name, entry in entries.items()]


def seen(root: Path = ROOT) -> Seen:
    """What was seen to fail so far."""
    if not (root / SEEN).exists():
        return set()
    return {(row["mutation"], row["fingerprint"], row["test"]) for row in read_csv(root / SEEN)}


def table(root: Path = ROOT) -> str:
    """The table of docs/edges.md: of each mutation the tests that were seen to fail with it."""
    known, rows = seen(root), []
    for each in mutations(root):
        if tests := [test for test in each.tests if (each.name, each.fingerprint, test) in known]:
            named = ", ".join(f"`{test}`" for test in dict.fromkeys(test.split("[")[0] for test in tests))
            rows.append((each.when, f"`{each.file}`", named))
    return markdown(("the program broken on purpose", "in", "seen to fail"), rows)


def failures(mutation: Mutation, tree: Path) -> tuple[dict[str, str], str]:
    """`failing` of a mutation's tests with it. tree: a copy, which is as before afterwards."""
    file = tree / mutation.file
    whole = file.read_bytes()
    file.write_text(mutation.applied(tree), encoding="utf-8")
    try:
        return failing(mutation.tests, tree)
    finally:
        file.write_bytes(whole)


def failing(tests: Sequence[str], tree: Path) -> tuple[dict[str, str], str]:
    """Which of these tests fail in a tree -> what they say; and pytest's last line."""
    nodes, report = [f"tests/{test.replace('::', '.py::', 1)}" for test in tests], tree / "report.xml"
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={report}", *nodes]
    try:
        done = subprocess.run(
            command, cwd=tree, env={**os.environ, "PYTHONPATH": python_path(tree), "OMP_NUM_THREADS": "1"},
            capture_output=True, text=True, timeout=PATIENCE * len(tests), check=False,
        )
        said = _said(report) if report.exists() else {}
    except subprocess.TimeoutExpired:
        return {}, f"not done after {PATIENCE * len(tests):g} s"
    finally:
        report.unlink(missing_ok=True)
    texts_of = {test: [text for case, text in said.items() if case == test or case.startswith(f"{test}[")]
             for test in tests}
    last = (done.stdout + done.stderr).strip().rpartition("\n")[2]
    return {test: texts[0] for test, texts in texts_of.items() if texts}, last


def _said(report: Path) -> dict[str, str]:
    """What each case that failed says, of a report by pytest; failures that are none of the edge left out."""
    said = {}
    for case in ElementTree.parse(report).getroot().iter("testcase"):
        failure = case.find("failure")
        if failure is not None and not (text := str(failure.get("message"))).startswith(NOT_THE_EDGE):
            module = str(case.get("classname")).removeprefix("tests.").replace(".", "/")
            said[f"{module}::{case.get('name')}"] = text
    return said


def copied(tree: Path) -> None:
    """The files of the checkout that git knows."""
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, names.split("\0")):
        if (ROOT / name).is_file():
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, tree / name, follow_symlinks=False)


def keep(mutation: Mutation, failed: dict[str, str]) -> None:
    """Writes what was seen; of other mutations what was seen before stays."""
    order = [each.name for each in mutations()]
    rows = {row for row in seen() if row[0] in order and row[0] != mutation.name}
    rows |= {(mutation.name, mutation.fingerprint, test) for test in failed}
    ordered = sorted(rows, key=lambda row: (order.index(row[0]), row))
    write_csv(ROOT / SEEN, ("mutation", "fingerprint", "test"), ordered)


def main(names: list[str]) -> int:
    chosen = [each for each in mutations() if not names or each.name.startswith(tuple(names))]
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        copied(tree)
        before, last = failing(list(dict.fromkeys(test for each in chosen for test in each.tests)), tree)
        print(f"the program as it is: {last}", flush=True)
        unseen = sum(see(each, tree, before) for each in chosen)
    print(f"{unseen} tests were not seen to fail")
    return 1 if unseen else 0


def see(mutation: Mutation, tree: Path, before: Collection[str]) -> int:
    """How many of a mutation's tests are not seen to fail; those of `before` fail without it too."""
    failures_of, last = failures(mutation, tree)
    failed = {test: text for test, text in failures_of.items() if test not in before}
    keep(mutation, failed)
    for test in mutation.tests:
        text = failed[test].partition("\n")[0] if test in failed else f"NOT SEEN TO FAIL: {last}"
        print(f"{mutation.name}: {test}: {text[:150]}", flush=True)
    return len(mutation.tests) - len(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
