"""docs/edges.md names tests that exist, and each of them was seen to fail."""

from __future__ import annotations

import ast
import re

import pytest

from evidence.mutations import Mutation, mutations, seen
from tests.support.checkout import ROOT

NAMED = re.findall(r"`([\w/]*test_\w+)::(\w+)`", (ROOT / "docs/edges.md").read_text(encoding="utf-8"))


def test_named_tests_exist() -> None:
    """Every `module::test` of the page is a function of that module of the tests."""
    assert len(NAMED) > 80
    functions = {
        module: {node.name for node in ast.parse((ROOT / f"tests/{module}.py").read_bytes()).body
                 if isinstance(node, ast.FunctionDef)}
        for module, _ in NAMED
    }
    assert [f"{module}::{name}" for module, name in NAMED if name not in functions[module]] == []


@pytest.mark.parametrize("mutation", mutations(), ids=lambda each: each.name)
def test_mutations_fit_the_program(mutation: Mutation) -> None:
    """What a mutation exchanges stands once in its file, and something else takes its place."""
    assert mutation.applied(ROOT) != (ROOT / mutation.file).read_text(encoding="utf-8")


def test_each_was_seen_to_fail() -> None:
    """Every test of the page has failed with a mutation as it stands in the list."""
    fingerprints = {each.name: each.fingerprint for each in mutations()}
    failed = {test.split("[")[0] for name, fingerprint, test in seen() if fingerprints.get(name) == fingerprint}
    missing = sorted({f"{module}::{name}" for module, name in NAMED} - failed)
    assert not missing, f"add mutations to evidence/mutations.toml and run `python -m evidence.mutations`: {missing}"
