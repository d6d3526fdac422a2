"""Error bars of `evolvent transient` on He's pair in plane strain: against true errors, and where there are none."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evidence.benchmarks.accuracy.transient_bars import FIGURES, HitRow, hit_rows
from evolvent.contact.newton.snes import NotConverged
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.run.dynamics.transient import cases as module
from evolvent.run.dynamics.transient.summary_lines import summary_lines
from evolvent.run.kinds.transient import Transient
from evolvent.scene.scene import load_scene
from evolvent_meshes.mesh.mesh_data import MeshError
from tests.support.checkout import ROOT
from tests.support.computing.quiet import prepared_without, quietly

SETTINGS = (
    "transient.mesh_periods=200", "dynamics.backlash_um=50", "output.pictures=false", "output.animation=false",
)
TRIED = "mesh.level=quick", "sweep.positions=10", "transient.speeds_rpm=[2000,4200]", "dynamics.damping_ratio=0.03"
RESOLVED = (
    *TRIED, "mesh.level=standard", "sweep.positions=80", "transient.modes_per_harmonic=3", "output.error_bars=false",
)
FEW = "mesh.level=quick", "sweep.positions=6", "transient.speeds_rpm=[3000]", "dynamics.damping_ratio=0.2"


def run(folder: Path, *settings: str) -> list[str]:
    return quietly(Transient.of(load_scene(ROOT / "demos/he2022.toml", [*SETTINGS, *settings])), folder)


def facts(folder: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads((folder / "transient.json").read_text())
    return found


def alike(value: Any) -> Any:
    """A number as another run has it, but for its last digits (docs/checks.md); other values as they are."""
    return pytest.approx(value, rel=1e-6, abs=1e-9, nan_ok=True) if isinstance(value, float) else value


@pytest.fixture(scope="module")
def tried(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("tried")
    run(folder, *TRIED)
    return folder


@pytest.fixture(scope="module")
def few(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("few")
    run(folder, *FEW)
    return folder


@pytest.fixture(scope="module")
def hits(tried: Path, tmp_path_factory: pytest.TempPathFactory) -> list[HitRow]:
    """Ten positions on level quick against eighty on level standard with three modes of each harmonic."""
    folder = tmp_path_factory.mktemp("resolved")
    run(folder, *RESOLVED)
    return list(hit_rows("", tried, folder))


@pytest.mark.evidence
def test_nine_in_ten_bars_hold_the_true_error(hits: list[HitRow], tried: Path) -> None:
    """Near a superharmonic resonance and at the resonance, where the teeth part and meet: all three figures of both
    speeds, and nine in ten values of the columns."""
    apart = facts(tried)[1]["separated"], *(row.separated for row in hits if row.speed == 4200.0)
    assert max(apart) > 0.0
    assert all(row.inside == row.count == 1 for row in hits if row.figure in FIGURES)
    columns = [row for row in hits if row.figure not in FIGURES]
    assert sum(row.count for row in columns) > 100
    assert sum(row.inside for row in columns) >= 0.9 * sum(row.count for row in columns)


@pytest.mark.evidence
def test_bars_say_something(hits: list[HitRow]) -> None:
    """The median bar of the columns is at most six times the median true error."""
    columns = [row for row in hits if row.figure not in FIGURES]
    assert np.median([row.median_bar / row.median_error for row in columns]) < 6.0


def test_every_figure_has_its_bar(few: Path) -> None:
    """All keys with an error have one above zero and below the figure's three times; what is printed has them, too.
    Only a start from rest has that of a start."""
    for fact in facts(few):
        assert fact.pop("start_dynamic_factor") is None is fact.pop("start_dynamic_factor_error")
        names = [name.removesuffix("_error") for name in fact if name.endswith("_error") and f"{name[:-6]}" in fact]
        assert len(names) == 6
        assert all(0.0 < fact[f"{name}_error"] < 3.0 * fact[name] for name in names)
    (line,) = summary_lines(few)
    assert line.startswith("3000 r/min, μ = 0:") and line.count(" ± ") == 5


def test_without_error_bars_all_else_is_the_same(few: Path, tmp_path: Path) -> None:
    """`output.error_bars = false`: nothing of a companion is kept, bars are null, other values the same, in all
    three files."""
    given = few, tmp_path
    run(tmp_path, *FEW, "output.error_bars=false")
    assert not list((tmp_path / "results").glob("*coarse*"))
    for one, other in zip(*map(facts, given)):
        for name in one:
            if name.removesuffix("_error") in one and name.endswith("_error"):
                assert other[name] is None
            else:
                assert other[name] == alike(one[name])
    for name in ("transient.csv", "transient_teeth.csv"):
        tables = [list(csv.DictReader((folder / name).read_text().splitlines())) for folder in given]
        for one, other in zip(*tables, strict=True):
            bars = [key for key in one if key.endswith("_error")]
            assert {other[key] for key in bars} == {"nan"}
            assert all(float(other[key]) == alike(float(one[key])) for key in one if key not in bars)
    assert not any("±" in line for line in summary_lines(tmp_path))


def test_time_is_that_of_the_last_mesh_period(few: Path) -> None:
    """time_s from 0 on in steps of a sixth of the mesh period, 60 s over 3000 and 50 teeth; transient.json has the mesh
    frequency."""
    lines = list(csv.DictReader((few / "transient.csv").read_text().splitlines()))
    times = [float(line["time_s"]) for line in lines]
    assert times == pytest.approx(60.0 / 3000.0 / 50.0 * np.arange(6) / 6.0, rel=1e-8)
    assert facts(few)[0]["mesh_frequency_Hz"] == pytest.approx(3000.0 / 60.0 * 50.0)


def test_a_companion_case_that_fails_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The third motion of the call, that on larger elements in the same steps: the case has no bars, and a sentence
    why."""
    solved, counts = module.until_steady, [0]

    def failing(*given: Any) -> MeshPeriods:
        counts[0] += 1
        if counts[0] == 3:
            raise NotConverged("wanted a solution, found none")
        return solved(*given)

    monkeypatch.setattr(module, "until_steady", failing)
    said = run(tmp_path, *FEW)
    assert said[-1] == (
        "3000 r/min, μ = 0: no error bars, as the motion on elements of twice the size was not found: wanted a "
        "solution, found none"
    )
    (fact,) = facts(tmp_path)
    assert fact["dynamic_factor"] > 1.0
    assert fact["dynamic_factor_error"] is None


def test_a_companion_that_cannot_be_meshed_is_said(tmp_path: Path) -> None:
    """No case has bars, with one sentence."""

    prepare = prepared_without(companion_mesh, MeshError("wanted a mesh, found none"))
    said = quietly(Transient.of(load_scene(ROOT / "demos/he2022.toml", [*SETTINGS, *FEW])), tmp_path, prepare=prepare)
    assert "Error bars: their coarse companion could not be solved: wanted a mesh, found none" in said
    assert facts(tmp_path)[0]["max_pressure_MPa_error"] is None
