"""Rows of tables that no computation has made."""

from __future__ import annotations

import math
from typing import Any, TypeVar, get_type_hints

Row = TypeVar("Row")
NOTHING: dict[Any, Any] = {float: math.nan, int: 0, bool: False, str: ""}
"""Type of a field -> its value where none is given."""


def made(kind: type[Row], **given: Any) -> Row:
    """A row with the given fields; of the others numbers are NaN or 0, truths false, texts empty, the rest None."""
    return kind(**{name: given.get(name, NOTHING.get(hint)) for name, hint in get_type_hints(kind).items()})
