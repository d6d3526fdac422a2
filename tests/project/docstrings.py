"""`python -m tests.project.docstrings [ROOM ...]`: docstrings that cannot be understood without those around them.

An editor shows a docstring alone. One that begins with "Of ...", "That ...", "The same ..." or "See ..." does not name
its subject. Each is listed with its file, line and name; rooms are folders such as solver/evolvent/gears.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.support.checkout import ROOT

TREES = "solver", "meshes"
FRAGMENT = re.compile(
    r"(Of|That|Those|These|Its|Their|Whose|They|It|What|The same|The others?|The rest|See|Likewise|By which|In which|"
    r"Up to which|From which|At which|With which)\b"
)
"""Beginning of a docstring that does not name its subject."""


@dataclass(frozen=True)
class Docstring:
    """A docstring of a module, class, function, field or constant."""

    path: Path
    """File, below the checkout."""
    line: int
    """Line of the file at which the docstring begins."""
    name: str
    """Dotted name of what it describes; that of a module is empty."""
    text: str
    """Docstring."""

    @property
    def public(self) -> bool:
        """Whether no part of the name begins with an underscore."""
        return not any(part.startswith("_") for part in self.name.split("."))

    @property
    def is_fragment(self) -> bool:
        """Whether it does not name its subject."""
        return FRAGMENT.match(self.text) is not None


def docstrings(folders: Sequence[str] = TREES) -> Iterator[Docstring]:
    """All docstrings of the Python files below some folders of the checkout."""
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*.py")):
            yield from _of_body(path.relative_to(ROOT), "", ast.parse(path.read_bytes()).body, describes="")


def _of_body(path: Path, scope: str, body: Sequence[ast.stmt], describes: str) -> Iterator[Docstring]:
    """Docstrings of a block of statements and all below. describes: name that a string at its begin belongs to."""
    subject: str | None = describes
    for node in body:
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            if subject is not None:
                yield Docstring(path, node.lineno, subject, node.value.value)
            continue
        subject = _assigned(node, scope)
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            name = f"{scope}{node.name}"
            yield from _of_body(path, f"{name}.", node.body, name)


def _assigned(node: ast.stmt, scope: str) -> str | None:
    """Name of the field or constant that a statement assigns, None of others."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    names = [each.id for target in targets for each in ast.walk(target) if isinstance(each, ast.Name)]
    return f"{scope}{names[0]}" if names else None


def fragments(folders: Sequence[str] = TREES) -> list[Docstring]:
    """The docstrings that do not name their subject."""
    return [each for each in docstrings(folders) if each.is_fragment]


def main() -> None:
    """Prints a line a fragment, and how many there are."""
    found = fragments(sys.argv[1:] or TREES)
    for each in found:
        print(f"{each.path}:{each.line}: {each.name}: {each.text.splitlines()[0]}")
    print(f"{len(found)} fragments, {sum(each.public for each in found)} of public names")


if __name__ == "__main__":
    main()
