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
    ]
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
               Figure("d", "summary.json", "title")]
    assert all(math.isnan(value) for value in scene.columns(figures).values())
    assert scene.columns([Figure("dofs", "summary.json", "dofs")]) == {"dofs": 7.0}


@pytest.mark.parametrize(
    ("figure", "why"),
    [
        (Figure("a", "none.csv", "x"), "none.csv is not there, or has no rows"),
        (Figure("a", "summary.json", "x", rows="friction"), "summary.json is not there, or has no list 'friction'"),
        (Figure("a", "table.csv", "valu"), "table.csv has no 'valu'"),
        (
            Figure("a", "summary.json", "estimated_error.peek", "frictions"),
            "summary.json has no 'estimated_error.peek'",
        ),
        (Figure("a", "table.csv", "value", where={"gear": "none"}), "no row of table.csv has gear = 'none'"),
        (Figure("a", "table.csv", "value", where={"gear": "pinion"}), "table.csv has several rows of it: name one by"),
        (Figure("a", "table.csv", "value", where={"gear": "wheel", "method": "b"}), ""),
        (Figure("a", "summary.json", "dofs"), ""),
    ],
)
def test_why_a_figure_is_missing(scene: Gathering, figure: Figure, why: str) -> None:
    """A reason where the study asks for what is not there; none where the computation leaves a cell empty."""
    found = scene.why_missing(figure)
    assert found.startswith(why) and bool(found) == bool(why)


def test_transient_has_error_bars_and_says_whether_it_is_steady(tmp_path: Path) -> None:
    """Problem: two speeds, one of them not steady. Exact: the largest figures of both, each with its error bar behind
    it; 0 for steady; peak to peak of one motion, not from one speed to the other."""
    keys = "steady", "peak_to_peak_um", "peak_to_peak_um_error", "max_pressure_MPa", "max_pressure_MPa_error"
    facts = [dict(zip(keys, values)) for values in ((True, 2.0, 0.1, 900.0, 9.0), (False, 3.0, 0.2, 800.0, 8.0))]
    (tmp_path / "transient.json").write_text(json.dumps(facts))
    rows = "10,0.5,5,7", "20,0.6,7,9", "30,0.7,55,7", "25,0.6,58,8"
    header = "mesh_force_N,mesh_force_N_error,transmission_error_um,max_pressure_MPa\n"
    (tmp_path / "transient.csv").write_text(header + "\n".join(rows) + "\n")
    named = {figure.name: figure for figure in CATALOGUE["transient"]}
    assert Gathering(tmp_path).columns([named[name] for name in DEFAULTS["transient"]]) == {
        "largest_mesh_force_N": 30.0, "largest_mesh_force_N_error": 0.7, "transmission_error_peak_to_peak_um": 3.0,
        "transmission_error_peak_to_peak_um_error": 0.2, "largest_pressure_MPa": 900.0,
        "largest_pressure_MPa_error": 9.0, "steady": 0.0,
    }


def test_a_link_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    """A file of the scene's folder that is a link to another one elsewhere has no figures."""
    folder = tmp_path / "scene"
    folder.mkdir()
    (tmp_path / "secret.json").write_text('{"a": 1}')
    (folder / "own.json").symlink_to(tmp_path / "secret.json")
    assert math.isnan(Gathering(folder).columns([Figure("a", "own.json", "a")])["a"])


@pytest.mark.parametrize("statistic", ["only", "max", "mean", "peak_to_peak"])
@pytest.mark.parametrize(
    "content",
    [
        "5", "null", "[1]", '"a"', "[" * 100_000, '{"a":' * 100_000, '{"rows": 5}', '{"rows": {"a": 1}}',
        '{"rows": [{"a": 1e999}, {"a": -1e999}]}', '{"rows": [{"a": 1%s}]}' % ("0" * 400), '{"rows": [{"a": [1]}]}',
        '{"rows": [NaN, {"a": NaN}]}', "a\n" + "1" * 200_000, "\0",
    ],
)
def test_forged_tables_have_no_figures(tmp_path: Path, content: str, statistic: str) -> None:
    """What is no table, or no finite number, is NaN, as JSON and as CSV; nothing else is raised."""
    for name in ("forged.json", "forged.csv"):
        (tmp_path / name).write_text(content)
        figures = [Figure("a", name, "b" if name.endswith("csv") else "a", "rows", statistic=statistic)]
        assert math.isnan(Gathering(tmp_path).columns(figures)["a"])


def test_defaults_are_in_the_catalogue() -> None:
    """Each computation gathers figures that have a name, each name once."""
    assert CATALOGUE.keys() == DEFAULTS.keys() <= set(COMPUTATIONS)
    for compute in CATALOGUE:
        names = [figure.name for figure in CATALOGUE[compute]]
        assert len(set(names)) == len(names) and set(DEFAULTS[compute]) <= set(names)
