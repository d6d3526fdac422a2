"""Figures gathered from the tables of a scene."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from evolvent.run.study.plan.study_file import COMPUTATIONS
from evolvent.run.study.results.figures import CATALOGUE, DEFAULTS
from evolvent.run.study.results.gathering import Figure, Gathering

ROWS = [
    {"friction": 0.0, "peak": 3.0, "estimated_error": {"peak": 0.1}},
    {"friction": 0.1, "peak": 4.0, "estimated_error": None},
]


@pytest.fixture
def scene(tmp_path: Path) -> Gathering:
    (tmp_path / "summary.json").write_text(json.dumps({"title": "a", "dofs": 7, "frictions": ROWS}))
    (tmp_path / "table.csv").write_text("gear,method,value\npinion,a,1\npinion,b,2\nwheel,a,5\nwheel,b,nan\n")
    return Gathering(tmp_path)


def test_each_friction_coefficient_has_a_column(scene: Gathering) -> None:
    """Two coefficients: two columns with their error bars; one of them without one is NaN."""
    found = scene.columns([Figure("peak_um", "summary.json", "peak", "frictions", error="estimated_error.peak")])
    assert list(found) == [
        "peak_um (μ = 0)", "peak_um_error (μ = 0)", "peak_um (μ = 0.1)", "peak_um_error (μ = 0.1)"
    ]  # fmt: skip
    assert list(found.values())[:3] == [3.0, 0.1, 4.0] and math.isnan(found["peak_um_error (μ = 0.1)"])


@pytest.mark.parametrize(
    ("where", "statistic", "value"),
    [
        ({"gear": "pinion", "method": "b"}, "only", 2.0),
        ({"gear": "pinion"}, "max", 2.0),
        ({"gear": "pinion"}, "min", 1.0),
        ({"gear": "pinion"}, "mean", 1.5),
        ({"gear": "pinion"}, "peak_to_peak", 1.0),
        ({"gear": "wheel"}, "last", 5.0),
        ({"value": 5}, "only", 5.0),
        ({"gear": "pinion"}, "only", math.nan),
        ({"gear": "none"}, "max", math.nan),
        ({"gear": "wheel", "method": "b"}, "only", math.nan),
    ],
)
def test_rows_are_chosen(scene: Gathering, where: dict[str, str | int | float], statistic: str, value: float) -> None:
    """By the values of their columns; NaN is no value, and one of several is not chosen."""
    found = scene.columns([Figure("figure", "table.csv", "value", where=where, statistic=statistic)])
    assert found["figure"] == value or (math.isnan(value) and math.isnan(found["figure"]))


def test_what_is_not_there_is_not_a_number(scene: Gathering, tmp_path: Path) -> None:
    """No file, no key, no text of a JSON file."""
    (tmp_path / "broken.json").write_text("{")
    figures = [Figure("a", "none.csv", "x"), Figure("b", "summary.json", "x.y"), Figure("c", "broken.json", "x"),
               Figure("d", "summary.json", "title")]  # fmt: skip
    assert all(math.isnan(value) for value in scene.columns(figures).values())
    assert scene.columns([Figure("dofs", "summary.json", "dofs")]) == {"dofs": 7.0}


def test_defaults_are_in_the_catalogue() -> None:
    """Each computation gathers figures that have a name, each name once."""
    for compute in COMPUTATIONS:
        names = [figure.name for figure in CATALOGUE[compute]]
        assert len(set(names)) == len(names) and set(DEFAULTS[compute]) <= set(names)
