"""What runs leave is what docs/outputs.md and docs/summary.schema.json say: files, columns, keys, arrays.

Problem: He's spur pair and Yang's worn pair at their smallest; exact: nothing more, nothing less than the pages have.
"""

from __future__ import annotations

import csv
import json
import re
from copy import deepcopy
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import pyvista

from evidence.pages.outputs import ARRAYS, DEFORMED, FILES, sections
from evolvent.commands.app import main
from evolvent.results.tables.field_texts import field_texts
from evolvent.results.tables.summary_rows import PositionRow, ToothRow
from evolvent.wear.gears.gear_study import BlockRow
from evolvent.wear.results.report import GearReport, PairReport, WearReport
from tests.support.checkout import ROOT

SCHEMA = json.loads((ROOT / "docs" / "summary.schema.json").read_text(encoding="utf-8"))
SHORT = ("sweep.positions=2", "output.animation=false", "output.pictures=false")
HE = (str(ROOT / "demos/he2022.toml"), "--level", "quick", *(word for key in SHORT for word in ("--set", key)))
WEARS = ("--set", "wear.cycles=1e4", "--set", "wear.pinion_mm2_per_N=1e-10")


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of two positions with friction, with fields."""
    folder = tmp_path_factory.mktemp("outputs") / "out"
    more = "--set", "output.deformation=true", "--set", "contact.friction=[0.0,0.1]"
    assert main(["run", *HE, *more, "--quiet", "--out", str(folder)]) == 0
    return folder


@pytest.fixture(scope="module")
def worn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same pair worn a little, without friction."""
    folder = tmp_path_factory.mktemp("outputs") / "worn"
    assert main(["run", *HE, *WEARS, "--set", "wear.report_at_cycles=[5e3]", "--quiet", "--out", str(folder)]) == 0
    return folder


def strict(schema: dict[str, Any]) -> dict[str, Any]:
    """The schema with no key allowed that it does not name."""
    found = deepcopy(schema)
    parts = [found]
    while parts:
        part = parts.pop()
        if "properties" in part:
            part["additionalProperties"] = False
            parts += part["properties"].values()
        parts += [*part.get("anyOf", []), *([part["items"]] if "items" in part else [])]
    return found


def columns(path: Path) -> list[str]:
    """Of a CSV file."""
    with open(path, newline="", encoding="utf-8") as file:
        return next(csv.reader(file))


@pytest.mark.parametrize("kind", ["out", "worn"])
def test_summary_follows_its_schema(kind: str, request: pytest.FixtureRequest) -> None:
    """Of a run, of a wear study and of its worn pairs: no key is missing, none is there that the schema lacks."""
    folder: Path = request.getfixturevalue(kind)
    found = [folder / "summary.json", *folder.glob("worn_*/summary.json")]
    assert len(found) == (1 if kind == "out" else 3)
    for path in found:
        summary = json.loads(path.read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator(strict(SCHEMA)).validate(summary)
        assert next(iter(summary)) == "schema_version"


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("ranks",), "one"),
        (("positions", 0, "teeth", 0, "force_N"), "12 N"),
        (("frictions", 1, "estimated_error", "loss_percent"), [0.1]),
        (("schema_version",), 0),
        (("frictions", 0, "new_key"), 1.0),
        (("mesh", "min_scaled_jacobian"), ...),
    ],
)
def test_another_form_is_seen(path: tuple[Any, ...], value: Any, out: Path) -> None:
    """A text for a number, an older version, a key too many, a key too few (...): refused."""
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    place: Any = summary
    for key in path[:-1]:
        place = place[key]
    if value is ...:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(strict(SCHEMA)).validate(summary)


def test_the_schema_itself_is_one() -> None:
    """As JSON Schema 2020-12 asks for."""
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


@pytest.mark.parametrize("kind", ["out", "worn"])
def test_every_file_is_named(kind: str, request: pytest.FixtureRequest) -> None:
    """Below a run's folder there is nothing that docs/outputs.md does not name."""
    folder: Path = request.getfixturevalue(kind)
    names = [str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()]
    own = [re.sub(r"^worn_[^/]*/", "", name) for name in names]
    assert len(own) > 8
    assert not [name for name in own if not any(fnmatch(name, pattern) for pattern, _ in FILES)]


def test_columns_are_the_keys(out: Path, worn: Path) -> None:
    """positions.csv has a number of teeth for their list, teeth.csv the position before the tooth."""
    row = [name for name in field_texts(PositionRow) if name != "teeth"]
    assert sorted(columns(out / "positions.csv")) == sorted([*row, "teeth_in_contact"])
    assert columns(out / "teeth.csv") == ["pinion_angle_deg", "friction", *field_texts(ToothRow)]
    assert columns(worn / "wear.csv") == list(field_texts(BlockRow))


def test_wear_json_has_the_keys(worn: Path) -> None:
    """Of the study, of a report and of a gear in it."""
    found = json.loads((worn / "wear.json").read_text(encoding="utf-8"))
    assert list(found) == list(field_texts(WearReport))
    assert all(list(report) == list(field_texts(PairReport)) for report in found["reports"])
    gears = [report[name] for report in found["reports"] for name in ("pinion", "wheel")]
    assert all(list(gear) == list(field_texts(GearReport)) for gear in gears)


def test_arrays_for_paraview(out: Path) -> None:
    """The arrays of the flanks, whatever the friction coefficient; the teeth around them have none."""
    flanks = pyvista.read(out / "fields" / "flanks_0000.vtp")
    found = {re.sub(r"mu=[\d.]+", "mu=...", name) for name in flanks.point_data}
    assert found == {name for name, _ in ARRAYS}
    assert list(pyvista.read(out / "fields" / "gears_0000.vtp").point_data) == []
    deformed = pyvista.read(out / "fields" / "deformed_0000.vtu")
    assert {*deformed.point_data, *deformed.cell_data} == {name for name, _ in DEFORMED}


def test_every_class_has_a_section() -> None:
    """Whatever is written is on the page."""
    text = (ROOT / "docs" / "outputs.md").read_text(encoding="utf-8")
    for title, kind, _ in sections():
        part = text.split(f"## {title}\n", 1)[1].split("\n## ", 1)[0]
        assert re.findall(r"^\| `(\w+)`", part, re.MULTILINE) == list(field_texts(kind))
