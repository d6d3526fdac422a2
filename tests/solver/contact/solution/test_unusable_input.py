"""Input that cannot be used is refused by one clear error; unusual input that can be used gives the exact solution."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from evolvent import EvolventError, InputError
from tests.support.api_abuses import bodies, contacts, extremes, meshes, odd_inputs, solutions, steps
from tests.support.api_abuses.blocks import Exact, Refused

REFUSED = [*meshes.ROWS, *bodies.ROWS, *contacts.ROWS, *steps.ROWS, *solutions.ROWS, *extremes.REFUSED]
EXACT = [*odd_inputs.ROWS, *extremes.EXACT]
JARGON = re.compile(
    r"numpy|ufunc|PETSc|UFL|matmul|tuple index|substring|max_gap|attribute|Traceback|NoneType|broadcast"
)


@pytest.mark.parametrize("row", REFUSED, ids=lambda each: each.name)
def test_unusable_input_is_refused(row: Refused, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One error that derives from EvolventError and says what was wanted, what was found and what to do, in the API's
    own words; malformed input is an InputError, hence a ValueError too; nothing is written."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(EvolventError) as caught:
        row.call(tmp_path)
    message = str(caught.value)
    assert isinstance(caught.value, row.error), type(caught.value)
    assert isinstance(caught.value, ValueError) or not issubclass(row.error, InputError)
    assert re.search(r"wanted .+ found .+[;:] \S+", message), message
    assert not JARGON.search(message), message
    for words in row.words:
        assert re.search(words, message), (words, message)
    assert not (tmp_path / "gone").exists()


@pytest.mark.parametrize("row", EXACT, ids=lambda each: each.name)
def test_unusual_input_gives_the_exact_solution(row: Exact, tmp_path: Path) -> None:
    """The number that the row asks for is its exact value, within its accuracy."""
    value, wanted = np.asarray(row.call(tmp_path), dtype=float), np.asarray(row.wanted, dtype=float)
    largest = max(np.abs(wanted).max(initial=0.0), 1e-300)
    assert np.abs(value - wanted).max(initial=0.0) <= row.accuracy * largest, value


def test_table_of_unusable_input_has_150_rows_and_more() -> None:
    """At least 150 rows, each with a name of its own."""
    names = [each.name for each in REFUSED] + [each.name for each in EXACT]
    assert len(names) == len(set(names)) >= 150
