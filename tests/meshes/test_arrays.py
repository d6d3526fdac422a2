"""Types of arrays have one name each in both packages."""

from __future__ import annotations

import re
from collections import Counter

from tests.support.checkout import ROOT

ALIAS = re.compile(r"^(\w+)(?:: TypeAlias)? = (NDArray\[.*?\])", re.MULTILINE)


def test_array_types_are_defined_once() -> None:
    """Neither a name nor a type of `Name = NDArray[...]` stands twice below solver and meshes."""
    files = [path for root in ("solver", "meshes") for path in sorted((ROOT / root).rglob("*.py"))]
    aliases = [found for path in files for found in ALIAS.findall(path.read_text(encoding="utf-8"))]
    names, types = (Counter(column) for column in zip(*aliases))
    assert {"Floats", "Ints", "Bools"} <= set(names)
    assert [name for name, count in (names + types).items() if count > 1] == []
