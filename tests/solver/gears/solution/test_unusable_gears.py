"""Gear data and calls of the gear API that cannot be used are refused by one clear error at the line that has them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from evolvent import EvolventError, InputError
from tests.support.api_abuses import gears
from tests.support.api_abuses.blocks import Refused


@pytest.mark.parametrize("row", gears.ROWS, ids=lambda each: each.name)
def test_unusable_gears_are_refused(row: Refused, tmp_path: Path) -> None:
    """One InputError that says what was wanted or is allowed, what was found and what to do."""
    with pytest.raises(EvolventError) as caught:
        row.call(tmp_path)
    message = str(caught.value)
    assert isinstance(caught.value, InputError) and isinstance(caught.value, row.error), type(caught.value)
    assert re.search(r"wanted .+ found .+; \S+|found .+[,;] allowed.+[.;] \S+", message), message
    assert "NoneType" not in message, message
    for words in row.words:
        assert re.search(words, message), (words, message)


def test_rows_have_names_of_their_own() -> None:
    """At least 40 rows."""
    names = [row.name for row in gears.ROWS]
    assert len(names) == len(set(names)) >= 40
