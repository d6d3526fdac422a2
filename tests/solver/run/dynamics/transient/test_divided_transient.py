"""`evolvent transient` with a tolerance, on He's pair in plane strain at one speed and two friction coefficients."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from evolvent.run.dynamics.transient import cases as module
from evolvent.run.dynamics.transient.kept_cases import KeptCases
from evolvent.run.kinds.transient import Transient
from evolvent.scene.scene import Scene, load_scene
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly

POSITIONS, TOLERANCE = 10, 0.008
TABLES = "transient.csv", "transient_teeth.csv", "transient.json"
SETTINGS = (
    "mesh.level=quick", f"sweep.positions={POSITIONS}", "contact.friction=[0.0,0.2]", "transient.speeds_rpm=[2000]",
    f"transient.tolerance={TOLERANCE}", "transient.modes_per_harmonic=1",
    "dynamics.damping_ratio=0.2", "dynamics.backlash_um=50", "output.pictures=false", "output.animation=false",
    "output.error_bars=false",
)


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022.toml", [*SETTINGS, *settings])


def facts(folder: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads((folder / "transient.json").read_text(encoding="utf-8"))
    return found


def rows(path: Path) -> list[list[float]]:
    with open(path, encoding="utf-8") as stream:
        return [[float(value) for value in row.values()] for row in csv.DictReader(stream)]


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of the motions nothing has to be said: they are steady, the tolerance is reached. Of the tables, that 4.5
    positions lie in a period of the pair's own vibration, once a speed."""
    folder = tmp_path_factory.mktemp("divided")
    _, seen, said = quietly(Transient.of(scene()), folder)
    assert "4.26 positions a period; wanted 8: the tables" in seen
    assert "elements across the contact" in said
    return folder


def test_a_coarse_tolerance_is_named(tmp_path: Path) -> None:
    """A tolerance that nothing exceeds: 4.26 time steps in a period of the pair's own vibration are too few, and it is
    the tolerance that allows them."""
    said = quietly(Transient.of(scene("transient.tolerance=0.5", "contact.friction=0")), tmp_path)
    (coarse,) = (each for each in said if each.startswith("2000 r/min: "))
    assert "4.26 time steps a period; wanted 8: transient.tolerance = 0.5 lets" in coarse


def test_facts_say_how_steps_are_divided(out: Path) -> None:
    """Of the last mesh period of either coefficient: more steps than positions, the shortest is an exact part of the
    way between two of them, errors are within the tolerance, balances within their limits. The table has ten lines
    each, as without a tolerance."""
    way = 60.0 / 2000.0 / 50 / POSITIONS
    for fact in facts(out):
        assert fact["steady"]
        assert 2 * POSITIONS <= fact["time_steps"] <= 64 * POSITIONS
        assert fact["rejected_steps"] >= 0
        parts = way / fact["shortest_step_s"]
        assert parts == pytest.approx(round(parts), rel=1e-9)
        assert round(parts) in (4, 8, 16, 32, 64)
        assert 0.0 < fact["step_error"] <= TOLERANCE
        natural = 1.0 / fact["natural_frequency_Hz"]
        assert fact["steps_per_natural_period"] == pytest.approx(natural * fact["time_steps"] / (POSITIONS * way))
        assert max(fact["momentum_error"], fact["reaction_error"], fact["motion_energy_error"]) < 1e-10
        assert fact["mean_force_N"] == pytest.approx(fact["load_N"], rel=0.01)
    assert len(rows(out / "transient.csv")) == 2 * POSITIONS


def test_kept_cases_have_their_steps(out: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """What is read of an ended case has the steps of transient.json, as whole numbers; --resume where nothing is
    missing writes the same tables, byte for byte. Another tolerance is another scene."""
    cases = KeptCases.of(scene(), scene().gear_pair(), out)
    for number, (fact, found) in enumerate(zip(facts(out), cases.read().values(), strict=True)):
        steps = found.steps
        assert isinstance(steps.accepted, int) and isinstance(steps.rejected, int)
        assert (steps.accepted, steps.rejected) == (fact["time_steps"], fact["rejected_steps"])
        assert (steps.shortest, steps.error) == (fact["shortest_step_s"], fact["step_error"])
        again = KeptCases.of(scene(), cases.pair, tmp_path)
        again.write(number, found)
        assert [moment.steps for moment in again.read()[number].moments] == [moment.steps for moment in found.moments]
    assert KeptCases.of(scene("transient.tolerance=0.005"), cases.pair, out).cases.identity != cases.cases.identity
    before = [(out / name).read_bytes() for name in TABLES]
    monkeypatch.setattr(module, "until_steady", None)
    quietly(Transient.of(scene()), out, resume=True)
    assert [(out / name).read_bytes() for name in TABLES] == before


def test_a_tolerance_that_is_not_reached_is_named(tmp_path: Path) -> None:
    """Halves at most, and a tolerance of a millionth: a sentence has the error, the length and what to do."""
    few = scene("transient.tolerance=1e-6", "transient.most_parts=2", "contact.friction=0", "transient.mesh_periods=2")
    _, unsteady, beyond, seen, _ = quietly(Transient.of(few), tmp_path)
    (fact,) = facts(tmp_path)
    assert "not steady" in unsteady
    assert "2000 r/min, μ = 0: wanted an error of a time step of at most transient.tolerance = 1e-06" in beyond
    assert "4.26 positions a period" in seen
    assert "raise transient.most_parts or the tolerance" in beyond
    assert fact["time_steps"] == 2 * POSITIONS
    assert fact["step_error"] > 1e-6
