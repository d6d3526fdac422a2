"""The list of layers in docs/design.md is true: it has every file, and a file imports only from files before it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("meshes", "solver", "wear", "demos", "evidence")
FILES = [path.relative_to(ROOT) for name in PACKAGES for path in sorted((ROOT / name).rglob("*.py"))]
Import = tuple[str, str]


def layers() -> list[str]:
    """The list's file names, patterns of paths such as "solver/plots*.py", as they stand from the top down."""
    text = (ROOT / "docs/design.md").read_text(encoding="utf-8")
    section = re.search(r"^## Layers.*?(?=^## )", text, re.DOTALL | re.MULTILINE)
    assert section is not None, 'docs/design.md: wanted a section "Layers", found none'
    found, package = [], ""
    for row in re.finditer(r"^ {4}(?:(\w+/)| ) *((?:[\w*]+\.py(?:, )?)+)", section.group(), re.MULTILINE):
        package = row.group(1) or package
        found += [package + name for name in row.group(2).removesuffix(", ").split(", ")]
    return found


def layer(path: str, order: list[str]) -> int:
    """Where a file stands in the list; a package's __init__.py before all, because it is run before them."""
    places = [i for i, pattern in enumerate(order) if fnmatch(path, pattern)]
    if not places and path.endswith("/__init__.py"):
        return -1
    assert len(places) == 1, f"docs/design.md: wanted {path} in the list of layers once, found it {len(places)} times"
    return places[0]


def imports() -> set[Import]:
    """(a, b) where file a imports from file b; imports for type hints alone are left out."""
    return {(str(path), target) for path in FILES for target in _targets(ast.parse((ROOT / path).read_bytes()))}


def _targets(tree: ast.Module) -> Iterator[str]:
    hints = [node for node in ast.walk(tree) if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)]
    skipped = {id(node) for block in hints for statement in block.body for node in ast.walk(statement)}
    for node in (node for node in ast.walk(tree) if id(node) not in skipped):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"wanted absolute imports, found {ast.unparse(node)!r}"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        yield from (target for name in names if (target := _file(name)))


def _file(name: str) -> str | None:
    """The file of one of our packages that "solver.body" or "solver.body.Body" stands for."""
    if name.split(".")[0] not in PACKAGES:
        return None
    path = Path(*name.split("."))
    for candidate in (path.with_suffix(".py"), path / "__init__.py", path.parent.with_suffix(".py")):
        if candidate in FILES:
            return str(candidate)
    return str(path.parent / "__init__.py")


def against(order: list[str]) -> set[Import]:
    """The imports of a file from a later layer."""
    return {(a, b) for a, b in imports() if layer(a, order) < layer(b, order)}


def test_imports_follow_the_layers() -> None:
    """No file imports from a layer below its own in the list."""
    found = against(layers())
    assert not found, f"docs/design.md: wanted imports from layers above only, found {sorted(found)}"


def test_list_is_complete() -> None:
    """Every file stands in the list once, and every name in the list is a file's."""
    order = layers()
    placed = {layer(str(path), order) for path in FILES}
    assert [name for i, name in enumerate(order) if i not in placed] == []


def test_other_orders_are_refused() -> None:
    """The check can fail: with the list upside down every import is against it, with two layers exchanged those that
    join them."""
    order = layers()
    across = {(a, b) for a, b in imports() if layer(a, order) != layer(b, order) and layer(b, order) >= 0}
    assert ("solver/body.py", "solver/traction.py") in across
    assert against(order[::-1]) == across
    body, traction = order.index("solver/body.py"), order.index("solver/traction.py")
    order[body], order[traction] = order[traction], order[body]
    assert ("solver/body.py", "solver/traction.py") in against(order)
