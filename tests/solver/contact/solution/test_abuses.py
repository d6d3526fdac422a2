"""The table of abuses: each is refused by one clear error, or gives the right number."""

from __future__ import annotations

import re

import numpy as np
import pytest

from evolvent import EvolventError, InputError
from tests.support.abuses import bodies as api_body_abuses
from tests.support.abuses import extremes as api_large_abuses
from tests.support.abuses import meshes as api_mesh_abuses
from tests.support.abuses import odd_inputs as api_odd_inputs
from tests.support.abuses import steps as api_step_abuses
from tests.support.abuses.blocks import Abuse, Fine

ABUSES = [*api_mesh_abuses.ROWS, *api_body_abuses.ROWS, *api_step_abuses.ROWS, *api_large_abuses.ABUSES]
FINE = [*api_odd_inputs.ROWS, *api_large_abuses.FINE]
JARGON = re.compile(
    r"numpy|ufunc|PETSc|UFL|matmul|tuple index|substring|max_gap|attribute|Traceback|NoneType|broadcast"
)


@pytest.mark.parametrize("abuse", ABUSES, ids=lambda each: each.name)
def test_abuse(abuse: Abuse, tmp_path, monkeypatch):
    """One error that derives from EvolventError and says what was wanted, what was found and what to do, in the API's
    own words; malformed input is an InputError, hence a ValueError too; nothing is written."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(EvolventError) as caught:
        abuse.call(tmp_path)
    message = str(caught.value)
    assert isinstance(caught.value, abuse.error), type(caught.value)
    assert isinstance(caught.value, ValueError) or not issubclass(abuse.error, InputError)
    assert re.search(r"wanted .+ found .+[;:] \S+", message), message
    assert not JARGON.search(message), message
    for words in abuse.words:
        assert re.search(words, message), (words, message)
    assert not (tmp_path / "gone").exists()


@pytest.mark.parametrize("fine", FINE, ids=lambda each: each.name)
def test_odd_but_right(fine: Fine, tmp_path):
    """What looks odd and is right gives the exact number."""
    found, wanted = np.asarray(fine.call(tmp_path), dtype=float), np.asarray(fine.wanted, dtype=float)
    assert np.abs(found - wanted).max(initial=0.0) <= fine.accuracy * max(np.abs(wanted).max(initial=0.0), 1e-300), (
        found
    )


def test_enough_of_them():
    """At least 150 abuses, each under a name of its own."""
    names = [each.name for each in (*ABUSES, *FINE)]
    assert len(names) == len(set(names)) >= 150
