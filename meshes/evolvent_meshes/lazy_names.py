"""Public names of a package, each imported from its module when it is first used (PEP 562).

A package lists them once, in its `__init__.py`, as imports that only a type checker runs:

    if TYPE_CHECKING:
        from package.room.module import Name as Name
    else:
        __all__, __getattr__, __dir__ = lazy_names(__name__)

The library lazy-loader does not serve here: its stubs name only what lies below the package, and the public names of
`evolvent.gears` come from its sister rooms and from `evolvent_meshes`, too.
"""

from __future__ import annotations

import ast
import difflib
import inspect
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

Door = tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]


def lazy_names(package: str) -> Door:
    """Values of `__all__`, `__getattr__` and `__dir__` of a package for the names below its `if TYPE_CHECKING:`.

    A name may be one of a module, or a module. An unknown one raises AttributeError with the nearest public one.
    """
    this = sys.modules[package]
    modules = _modules(inspect.getsource(this))

    def find(name: str) -> Any:
        if name not in modules:
            raise AttributeError(_unknown(package, name, list(modules)))
        home = import_module(modules[name])
        value = vars(home)[name] if name in vars(home) else import_module(f"{modules[name]}.{name}")
        setattr(this, name, value)
        return value

    return sorted(modules), find, lambda: sorted(modules)


def _modules(source: str) -> dict[str, str]:
    """Name -> its module, of the imports that only a type checker runs."""
    blocks = [node for node in ast.parse(source).body if isinstance(node, ast.If)]
    imports = [each for block in blocks if ast.unparse(block.test) == "TYPE_CHECKING" for each in block.body]
    froms = [each for each in imports if isinstance(each, ast.ImportFrom)]
    return {alias.name: str(each.module) for each in froms for alias in each.names}


def _unknown(package: str, name: str, names: list[str]) -> str:
    nearest = difflib.get_close_matches(name, names, n=1)
    remedy = f"did you mean {nearest[0]}?" if nearest else f"dir({package}) lists the public names"
    return f"{package}: wanted a public name, found {name!r}; {remedy}"
