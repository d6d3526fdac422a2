"""docs/edges.md names tests that exist."""

from __future__ import annotations

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[1]


def test_named_tests_exist() -> None:
    """Every `module::test` of the page is a function of that module of the tests."""
    named = re.findall(r"`(test_\w+)::(\w+)`", (ROOT / "docs/edges.md").read_text(encoding="utf-8"))
    assert len(named) > 80
    functions = {
        module: {node.name for node in ast.parse((ROOT / f"tests/{module}.py").read_bytes()).body
                 if isinstance(node, ast.FunctionDef)}
        for module, _ in named
    }  # fmt: skip
    assert [f"{module}::{name}" for module, name in named if name not in functions[module]] == []
