"""Descriptions of the fields of a dataclass: the text below each of them in its class."""

from __future__ import annotations

import ast
import inspect
import textwrap
from dataclasses import is_dataclass
from itertools import pairwise


def field_texts(kind: type) -> dict[str, str]:
    """Field -> the text below it in the class; inherited ones last. Raises ValueError for a field without one."""
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    assert isinstance(tree, ast.ClassDef)
    texts = {}
    for field, text in pairwise([*tree.body, ast.Pass()]):
        if not isinstance(field, ast.AnnAssign):
            continue
        name = ast.unparse(field.target)
        if not (isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)):
            raise ValueError(f"{kind.__name__}.{name}: wanted a text below it that says what it is, found none")
        texts[name] = " ".join(str(text.value.value).split())
    bases = [base for base in kind.__bases__ if is_dataclass(base)]
    return texts | {name: text for base in bases for name, text in field_texts(base).items()}
